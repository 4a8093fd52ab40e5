// Which method and quality a solve or a plan uses: the command line, then the scene, then the defaults.
#pragma once

#include <optional>
#include <string>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

struct MethodChoice {
  std::string method;  ///< instantiation, clustering, flat, direct or reference
  Quality quality = Quality::standard;
  std::string why = {};  ///< why this method, where it was not asked for
  /// Where an error is wanted: takes the place of the quality's densities (radiosity/fineness.hpp).
  std::optional<double> fineness = {};
};

/// Throws UsageError for a method or a quality that does not exist.
MethodChoice choose_method(const std::optional<std::string>& method, const std::optional<std::string>& quality, const SolveChoice& scene);
/// The same; where nobody names a method, default_method() does.
MethodChoice choose_method(const std::optional<std::string>& method, const std::optional<std::string>& quality, const Scene& scene,
                           Progress& progress);

/// The method for a scene that neither command line nor scene names one for: instantiation where much repeats and copies do not reach into
/// each other (traces a pilot of few lines to find out), else clustering. `why` says it for people.
struct MethodReason {
  std::string method, why;
};
MethodReason default_method(const Scene& scene, Quality quality, Progress& progress);

std::string name_of(Quality quality);
/// Of a method that is not the reference.
RadiosityMethod radiosity_method(const std::string& method);

/// `only` and `stop_at` leave out work where structures are opened one by one, and rays that nobody asks for. Throws InputError where a
/// method does not know them.
void refuse_depth(const Scene& scene, const std::string& method);

}  // namespace sunfleck
