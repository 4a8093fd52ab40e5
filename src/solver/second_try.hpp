// What a solve does when its own certificate contradicts it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/audit/verdict.hpp>
#include <sunfleck/scene/scene.hpp>

#include <sunfleck/solver/method_choice.hpp>

namespace sunfleck {

/// What to go on with where a certificate contradicts a solve: after instantiation, which shares light between copies, clustering at the
/// same fineness; after that clustering one unit of fineness further, as elements are too coarse then (method flat does not divide facets,
/// and is no cure). At most two more solves. A method that the user named is kept.
class SecondTry {
 public:
  /// Does a solve by this method fit into memory? If not, why.
  using Fits = std::function<bool(const MethodChoice&, std::string& why_not)>;

  SecondTry(const RunSettings& run, Fits fits) : run_(run), fits_(std::move(fits)) {}

  /// The choice to solve again with; nothing where there is none, and then advice() says what the user may do.
  std::optional<MethodChoice> next(const MethodChoice& failed);
  const std::string& advice() const { return advice_; }

 private:
  const RunSettings& run_;
  Fits fits_;
  int tries_ = 0;
  std::string advice_;
};

/// Fineness of a choice: its own, or its quality's.
double fineness_of(const MethodChoice& choice);

/// What the errors of a solve are judged by.
struct Aims {
  std::vector<double> error;  ///< [b] rms error over the mean; 0: not judged
  std::string who;            ///< "quality standard aims at"
};
/// Of the quality; where an error is wanted (`goal`, not empty), of the fineness of this solve, or what is wanted where that is more.
/// Nothing is judged where method direct leaves out scattered light on purpose.
Aims aims_of(const MethodChoice& choice, const std::vector<double>& goal, const FacetRows& rows, const std::vector<ChosenOrgan>& chosen);

/// "an error of 9.31 % in NIR, 7.50 % at least, where quality standard aims at 2 %".
std::string text_of(const Contradiction& found, const Aims& aims, const Scene& scene);

/// What is said of a solve that no try mended.
std::string inaccurate_text(const Contradiction& found, const Aims& aims, const Scene& scene, const std::string& advice);

}  // namespace sunfleck
