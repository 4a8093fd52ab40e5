// What a radiosity solve will take, predicted before it is done.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/radiosity/solve.hpp>

namespace sunfleck {

/// Counts and bytes of solve_radiosity().
/// - Elements, cells, clusters and their bytes are exact: they are laid out, which takes no lines.
/// - Direct light: a surface of one-sided area A meets A |cos| / a lines of a direction, where a is the area that a line stands for, so
///   A D / (2 a) lines of D directions spread evenly over the hemisphere. Right within the rounding of grids. But for method direct the
///   sky's light comes along the lines of scattered light.
/// - Scattered light: how many lines meet two things, and how many of them join the same two, depends on what sees what. Pilots
///   of a tenth (in small scenes a quarter) of the directions, and of a quarter of those, are traced; meetings grow in proportion to the
///   directions, links as a power of them, whose exponent (below 1, as equal links merge) the two pilots give. Within 25 % on plants and
///   canopies. Enclosed parts are those that the pilot finds. Whether clusters pay is judged from the pilot; near the threshold the solve
///   may choose otherwise.
struct RadiosityPlan {
  std::uint64_t elements = 0, cells = 0, clusters = 0;
  std::uint64_t sky_fragments = 0, sun_fragments = 0;  ///< meetings of a line with a surface, for direct light; sky: method direct alone
  std::uint64_t line_fragments = 0;                    ///< the same, for scattered light
  std::uint64_t links = 0;
  std::uint64_t lamp_rays = 0, sensor_rays = 0;  ///< exact; 0 without lamps or sensors
  /// Bytes: "elements", "direct", "tree of rays" and "lamps" (with lamps or sensors only), "links", "fields" as SolveReport::memory names
  /// them, and "lines", held only while links are made.
  std::vector<std::pair<std::string, std::uint64_t>> memory;
};

/// Throws what solve_radiosity() throws where there is nothing to project; Stopped.
RadiosityPlan plan_radiosity(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings, Progress& progress);

}  // namespace sunfleck
