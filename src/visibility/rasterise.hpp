// Scan conversion of projected triangles, the inner loop of every projection.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <sunfleck/visibility/projection.hpp>

namespace sunfleck {

/// A quantity that is linear over a projected triangle: value at corner 0, change per pixel along X and Y.
struct ScreenPlane {
  float at_corner, per_x, per_y;
  float at(float dx, float dy) const { return at_corner + per_x * dx + per_y * dy; }
};

/// One projected triangle, with what its spans need. Offsets are in pixels from its corner 0.
struct ProjectedTriangle {
  std::uint32_t index;  ///< row of the surface
  bool front_up;        ///< the front faces the direction
  int split;
  ScreenPlane depth;
  float depth_low, depth_high;
  ScreenPlane u, v;  ///< barycentric coordinates of corners 1 and 2

  float depth_at(float dx, float dy) const { return std::min(std::max(depth.at(dx, dy), depth_low), depth_high); }
};

/// Projects triangles [begin, end) of the list (of the surface where list is null) in blocks and calls
/// span(triangle, row, column, count, dx, dy) for every run of `count` pixel centres inside, the first at offset (dx, dy) from corner
/// 0. In periodic scenes rows and columns are taken modulo the grid and runs are cut at its edge. Rows outside [row_begin, row_end)
/// are skipped.
template <class Span>
void rasterise(const Surface& s, const Projection& p, const std::uint32_t* list, std::size_t begin, std::size_t end, int row_begin,
               int row_end, Span&& span) {
  constexpr int block = 16;
  const auto f = [](double x) { return static_cast<float>(x); };
  const float xx = f(p.x_row.x), xy = f(p.x_row.y), xz = f(p.x_row.z), x0 = f(p.x0);
  const float yx = f(p.y_row.x), yy = f(p.y_row.y), yz = f(p.y_row.z), y0 = f(p.y0);
  const float zx = f(p.z_row.x), zy = f(p.z_row.y), zz = f(p.z_row.z);
  for (std::size_t first = begin; first < end; first += block) {
    const int n = static_cast<int>(std::min<std::size_t>(block, end - first));
    alignas(64) float X[3][block] = {}, Y[3][block] = {}, Z[3][block] = {};
    alignas(64) int ya[block], yb[block], meets[block];
    for (int k = 0; k < 3; ++k) {
      const float* cx = s.corner[3 * k].data();
      const float* cy = s.corner[3 * k + 1].data();
      const float* cz = s.corner[3 * k + 2].data();
      if (list) {
        for (int i = 0; i < n; ++i) {
          const std::uint32_t t = list[first + i];
          X[k][i] = xx * cx[t] + xy * cy[t] + xz * cz[t] + x0;
          Y[k][i] = yx * cx[t] + yy * cy[t] + yz * cz[t] + y0;
          Z[k][i] = zx * cx[t] + zy * cy[t] + zz * cz[t];
        }
      } else {
        const float *bx = cx + first, *by = cy + first, *bz = cz + first;
        for (int i = 0; i < n; ++i) {
          X[k][i] = xx * bx[i] + xy * by[i] + xz * bz[i] + x0;
          Y[k][i] = yx * bx[i] + yy * by[i] + yz * bz[i] + y0;
          Z[k][i] = zx * bx[i] + zy * by[i] + zz * bz[i];
        }
      }
    }
    // most triangles of a coarse grid meet no pixel centre: sort them out sixteen at a time. Where the bounding box holds one centre only,
    // the edges tell; the tolerance leaves close calls to the scan below.
    for (int i = 0; i < block; ++i) {
      const float low = std::min(std::min(Y[0][i], Y[1][i]), Y[2][i]), high = std::max(std::max(Y[0][i], Y[1][i]), Y[2][i]);
      const float left = std::min(std::min(X[0][i], X[1][i]), X[2][i]), right = std::max(std::max(X[0][i], X[1][i]), X[2][i]);
      const float first_row = std::ceil(low - 0.5f), last_row = std::ceil(high - 0.5f) - 1.0f;
      const float first_column = std::ceil(left - 0.5f), last_column = std::ceil(right - 0.5f) - 1.0f;
      ya[i] = static_cast<int>(first_row);
      yb[i] = static_cast<int>(last_row);
      const float x = first_column + 0.5f, y = first_row + 0.5f;
      const float e0 = (X[1][i] - X[0][i]) * (y - Y[0][i]) - (Y[1][i] - Y[0][i]) * (x - X[0][i]);
      const float e1 = (X[2][i] - X[1][i]) * (y - Y[1][i]) - (Y[2][i] - Y[1][i]) * (x - X[1][i]);
      const float e2 = (X[0][i] - X[2][i]) * (y - Y[2][i]) - (Y[0][i] - Y[2][i]) * (x - X[2][i]);
      const float least = std::min(std::min(e0, e1), e2), most = std::max(std::max(e0, e1), e2);
      const int holds = static_cast<int>(first_row <= last_row) & static_cast<int>(first_column <= last_column);
      const int several = static_cast<int>(first_row < last_row) | static_cast<int>(first_column < last_column);
      const int inside = static_cast<int>(least >= -1e-4f) | static_cast<int>(most <= 1e-4f);
      meets[i] = holds & (several | inside);
    }
    unsigned hits = 0;
    for (int i = 0; i < n; ++i) hits |= static_cast<unsigned>(meets[i]) << i;
    for (; hits != 0; hits &= hits - 1) {
      const int i = std::countr_zero(hits);
      if (!p.wraps && (yb[i] < row_begin || ya[i] >= row_end)) continue;
      const std::uint32_t t = list ? list[first + i] : static_cast<std::uint32_t>(first + i);
      if (s.split[t] == 0) continue;
      const float ax = X[1][i] - X[0][i], ay = Y[1][i] - Y[0][i], bx = X[2][i] - X[0][i], by = Y[2][i] - Y[0][i];
      const float area = ax * by - bx * ay;
      if (std::fabs(area) < 1e-12f) continue;
      const float inverse = 1.0f / area;
      ProjectedTriangle triangle;
      triangle.index = t;
      triangle.split = s.split[t];
      triangle.front_up = area > 0.0f;  // both kinds of projection are right-handed about the direction
      triangle.u = {0.0f, by * inverse, -bx * inverse};
      triangle.v = {0.0f, -ay * inverse, ax * inverse};
      const float d1 = Z[1][i] - Z[0][i], d2 = Z[2][i] - Z[0][i];
      triangle.depth = {Z[0][i], d1 * triangle.u.per_x + d2 * triangle.v.per_x, d1 * triangle.u.per_y + d2 * triangle.v.per_y};
      triangle.depth_low = std::min(std::min(Z[0][i], Z[1][i]), Z[2][i]);
      triangle.depth_high = std::max(std::max(Z[0][i], Z[1][i]), Z[2][i]);
      // an edge is walked from its lower end, by both triangles that share it: no gaps, no double hits
      int low = 0, middle = 1, high = 2;
      if (Y[low][i] > Y[middle][i]) std::swap(low, middle);
      if (Y[middle][i] > Y[high][i]) std::swap(middle, high);
      if (Y[low][i] > Y[middle][i]) std::swap(low, middle);
      const float x_low = X[low][i], y_low = Y[low][i], x_middle = X[middle][i], y_middle = Y[middle][i];
      const auto slope = [&](int from, int to) {
        const float rise = Y[to][i] - Y[from][i];
        return rise > 0.0f ? (X[to][i] - X[from][i]) / rise : 0.0f;
      };
      const float long_slope = slope(low, high), lower_slope = slope(low, middle), upper_slope = slope(middle, high);
      const int y_first = p.wraps ? ya[i] : std::max(ya[i], row_begin), y_last = p.wraps ? yb[i] : std::min(yb[i], row_end - 1);
      for (int y = y_first; y <= y_last; ++y) {
        const float yc = static_cast<float>(y) + 0.5f;
        const float x_long = x_low + (yc - y_low) * long_slope;
        const float x_short = yc <= y_middle ? x_low + (yc - y_low) * lower_slope : x_middle + (yc - y_middle) * upper_slope;
        const float xl = std::min(x_long, x_short), xr = std::max(x_long, x_short);
        if (!(xl <= xr)) continue;
        int xa = static_cast<int>(std::ceil(xl - 0.5f)), xb = static_cast<int>(std::ceil(xr - 0.5f)) - 1;
        if (!p.wraps) {
          xa = std::max(xa, 0);
          xb = std::min(xb, p.columns - 1);
          if (xa <= xb) span(triangle, y, xa, xb - xa + 1, static_cast<float>(xa) + 0.5f - X[0][i], yc - Y[0][i]);
          continue;
        }
        if (xa > xb) continue;
        int row = y % p.rows;
        if (row < 0) row += p.rows;
        if (row < row_begin || row >= row_end) continue;
        int column = xa % p.columns;
        if (column < 0) column += p.columns;
        for (int x = xa; x <= xb;) {
          const int run = std::min(xb - x + 1, p.columns - column);
          span(triangle, row, column, run, static_cast<float>(x) + 0.5f - X[0][i], yc - Y[0][i]);
          x += run;
          column = 0;
        }
      }
    }
  }
}

}  // namespace sunfleck
