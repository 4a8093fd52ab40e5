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

/// "absorbed", "irradiance_front", "irradiance_back", "sunlit_front", "sunlit_back"; "type" and "optics" colour by name.
const std::vector<std::string>& mesh_quantities();

/// Binary little-endian PLY with one face a facet, in the order of /facets, corners counter-clockwise seen from the front. Facets of a
/// piece of mesh share vertices. Face properties: red, green, blue (sRGB codes), quality (the quantity, or absorbed), organ (row of
/// /organs), area [m^2], and what the file keeps of irradiance_front_BAND, irradiance_back_BAND [W m^-2], absorbed_BAND [W m^-2],
/// sunlit_front, sunlit_back; "_STATE" is appended where several states are kept. Vertices are doubles [m]. Throws InputError where the
/// file keeps no facets or no geometry, UsageError for an unknown quantity, OutputError, Stopped.
void export_ply(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress);

/// Wavefront OBJ (double precision as text) and FILE.mtl beside it. "v x y z r g b": colours (sRGB codes / 255) are area-weighted means
/// over the facets of an organ that meet at a vertex. An object per copy, a group organ_N per organ (row N of /organs), one face a facet,
/// in order.
void export_obj(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress);

/// Binary glTF 2.0: positions in single precision [m] about a centre of their own where the scene is more than 1 km off, COLOR_0 (linear,
/// 16 bits), and _VALUE, the quantity, averaged to vertices as in export_obj. Copies of a plant that share all colours are one mesh with
/// EXT_mesh_gpu_instancing (without _VALUE). y is up, as glTF wants it, by a turn of the root node. Throws UsageError beyond 4 GiB.
void export_glb(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress);

/// VTKHDF 1.0, an UnstructuredGrid of one triangle a facet, in order; cell data: colour (sRGB codes), area [m^2], organ, and the values and
/// names of export_ply.
void export_vtkhdf(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress);

/// XDMF 2, whose values are read from the result file itself (which must stay where it is, seen from the .xdmf); states are time steps 0,
/// 1,
/// ... Colours, and the mesh unless the result holds it in world coordinates, go to FILE.xdmf.h5.
void export_xdmf(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress);
/// Whether a file is what export_xdmf() puts beside an .xdmf.
bool is_our_heavy_data(const std::string& file);

/// One row an organ (RFC 4180, a header line): organ, plant, placement, name, type, area_m2, then per state and band absorbed_W_BAND,
/// irradiance_front_BAND, irradiance_back_BAND [W m^-2], and per state sunlit_front, sunlit_back; "_STATE" is appended where there are
/// several. Where every state has a duration, absorbed_J_BAND is the sum over states of absorbed x duration [J]. Bands in
/// umol m^-2 s^-1 have umol_s and umol in the place of W and J.
void export_csv(const Result& result, const std::string& file, Progress& progress);

/// One row a group of organs that share the values of the keys in `by`, separated by commas: "plant", "placement", "type", "name" (of the
/// organ), "order" (an attribute of that name, else branching_order()), any attribute of the plant files (an organ's own, else that of the
/// nearest structure above it), and "layer" (twenty between the lowest and the highest plant facet) or "layer:0.5" (layers of .5 m from
/// multiples of it). Columns: the keys, the number of organs, area_m2, and those of export_csv: absorbed summed, the others weighted by
/// area. With layers, which hold plant facets by the height of their centroids, the key is z_low_m,z_high_m and facets are counted.
/// Memory grows with the number of groups; with layers beside other keys also by 4 bytes an organ and key. Throws UsageError for keys that
/// are none, InputError where the file does not keep what is asked.
void export_groups(const Result& result, const std::string& file, const std::string& by, Progress& progress);

/// One row a cell of the sensors named (none: of all), in their order: sensor, kind, cell, x, y, z [m], normal_x, normal_y, normal_z,
/// area_m2, then per state and band irradiance_BAND, standard_error_BAND [W m^-2], and where one of the sensors has a back (empty for
/// those that have none) irradiance_back_BAND, standard_error_back_BAND; "_STATE" is appended where there are several. Where every state
/// has a duration, exposure_J_m2_BAND (exposure_umol_m2_BAND) is the sum over states of irradiance x duration on the front. Returns the
/// number of rows. Throws InputError for a result without sensors, UsageError for names of none.
std::size_t export_sensors(const Result& result, const std::string& file, const std::vector<std::string>& names, Progress& progress);

}  // namespace sunfleck
