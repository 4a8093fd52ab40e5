// The depth buffer of parallel projections: what of a surface is seen first.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <sunfleck/visibility/surface.hpp>

#include "rasterise.hpp"

namespace sunfleck {

inline constexpr std::uint32_t nothing = 0xffffffffu;

/// Pixels that are drawn together; buffers end with as many that nobody reads.
inline constexpr int drawn_together = 8;

/// What is nearest to the eye, for a strip of rows.
struct DepthBuffer {
  std::vector<float> depth;         ///< larger is nearer
  std::vector<std::uint32_t> code;  ///< 2 * cell + (1 if the front faces the eye)

  void clear(std::size_t pixels) {
    depth.assign(pixels + drawn_together, -std::numeric_limits<float>::max());
    code.assign(pixels + drawn_together, nothing);
  }
};

/// Of two coincident fragments, is the candidate in front? For facets i < j, j lies on the front side of i; cells rise with facets.
inline bool coincident_in_front(std::uint32_t candidate, std::uint32_t standing) {
  const bool later = (candidate >> 1) > (standing >> 1);
  const bool front_of_lower_up = (later ? standing : candidate) & 1u;
  return later == front_of_lower_up;
}

/// A run of fragments of one triangle: depth and code are functions of the position in the run, also somewhat beyond its end.
template <class Depth, class Code>
void draw_run(int count, float tolerance, float* depth, std::uint32_t* standing, const Depth& depth_at, const Code& code_at) {
  int ties = 0;
  // runs are short: always a whole vector, without branches; what lies beyond the run stays as it is
  for (int begin = 0; begin < count; begin += drawn_together)
    for (int k = 0; k < drawn_together; ++k) {
      const int i = begin + k;
      const float z = depth_at(i), d = depth[i];
      const std::uint32_t code = code_at(i), old = standing[i];
      const int inside = static_cast<int>(i < count), above = static_cast<int>(z > d + tolerance) & inside;
      ties |= static_cast<int>(z > d - tolerance) & (inside ^ above);
      depth[i] = above ? z : d;
      standing[i] = above ? code : old;
    }
  if (!ties) return;
  for (int i = 0; i < count; ++i) {
    const float z = depth_at(i);
    const std::uint32_t code = code_at(i);
    if (code != standing[i] && standing[i] != nothing && std::fabs(z - depth[i]) <= tolerance && coincident_in_front(code, standing[i])) {
      depth[i] = z;
      standing[i] = code;
    }
  }
}

/// Draws a run of `count` pixels of a triangle whose cells are numbered from `base`: depth = sign * (depth along the line) + depth_offset,
/// code = 2 * cell + front. Calls met(cell, fragments) for every run of one cell.
template <class Met>
void draw_span(const ProjectedTriangle& t, std::uint32_t base, std::uint32_t front, float sign, float depth_offset, int count, float dx,
               float dy, float tolerance, float* depth, std::uint32_t* code, Met&& met) {
  const auto depth_at = [plane = t.depth, low = t.depth_low, high = t.depth_high, dx, dy, sign, depth_offset](int i) {
    return sign * std::min(std::max(plane.at(dx + static_cast<float>(i), dy), low), high) + depth_offset;
  };
  if (t.split == 1) {
    met(base, count);
    draw_run(count, tolerance, depth, code, depth_at, [c = 2 * base + front](int) { return c; });
    return;
  }
  constexpr int chunk = 64;
  for (int begin = 0; begin < count; begin += chunk) {
    const int n = std::min(chunk, count - begin);
    alignas(64) std::uint32_t codes[chunk + drawn_together] = {};
    const float x0 = dx + static_cast<float>(begin), u0 = t.u.at(x0, dy), v0 = t.v.at(x0, dy), du = t.u.per_x, dv = t.v.per_x;
    const int split = t.split;
    for (int i = 0; i < n; ++i) {
      const auto x = static_cast<float>(i);
      codes[i] = 2 * (base + cell_of(u0 + x * du, v0 + x * dv, split)) + front;
    }
    for (int i = 0; i < n;) {
      int end = i + 1;
      while (end < n && codes[end] == codes[i]) ++end;
      met(codes[i] >> 1, end - i);
      i = end;
    }
    draw_run(
        n, tolerance, depth + begin, code + begin, [&](int i) { return depth_at(begin + i); }, [&codes](int i) { return codes[i]; });
  }
}

}  // namespace sunfleck
