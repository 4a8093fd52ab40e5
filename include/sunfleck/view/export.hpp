// Results for other programs: lit meshes and tables. Streamed; complete or absent.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/view/colormap.hpp>

namespace sunfleck {

/// What a lit mesh shows and holds.
struct MeshChoice {
  std::string quantity = "colour";   ///< "colour" (natural) or one of mesh_quantities(), drawn with `map`
  std::size_t band = 0;              ///< of the quantity
  std::optional<std::size_t> state;  ///< the one state to keep; none = all, coloured by the first
  ColorMap map = ColorMap::viridis;
};

/// "absorbed", "irradiance_front", "irradiance_back", "sunlit_front", "sunlit_back".
const std::vector<std::string>& mesh_quantities();

/// Binary little-endian PLY with one face a facet, in the order of /facets, corners counter-clockwise seen from the front. Facets of a
/// piece of mesh share vertices. Face properties: red, green, blue (sRGB codes), quality (the quantity, or absorbed), organ (row of
/// /organs), area [m^2], and what the file keeps of irradiance_front_BAND, irradiance_back_BAND [W m^-2], absorbed_BAND [W m^-2],
/// sunlit_front, sunlit_back; "_STATE" is appended where several states are kept. Vertices are doubles [m]. Throws InputError where the
/// file keeps no facets or no geometry, UsageError for an unknown quantity, OutputError, Stopped.
void export_ply(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress);

/// One row an organ (RFC 4180, a header line): organ, plant, placement, name, type, area_m2, then per state and band absorbed_W_BAND,
/// irradiance_front_BAND, irradiance_back_BAND [W m^-2], and per state sunlit_front, sunlit_back; "_STATE" is appended where there are
/// several. Where every state has a duration, absorbed_J_BAND is the sum over states of absorbed x duration [J]. Bands in
/// umol m^-2 s^-1 have umol_s and umol in the place of W and J.
void export_csv(const Result& result, const std::string& file, Progress& progress);

}  // namespace sunfleck
