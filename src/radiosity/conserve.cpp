#include "conserve.hpp"

#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

namespace sunfleck {

namespace {

constexpr std::size_t block = 4096;    ///< cells, or parts, that are summed together
constexpr double most_scaling = 0.05;  ///< of scattered light

/// total[columns] + the sum of add(i, sum[columns]) over i < n, in an order that does not depend on threads.
template <class Add>
std::vector<double> sum_blocks(std::vector<double> total, std::size_t n, const Add& add) {
  const std::size_t blocks = (n + block - 1) / block, columns = total.size();
  std::vector<double> partial(blocks * columns, 0.0);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    for (std::size_t i = b * block, end = std::min(n, i + block); i < end; ++i) add(i, partial.data() + b * columns);
  });
  for (std::size_t k = 0; k < partial.size(); ++k) total[k % columns] += partial[k];
  return total;
}

/// total[columns] + what cells scatter of light(row, cell side, state, band) [W].
template <class Light>
std::vector<double> scattered_by_cells(std::vector<double> total, const LitElements& lit, const Light& light) {
  const auto& s = lit.elements.surface;
  return sum_blocks(std::move(total), s.cells(), [&](std::size_t c, double* sum) {
    const auto t = lit.elements.row_of_cell[c];
    if (s.split[t] == 0) return;
    const auto& m = lit.optics_of_row(t);
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t column = 0; column < lit.columns(); ++column)
        sum[column] += static_cast<double>(s.cell_area[t]) * light(t, 2 * c + side, column / lit.bands, column % lit.bands) *
                       albedo(m, side, column % lit.bands);
  });
}

std::vector<double> absorbed_by_parts(const LitElements& lit, const ScatteredLight& light) {
  const std::size_t columns = lit.columns();
  return sum_blocks(std::vector<double>(columns, 0.0), light.area.size(), [&](std::size_t i, double* sum) {
    const bool inside = i >= lit.elements.size();
    const auto& m = lit.facets.materials[lit.elements.material[light.whole[i]]];
    for (std::size_t row = 2 * i, end = row + 2; row < end; ++row) {
      const double area = static_cast<double>(light.area[i]) * (inside ? 1.0 : light.mean_rest[row]);
      for (std::size_t column = 0; column < columns; ++column)
        sum[column] += area * light.gathered[row * columns + column] * (1.0 - albedo(m, row % 2, column % lit.bands));
    }
  });
}

}  // namespace

FirstReflection first_reflection(const std::array<HalfLight, 2>& along, double area_of_line, std::size_t columns) {
  FirstReflection first{std::vector<double>(columns, 0.0), std::vector<double>(columns, 0.0)};
  for (const auto& half : along) {
    for (std::size_t c = 0; c < half.escaped_reflection.size(); ++c) {
      first.escaped[c] += half.escaped_reflection[c] * area_of_line;
      first.all[c] += half.escaped_reflection[c] * area_of_line;
    }
    for (const auto* met : {&half.first_reflection, &half.withheld_reflection})
      for (std::size_t i = 0; i < met->size(); ++i) first.all[i % columns] += static_cast<double>((*met)[i]) * area_of_line;
  }
  return first;
}

double conserve(const LitElements& lit, const FirstReflection& first, ScatteredLight& light, std::vector<std::vector<Balance>>& balance) {
  const std::size_t columns = lit.columns();
  std::vector<double> followed(columns, 0.0);  // what cells scatter of sun and lamps
  if (!lit.direct.sunlit.empty() || !lit.lamp.empty())
    followed = scattered_by_cells(followed, lit, [&](std::size_t t, std::size_t i, std::size_t state, std::size_t band) {
      return static_cast<double>(lit.sun(t, i, state, band)) + lit.lamps(i, state, band);
    });
  std::vector<double> direct = followed;  // and of the sky
  if (!lit.direct.sky.empty())
    direct = scattered_by_cells(direct, lit, [&](std::size_t, std::size_t i, std::size_t state, std::size_t band) {
      return static_cast<double>(lit.sky(i, state, band));
    });
  const auto absorbed = absorbed_by_parts(lit, light);
  std::vector<float> factor(columns, 1.0f);
  double most = 0;
  for (std::size_t column = 0; column < columns; ++column) {
    auto& of = balance[column / lit.bands][column % lit.bands];
    if (first.all[column] > 0.0) of.escaped += first.escaped[column] * followed[column] / first.all[column];
    const double found = absorbed[column] + of.escaped;
    if (!(found > 0.0 && direct[column] > 0.0)) continue;
    const double scale = direct[column] / found;
    if (std::fabs(scale - 1.0) > most_scaling) continue;
    most = std::max(most, std::fabs(scale - 1.0));
    of.escaped *= scale;
    of.scattered_scale = scale;
    factor[column] = static_cast<float>(scale);
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, 2 * light.area.size(), block), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      for (std::size_t c = 0; c < columns; ++c) light.gathered[i * columns + c] *= factor[c];
  });
  return most;
}

}  // namespace sunfleck
