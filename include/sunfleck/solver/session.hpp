// Solves one after another of scenes that change a little from step to step.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/solver/solution.hpp>

namespace sunfleck {

/// Where a session keeps what it reuses.
struct SessionSettings {
  std::uint64_t most_bytes = std::uint64_t{1} << 30;  ///< of each kind in memory, and as many operators in `folder`
  std::string folder;                                 ///< operators on disk, for later sessions; empty: none
};

/// What the last solve of a session took over, and what it did not.
struct Reuse {
  bool everything = false;  ///< scene and run were those of the solve before: its solution was given again
  bool geometry = false;    ///< only what shines had changed
  /// Names and numbers of what was not computed again: "solution"; "transport" (elements, links and lines of a whole scene); "operators"
  /// (the same of originals), "operators_read" (of these, from disk).
  std::vector<std::pair<std::string, std::uint64_t>> reused;
  std::vector<std::pair<std::string, std::uint64_t>> made;  ///< the same of what was computed
  double saved_seconds = 0;                                 ///< that computing what was reused took when it was computed
};

/// A growth model's solver: what did not change is not computed again. Results are those of solve() with a store (OperatorStore): the same
/// bits whatever the session has solved before. They differ from solve() without a session by the order of sums alone: by
/// rounding, 1e-5 of the light of a facet at most.
///
/// What is kept, by content: the last solution; with methods clustering and flat the transport of the scene, which changed light reuses
/// while nothing else changes; with method instantiation the operators of originals, so that changed light, and plants that are moved,
/// added or taken away, reuse all that unchanged plants do with light inside.
/// The certificate, unless RunSettings say whether it is wanted: of the first solve alone, as steps are many; of all, where it spoke
/// against the first choice of a method. For one thread at a time. After an exception the session is as it was before, and can go on.
class Session {
 public:
  explicit Session(RunSettings run = {}, SessionSettings settings = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// solve() of what the scene is now. Errors as of solve().
  Solution solve(const Scene& scene, Progress& progress = silent(), bool facets = true);
  const Reuse& reused() const;

  RunSettings run;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunfleck
