// Which method and quality a solve or a plan uses: the command line, then the scene, then the defaults.
#pragma once

#include <optional>
#include <string>

#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

struct MethodChoice {
  std::string method;  ///< clustering, flat, direct or reference
  Quality quality = Quality::standard;
};

/// A wanted error of an organ's absorbed light [fraction of the mean] picks the cheapest quality whose aim it is (see
/// docs/accuracy.md for what each reaches on which scene; a scene of very small organs can miss it, and its certificate then says so).
/// An explicit quality takes precedence. Throws UsageError for a method that does not exist or an error that no quality aims at.
MethodChoice choose_method(const std::optional<std::string>& method, const std::optional<std::string>& quality,
                           const std::optional<double>& error, const SolveChoice& scene);

std::string name_of(Quality quality);
/// Of a method that is not the reference.
RadiosityMethod radiosity_method(const std::string& method);

}  // namespace sunfleck
