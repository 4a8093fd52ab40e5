// Lanes: which columns of which copies are worked on together, and what comes in to them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "instantiation/local_solve.hpp"
#include "instantiation/scene_light.hpp"
#include "instantiation/threads.hpp"

namespace sunfleck {

/// Some columns of some members of one original, side by side: lane = (place in `members`) * columns + column - first_column.
struct Batch {
  std::uint32_t original = 0;
  std::vector<std::uint32_t> members;
  std::size_t first_column = 0, columns = 0;  ///< of each member
  int width = 16;
};

/// Lanes that are worked on together where an original has so many, of so many columns a member.
int batch_width(std::size_t lanes, std::size_t columns);

/// Batches over members of one original, of so many columns each.
std::vector<Batch> batches_of_original(std::uint32_t original, const std::vector<std::uint32_t>& members, std::size_t columns);

/// Batches over the members given, of so many columns each, members of one original together, in a fixed order.
std::vector<Batch> batches_of(const Members& all, std::size_t columns, const std::vector<std::uint32_t>& members);
inline std::vector<Batch> batches_of(const SceneLight& s, const std::vector<std::uint32_t>& members) {
  return batches_of(s.members, s.columns, members);
}

/// Bytes of the lanes of those batches that are worked on at the same time; `fields(batch)`: values in each of its lanes.
template <class Fields>
std::size_t lanes_at_once(const std::vector<Batch>& batches, const Fields& fields) {
  std::vector<std::size_t> bytes;
  for (const auto& b : batches) bytes.push_back(sizeof(float) * b.width * fields(b));
  std::sort(bytes.rbegin(), bytes.rend());
  bytes.resize(std::min(bytes.size(), threads_at_work()));
  return std::accumulate(bytes.begin(), bytes.end(), std::size_t{0});
}

/// Runs of batches of the same members, which differ in their columns, among [first, last) of some batches: first and one past the last.
std::vector<std::pair<std::size_t, std::size_t>> runs_of_members(const std::vector<Batch>& batches, std::size_t first, std::size_t last);

/// Area of each side of an original's elements from which lines leave for the sky [sides] [m^2]; `ends`: of the operator's points.
std::vector<double> sky_areas(const LineOperator& op, const RayEnd* ends);

/// Where the rays of a batch's members end, as stored for the coarse operator.
std::vector<const RayEnd*> stored_ends(const SceneLight& s, const Batch& b);

template <class Call>
inline void with_width(int width, Call&& call) {
  switch (width) {
    case 2:
      return call(std::integral_constant<int, 2>{});
    case 4:
      return call(std::integral_constant<int, 4>{});
    case 8:
      return call(std::integral_constant<int, 8>{});
    default:
      return call(std::integral_constant<int, 16>{});
  }
}

template <int width>
std::vector<LaneOptics<width>> optics_of(const SceneLight& s, const Batch& b) {
  std::vector<LaneOptics<width>> out(s.scene.optics.size(), LaneOptics<width>{});
  for (std::size_t m = 0; m < s.scene.optics.size(); ++m) {
    for (std::size_t lane = 0; lane < b.members.size() * b.columns; ++lane) {
      const std::size_t band = (b.first_column + lane % b.columns) % s.bands;
      out[m].front[lane] = s.scene.optics[m].reflectance_front[band];
      out[m].back[lane] = s.scene.optics[m].reflectance_back[band];
      out[m].transmittance[lane] = s.scene.optics[m].transmittance[band];
    }
  }
  return out;
}

/// What comes in through each field: means over the rays of each pixel. `light`: what members and the ground send (null = nothing);
/// `sky`: the sky's part is added.
template <int width>
void incoming(const SceneLight& s, const Batch& b, const LineOperator& op, const std::vector<const RayEnd*>& ends, const Light* light,
              bool sky, LaneField<width>& field) {
  field.assign(op.fields(), Lanes<width>{});
  const std::size_t pixels = std::size_t{op.pixels()} * op.pixels();
  std::vector<float> radiance(b.columns, 0.0f);
  for (std::size_t j = 0; j < b.members.size(); ++j) {
    const auto& map = s.members.maps[b.members[j]];
    const std::size_t lane = j * b.columns;
    for (std::size_t f = 0; f < op.fields(); ++f) {
      if (sky && f % pixels == 0) {
        const Vec3 d = map.direction(op.direction(f / pixels));
        for (std::size_t c = 0; c < b.columns; ++c) radiance[c] = s.sky_radiance(d, b.first_column + c);
      }
      const auto first = op.point_start[f], last = op.point_start[f + 1];
      if (first == last) continue;
      float sum[16] = {};
      for (auto k = first; k < last; ++k) {
        const RayEnd& end = ends[j][k];
        const float* from = nullptr;
        if (end.is_sky()) {
          if (sky) from = radiance.data();
        } else if (end.is_mirrored()) {
          if (light)
            for (std::size_t c = 0; c < b.columns; ++c)
              sum[c] += s.scene.ground->optics.reflectance_front[(b.first_column + c) % s.bands] *
                        light->fields[(s.field_start[end.target] + (end.field & ~RayEnd::mirrored_bit)) * s.columns + b.first_column + c];
        } else if (light) {
          from = end.is_ground() ? light->ground.data() + (2 * std::size_t{end.facet()} + end.field) * s.columns + b.first_column
                                 : light->fields.data() + (s.field_start[end.target] + end.field) * s.columns + b.first_column;
        }
        if (from)
          for (std::size_t c = 0; c < b.columns; ++c) sum[c] += from[c];
      }
      for (std::size_t c = 0; c < b.columns; ++c) field[f][lane + c] = sum[c] / static_cast<float>(last - first);
    }
  }
}

template <int width>
void add_sun(const SceneLight& s, const Batch& b, LaneField<width>& source) {
  if (s.lights.suns.empty()) return;
  std::vector<float> lit;
  for (std::size_t j = 0; j < b.members.size(); ++j)
    for (std::size_t sun = 0; sun < s.lights.suns.size(); ++sun) {
      bool made = false;
      for (std::size_t c = 0; c < b.columns; ++c) {
        const std::size_t column = b.first_column + c, state = column / s.bands;
        if (s.lights.sun_of_state[state] != sun) continue;
        if (!made) s.sun_on_elements(b.members[j], sun, lit);
        made = true;
        const auto irradiance = static_cast<float>(s.scene.states[state].sun->irradiance[column % s.bands]);
        for (std::size_t i = 0; i < lit.size(); ++i) source[i][j * b.columns + c] += irradiance * lit[i];
      }
    }
}

}  // namespace sunfleck
