#include "pilot_light.hpp"

#include <algorithm>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/visibility/projection.hpp>

namespace sunfleck {

namespace {

constexpr std::uint64_t pilot_stream = 0x3c6ef372fe94f82bULL;

struct Meeting {
  std::uint32_t low, high;  ///< sides that see each other
};

/// What the lines of one direction met.
struct Met {
  std::vector<Meeting> meetings;
  std::vector<std::uint32_t> open;  ///< sides
};

}  // namespace

PilotLight pilot_light(const FacetScene& facets, const Elements& e, std::uint32_t directions, double pitch, int reflections) {
  std::vector<Met> met(directions);
  tbb::enumerable_thread_specific<LineBundle> bundles;
  tbb::parallel_for(std::uint32_t{0}, directions, [&](std::uint32_t d) {
    LineBundle& bundle = bundles.local();
    const Vec3 direction = hemisphere_direction(d, directions, pilot_stream);
    trace_lines(e.surface, project_set_member(e.surface, direction, d, pitch, pilot_stream), bundle);
    for (std::size_t q = 0; q + 1 < bundle.start.size(); ++q) {
      const std::uint32_t begin = bundle.start[q], end = bundle.start[q + 1];
      if (begin == end) continue;
      met[d].open.push_back(bundle.side[begin] ^ 1u);
      met[d].open.push_back(bundle.side[end - 1]);
      for (std::uint32_t k = begin + 1; k < end; ++k) met[d].meetings.push_back({bundle.side[k - 1], bundle.side[k] ^ 1u});
    }
  });
  const std::size_t sides = 2 * e.surface.cells();
  PilotLight out;
  out.lines.assign(sides, 0.0f);
  std::vector<float> open(sides, 0.0f);
  for (const auto& m : met) {
    for (const auto side : m.open) open[side] += 1.0f;
    for (const auto& [low, high] : m.meetings) {
      out.lines[low] += 1.0f;
      out.lines[high] += 1.0f;
    }
  }
  for (std::size_t i = 0; i < sides; ++i) out.lines[i] += open[i];
  std::vector<Brightest> optics;
  for (const auto& m : facets.materials) optics.emplace_back(m);
  std::vector<float> radiosity(sides, 0.0f);
  out.sum = open;
  for (int k = 0; k < reflections; ++k) {
    for (std::size_t c = 0; c < sides / 2; ++c) {
      const auto& m = optics[facets.optics[e.order[e.row_of_cell[c]]]];
      float light[2];
      for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t i = 2 * c + side;
        light[side] = out.lines[i] > 0.0f ? out.sum[i] / out.lines[i] : 0.0f;
      }
      radiosity[2 * c] = m.front * light[0] + m.through * light[1];
      radiosity[2 * c + 1] = m.back * light[1] + m.through * light[0];
    }
    out.sum = open;
    for (const auto& m : met)
      for (const auto& [low, high] : m.meetings) {
        out.sum[low] += radiosity[high];
        out.sum[high] += radiosity[low];
      }
  }
  out.squares = open;
  out.open = std::move(open);
  for (const auto& m : met)
    for (const auto& [low, high] : m.meetings) {
      out.squares[low] += radiosity[high] * radiosity[high];
      out.squares[high] += radiosity[low] * radiosity[low];
    }
  return out;
}

}  // namespace sunfleck
