// Answers of the viewer's server that are not pictures, as JSON.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "view/viewer_statistics.hpp"

namespace sunfleck {

/// Results, bands, states, quantities, colour maps, organ types and the camera to begin with.
nlohmann::json describe(const ViewerScenes& scenes);
/// Placed plants whose path holds the text, ignoring case: rows of the file's placement names with plant, organs and area; at most `most`.
nlohmann::json placements(const ViewerScene& scene, const std::string& text, std::size_t most);
/// What the file holds of one organ in one state: absorbed [W] and per area, irradiance of both sides, sunlit fractions; the file's own
/// numbers. `facet` is the one that was picked, or no_facet.
nlohmann::json organ_numbers(const ViewerScene& scene, std::size_t organ, std::uint32_t facet, std::size_t state);
/// The organ under a point of the picture, x and y from 0 to 1; {"organ": null} for none.
nlohmann::json pick(const ViewerScenes& scenes, const ViewerView& view, double x, double y);
/// Organs whose name, or "placement/name", holds the text, ignoring case; those that begin with it first. At most `most`.
nlohmann::json search_organs(const ViewerScene& scene, const std::string& text, std::size_t most);
/// Scale, ticks and colours of the view's legend, or its names and theirs.
nlohmann::json legend(const ViewerScenes& scenes, const ViewerView& view);
nlohmann::json statistics_json(const SelectionStatistics& statistics);

}  // namespace sunfleck
