// What all copies of a scene receive and see: the part of a solve that is done once.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/scene/solution.hpp>

#include "instantiation/ground_light.hpp"
#include "instantiation/members.hpp"
#include "instantiation/memory_count.hpp"
#include "instantiation/member_surroundings.hpp"

namespace sunfleck {

/// Fields of all members, [member][field][column], and the radiosity of the ground, [side][column].
struct Light {
  std::vector<float> fields, ground;
};

/// Rays from each part of the ground.
std::uint32_t rays_of_ground(const Members& members, const InstantiationDensity& density);

/// A scene, its members, the sun on their cells, and where their rays end. Columns: state * bands + band.
struct SceneLight {
  SceneLight(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings, Progress& progress);

  /// The sun's projection through all copies.
  void project_sun();
  /// Rays from all copies and from the ground.
  void look_around(SolveReport& report);

  /// Rays through the points of fields of an operator of member `m`; `out` is that of its first point.
  void look_from(std::uint32_t m, const LineOperator& op, std::size_t first_field, std::size_t last_field, RayEnd* out) const;
  /// Radiance times pi of the sky towards d, for a column [W m^-2].
  float sky_radiance(const Vec3& d, std::size_t column) const;
  /// Per element side: cosine towards the sun times the lit fraction, area mean over its cells.
  void sun_on_elements(std::uint32_t m, std::size_t sun, std::vector<float>& out) const;
  /// Irradiance of the ground, [side][column]: direct light and what members and other ground send.
  std::vector<float> ground_irradiance(const Light* light, bool direct) const;
  float ground_direct(std::size_t side, std::size_t column) const;
  /// Radiosity from irradiance, in place.
  void reflect_from_ground(std::vector<float>& e) const;
  /// Scalar product of two lights per column, weighted by the power that leaves through the fields and from the ground.
  std::vector<double> product(const Light& a, const Light& b) const;
  Light no_light() const;
  std::size_t bytes_of_light() const { return sizeof(float) * columns * (field_start.back() + ground.seen.size()); }
  std::vector<std::uint32_t> all_members() const;
  /// Opens a copy that others stand in for: it becomes a member of an original of its own with the fine operator, those that stood in for
  /// it are gone, and the sun is projected onto it. Returns its number, which is good until end_own().
  std::uint32_t begin_own(std::uint32_t copy);
  void end_own();
  /// Cells of a member that a sun reaches, in 1/255.
  const std::uint8_t* lit_cells_of(std::size_t sun, std::uint32_t m) const {
    return m == own_member ? own_lit[sun].lit.data() : lit[sun].lit.data() + lit[sun].first[m];
  }

  const Scene& scene;
  const PlacedScene& placed;
  const InstantiationDensity density;
  const std::uint64_t seed;
  Progress& progress;
  const std::size_t states, bands, columns;
  const std::vector<LightState> lit_states;  ///< those of the scene, with skies blurred over the angles between directions
  const LightSources lights;                 ///< of lit_states
  Members members;
  OperatorStore* const store;  ///< or null
  std::vector<LitCells> lit;   ///< per distinct sun
  std::unique_ptr<MemberSurroundings> around;
  std::vector<std::uint64_t> field_start, end_start;  ///< [members + 1]
  std::vector<RayEnd> ends;                           ///< of the coarse operators' points
  GroundView ground;
  std::vector<double> sun_pitch;                ///< sun_pitches()
  std::unique_ptr<const Surface> ground_shade;  ///< null where the ground shades nothing
  MemoryCount memory;
  // Work: meetings of a line with a surface, towards the sun and along the operators that light is gathered along, and rays for the latter.
  std::uint64_t sun_fragments = 0, gather_fragments = 0, gather_rays = 0;

 private:
  /// The ground as one more copy, which is not counted.
  void add_ground_shade(CopyScene& shade, std::vector<double>& pitch) const;

  std::uint32_t own_member = 0xffffffffu;  ///< the member that begin_own() has made
  std::vector<LitCells> own_lit;           ///< per distinct sun
  std::vector<std::uint32_t> gone;
};

}  // namespace sunfleck
