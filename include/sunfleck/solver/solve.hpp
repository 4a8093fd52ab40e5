// The solver: from a scene to the light on all its facets and organs. The command line and the Python module are thin callers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/progress.hpp>
#include <sunfleck/result/certificate.hpp>
#include <sunfleck/result/organ_totals.hpp>
#include <sunfleck/scene/placed_scene.hpp>
#include <sunfleck/scene/run_settings.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/solution.hpp>
#include <sunfleck/solver/method_choice.hpp>

namespace sunfleck {

/// What a solve that begins hands to its sink.
struct SolveStart {
  const Scene& scene;
  const PlacedScene& placed;                 ///< whose facets' rows arrive in the watcher
  const PlacedScene& rows;                   ///< whose facets' rows arrive in the sink: the same, but for structures that `stop_at` sums
  const std::string& method;                 ///< of this solve
  const std::vector<std::uint64_t>& totals;  ///< organs (rows of /organs, rising) whose sums totals() must give
};

/// Where the light of a solve goes: a file, memory, or what a program needs of it. Where a certificate contradicts a solve, or a wanted
/// error is not reached, another solve begins, and what the one before it handed over is void.
class LightSink {
 public:
  virtual ~LightSink() = default;
  /// A solve begins. Its rows go to the sink that is returned.
  virtual IrradianceSink& begin(const SolveStart& start) = 0;
  /// Who else wants to see all rows of facets as they are found, whatever is kept of them; nobody by default. After begin().
  virtual IrradianceSink* watcher() { return nullptr; }
  /// All rows of this solve have come.
  virtual void end(Progress& progress) { (void)progress; }
  /// Sums over the organs that begin() named, and over all plants: after end().
  virtual const OrganTotals& totals() const = 0;
  /// No further solve follows. `certificate` may be null.
  virtual void finish(const SolveReport& report, const Certificate* certificate) = 0;
};

/// What a solve did, and what is known of its error.
struct SolveResult {
  MethodChoice choice;                     ///< of the last solve
  SolveReport report;                      ///< status, balance, iterations, counts, memory, seconds, sensors
  Depth depth;                             ///< to which the scene was opened
  std::uint64_t facets = 0;                ///< that the result has rows of
  bool tried_again = false;                ///< the certificate contradicted the method first chosen, and another was taken
  std::optional<Certificate> certificate;  ///< absent where none was wanted, or nothing can be checked
  /// Of a result that is not as it was asked for (report.status is not converged): what was found, and what helps. Else empty.
  std::string verdict;
};

class OperatorStore;
class TransportStore;

/// What a caller did before it called, for the result's own figures, and what it keeps from solve to solve.
struct SolveCaller {
  std::size_t bytes_at_start = resident_bytes();  ///< of the process, before it read anything
  double read_seconds = 0;                        ///< that reading the scene took
  OperatorStore* operators = nullptr;             ///< that this solve shares with others; null = none
  TransportStore* transports = nullptr;           ///< the same, of the methods that have no originals
  std::string geometry;                           ///< geometry_key() of the scene, with these
};

/// Solves a scene: chooses a method where `run` names none (choose_method), refuses what does not fit into memory, solves, and path-traces
/// some organs to tell the error of the result (audit/certificate.hpp); goes on to a finer solve or a more exact method where a wanted
/// error is not reached or its own certificate contradicts it (docs/how-to.md). The scene is checked, and what its skies need is computed,
/// here: nothing has to be called before. Same bits for any number of threads, and for the same input on the same build.
/// Throws InputError, UsageError, OutOfMemory, Stopped, and what the sink throws; then nothing is finished.
SolveResult solve(const Scene& scene, const RunSettings& run, LightSink& sink, Progress& progress = silent(),
                  const SolveCaller& caller = {});

}  // namespace sunfleck
