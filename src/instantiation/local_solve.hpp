// Light inside copies of one original: the same operator for all lanes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "instantiation/lanes.hpp"
#include "instantiation/line_operator.hpp"

namespace sunfleck {

/// Reflection and transmission of one material, lane by lane.
template <int width>
struct LaneOptics {
  Lanes<width> front, back, transmittance;
};

/// out += share * sum over a row of count * x[column].
template <int width>
inline void add_row(const LinkRows& rows, std::size_t row, float share, const Lanes<width>* x, Lanes<width>& out) {
  rows.row(row, [&](const auto* column, const std::uint8_t* count, std::size_t n) {
    using Vector = typename Lanes<width>::Vector;
    Vector a = {}, b = {};
    constexpr std::size_t ahead = 12;  // entries: what they point to comes from beyond the second cache, in no order
    std::size_t k = 0;
    for (; k + 1 < n; k += 2) {
      __builtin_prefetch(x + column[k + ahead]);
      __builtin_prefetch(x + column[k + ahead + 1]);
      a += static_cast<float>(count[k]) * x[column[k]].v;
      b += static_cast<float>(count[k + 1]) * x[column[k + 1]].v;
    }
    if (k < n) a += static_cast<float>(count[k]) * x[column[k]].v;
    out.v += share * (a + b);
  });
}

/// out_i += sum_j n_ij x_j / W_i over `rows` of the operator.
template <int width>
void add_rows(const LineOperator& op, const LinkRows& rows, const LaneField<width>& x, LaneField<width>& out) {
  for (std::size_t i = 0; i < op.lines.size(); ++i) {
    if (op.lines[i] == 0) continue;
    const float share = 1.0f / static_cast<float>(op.lines[i]);
    for (std::size_t side = 2 * i; side < 2 * i + 2; ++side) add_row<width>(rows, side, share, x.data(), out[side]);
  }
}

/// What comes in from outside, by fields.
template <int width>
void add_outside(const LineOperator& op, const LaneField<width>& field, LaneField<width>& out) {
  add_rows<width>(op, op.outside, field, out);
}

/// What comes from inside. `x`: by what the operator's columns are.
template <int width>
void add_inside(const LineOperator& op, const LaneField<width>& x, LaneField<width>& out) {
  add_rows<width>(op, op.inside, x, out);
}

/// field_f = sum_i n_if B_i / n_f: what goes out. Fields that no line leaves through take the mean of their direction.
template <int width>
void outgoing(const LineOperator& op, const LaneField<width>& radiosity, LaneField<width>& field) {
  using Vector = typename Lanes<width>::Vector;
  field.assign(op.fields(), Lanes<width>{});
  for (std::size_t side = 0; side < radiosity.size(); ++side)
    op.outside.row(side, [&](const auto* column, const std::uint8_t* count, std::size_t n) {
      for (std::size_t k = 0; k < n; ++k) field[column[k]].v += static_cast<float>(count[k]) * radiosity[side].v;
    });
  const std::size_t pixels = std::size_t{op.pixels()} * op.pixels();
  for (std::size_t first = 0; first < op.fields(); first += pixels) {
    Vector sum = {};
    float lines = 0;
    for (std::size_t f = first; f < first + pixels; ++f) {
      sum += field[f].v;
      lines += op.field_lines[f];
    }
    if (lines > 0) sum *= 1.0f / lines;
    for (std::size_t f = first; f < first + pixels; ++f)
      if (op.field_lines[f] > 0)
        field[f].v *= 1.0f / op.field_lines[f];
      else
        field[f].v = sum;
  }
}

struct SweepReport {
  std::uint32_t sweeps = 0;
  float change = 0;  ///< of the last sweep over the radiosities, worst lane
};

/// B = R (E0 + F B) by symmetric Gauss-Seidel sweeps: elements forth, then back, both sides of one together. `material` row of `optics`.
template <int width>
SweepReport solve_inside(const LineOperator& op, const std::vector<std::uint32_t>& material, const std::vector<LaneOptics<width>>& optics,
                         const LaneField<width>& source, float tolerance, LaneField<width>& radiosity) {
  constexpr std::uint32_t most_sweeps = 200;
  using Vector = typename Lanes<width>::Vector;
  radiosity.assign(source.size(), Lanes<width>{});
  SweepReport report;
  const std::size_t n = op.lines.size();
  do {
    Vector change = {}, sum = {};
    for (std::size_t step = 0; step < n; ++step) {
      const std::size_t i = report.sweeps & 1 ? n - 1 - step : step;
      if (op.lines[i] == 0) continue;
      const float share = 1.0f / static_cast<float>(op.lines[i]);
      Lanes<width> front = source[2 * i], back = source[2 * i + 1];
      add_row<width>(op.inside, 2 * i, share, radiosity.data(), front);
      add_row<width>(op.inside, 2 * i + 1, share, radiosity.data(), back);
      const auto& m = optics[material[i]];
      const Vector b_front = m.front.v * front.v + m.transmittance.v * back.v, b_back = m.back.v * back.v + m.transmittance.v * front.v;
      Vector &old_front = radiosity[2 * i].v, &old_back = radiosity[2 * i + 1].v;
      const Vector d_front = b_front - old_front, d_back = b_back - old_back;
      change += (d_front < 0 ? -d_front : d_front) + (d_back < 0 ? -d_back : d_back);
      sum += (b_front < 0 ? -b_front : b_front) + (b_back < 0 ? -b_back : b_back);
      old_front = b_front;
      old_back = b_back;
    }
    ++report.sweeps;
    report.change = 0;
    for (int k = 0; k < width; ++k)
      if (sum[k] > 0) report.change = std::max(report.change, change[k] / sum[k]);
  } while (report.change > tolerance && report.sweeps < most_sweeps);
  return report;
}

}  // namespace sunfleck
