// Which method and quality a solve or a plan uses: what the run says, else what suits the scene.
#pragma once

#include <optional>
#include <string>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/run_settings.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

struct MethodChoice {
  std::string method;  ///< of method_names()
  Quality quality = Quality::standard;
  std::string why = {};  ///< why this method, where it was not asked for
  /// Where an error is wanted: takes the place of the quality's densities (radiosity/fineness.hpp).
  std::optional<double> fineness = {};
};

/// What `run` says; where it names no method, default_method()'s. An error that is wanted begins at quality draft. Throws UsageError for a
/// method that does not exist.
MethodChoice choose_method(const RunSettings& run, const Scene& scene, Progress& progress);

/// Why an error cannot be asked of a method, nor its certificate judge it: it leaves light out, or takes samples. Empty for methods that
/// solve for all light.
std::string why_not_judged(const std::string& method);

/// The method for a scene that nobody names one for: instantiation where much repeats and copies do not reach into each other (traces a
/// pilot of few lines to find out), else clustering. `why` says it for people.
struct MethodReason {
  std::string method, why;
};
MethodReason default_method(const Scene& scene, Quality quality, Progress& progress);

/// `only` and `stop_at` leave out work where structures are opened one by one, and rays that nobody asks for. Throws InputError where a
/// method does not know them.
void refuse_depth(const Scene& scene, const Depth& depth, const std::string& method);

}  // namespace sunfleck
