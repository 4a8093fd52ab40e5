// Which method and quality a solve or a plan uses: the command line, then the scene, then the defaults.
#pragma once

#include <optional>
#include <string>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

struct MethodChoice {
  std::string method;  ///< clustering, flat, direct or reference
  Quality quality = Quality::standard;
};

/// A wanted error of an organ's absorbed light [fraction of the mean] picks the quality that keeps it in every band of ordinary
/// vegetation; an explicit quality takes precedence. Throws UsageError for a method that does not exist or an error that no quality
/// reaches.
MethodChoice choose_method(const std::optional<std::string>& method, const std::optional<std::string>& quality,
                           const std::optional<double>& error, const SolveChoice& scene);

std::string name_of(Quality quality);

}  // namespace sunfleck
