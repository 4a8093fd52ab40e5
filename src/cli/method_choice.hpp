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
};

/// A wanted error of an organ's absorbed light [fraction of the mean] picks the cheapest quality whose aim it is (see
/// docs/accuracy.md for what each reaches on which scene; a scene of very small organs can miss it, and its certificate then says so).
/// An explicit quality takes precedence. Throws UsageError for a method that does not exist or an error that no quality aims at.
MethodChoice choose_method(const std::optional<std::string>& method, const std::optional<std::string>& quality,
                           const std::optional<double>& error, const SolveChoice& scene);
/// The same; where nobody names a method, default_method() does.
MethodChoice choose_method(const std::optional<std::string>& method, const std::optional<std::string>& quality,
                           const std::optional<double>& error, const Scene& scene, Progress& progress);

/// The method for a scene that neither command line nor scene names one for: instantiation where much repeats and copies do not reach into
/// each other (traces a pilot of few lines to find out), else clustering. `why` says it for people.
struct MethodReason {
  std::string method, why;
};
MethodReason default_method(const Scene& scene, Quality quality, Progress& progress);

std::string name_of(Quality quality);
/// Of a method that is not the reference.
RadiosityMethod radiosity_method(const std::string& method);

}  // namespace sunfleck
