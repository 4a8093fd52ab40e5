#include "part_sources.hpp"

#include <tbb/parallel_for.h>

namespace sunfleck {

namespace {

void source_of_lines(const LitElements& lit, const SkySums& sums, std::size_t element, std::size_t row, double lines, float& rest_of,
                     float* source) {
  const auto& e = lit.elements;
  double seen = 0;
  std::vector<double> sky(sums.skies(), 0.0);
  for (std::uint32_t k = e.first_cell[element]; k < e.first_cell[element + 1]; ++k) {
    const std::size_t cell_side = 2 * std::size_t{e.cells[k]} + row % 2;
    seen += sums.seen(cell_side);
    for (std::size_t j = 0; j < sky.size(); ++j) sky[j] += sums.seen(cell_side, 1 + j);
  }
  const double all = std::max(lines, seen);
  rest_of = static_cast<float>(1.0 - seen / all);
  for (std::size_t column = 0; column < lit.columns(); ++column)
    if (const auto k = lit.direct.sky_of_state[column / lit.bands]; k != DirectLight::none)
      source[column] = static_cast<float>(lit.scene.states[column / lit.bands].sky->irradiance[column % lit.bands] * sky[k] / all);
}

void source_of_cells(const LitElements& lit, std::size_t element, std::size_t row, double open, float* source) {
  std::vector<double> sum(lit.columns(), 0.0);
  lit.for_cells(element, [&](std::size_t c, double a) {
    for (std::size_t column = 0; column < sum.size(); ++column)
      sum[column] += a * lit.sky(2 * c + row % 2, column / lit.bands, column % lit.bands);
  });
  for (std::size_t column = 0; column < sum.size(); ++column) source[column] = static_cast<float>(sum[column] / open);
}

}  // namespace

PartSources part_sources(const LitElements& lit, const LineLinks& links, const std::array<HalfLight, 2>& along, ScatteredLight& light) {
  const auto& e = lit.elements;
  const std::size_t sides = links.sides(), columns = lit.columns();
  PartSources out;
  for (std::size_t h = 0; h < 2; ++h) {
    out.irradiance[h].assign(sides * columns, 0.0f);
    out.rest[h].assign(sides, 1.0f);
  }
  light.area.assign(sides / 2, 0.0f);
  light.mean_rest.assign(sides, 1.0f);
  if (!e.emission.empty()) light.rest_sent.assign(sides, 1.0f);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, e.size(), 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      double area = 0, hidden = 0;
      lit.for_cells(i, [&](std::size_t c, double a) {
        area += a;
        hidden += a * light.enclosed_share(c);
      });
      const double open = area - hidden;
      const std::uint32_t inside = links.enclosed_part.empty() ? LineLinks::none : links.enclosed_part[i];
      if (inside != LineLinks::none) light.area[inside] = static_cast<float>(hidden);
      light.area[i] = static_cast<float>(open);
      if (open <= 1e-6 * area || area == 0.0 || lit.direct.sky_seen.empty()) continue;
      for (std::size_t row = 2 * i, end = row + 2; row < end; ++row) {
        double rest_of = 0;
        lit.for_cells(i, [&](std::size_t c, double a) { rest_of += a * (lit.rest(2 * c + row % 2) - light.enclosed_share(c)); });
        light.mean_rest[row] = static_cast<float>(rest_of / open);
        if (!e.emission.empty()) {
          double sent = 0;
          lit.for_cells(i, [&](std::size_t c, double a) {
            sent += a * (lit.rest(2 * c + row % 2) - light.enclosed_share(c)) * e.emission[2 * c + row % 2];
          });
          light.rest_sent[row] = static_cast<float>(sent / (32.0 * open));
        }
        for (std::size_t h = 0; h < 2; ++h) {
          const auto& half = links.half[h];
          double lines = 0;
          for (std::uint32_t k = e.first_cell[i]; k < e.first_cell[i + 1]; ++k) lines += along[h].sky.all(e.cells[k]);
          if (inside != LineLinks::none && lines > 0)
            lines *= half.lines[row] / (half.lines[row] + half.lines[2 * std::size_t{inside} + row % 2]);
          float* source = out.irradiance[h].data() + row * columns;
          if (lines > 0.5)
            source_of_lines(lit, along[h].sky, i, row, lines, out.rest[h][row], source);
          else {
            out.rest[h][row] = light.mean_rest[row];
            source_of_cells(lit, i, row, open, source);
          }
        }
      }
    }
  });
  return out;
}

SunReflection sun_reflection(const LitElements& lit) {
  SunReflection out;
  if (lit.direct.sunlit.empty() && lit.lamp.empty()) return out;
  const std::size_t cells = lit.elements.surface.cells(), columns = lit.columns();
  out.columns = columns;
  out.exitance.assign(2 * cells * columns, 0.0f);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells, 1024), [&](const auto& range) {
    for (std::size_t c = range.begin(); c < range.end(); ++c) {
      const auto t = lit.elements.row_of_cell[c];
      const auto& m = lit.optics_of_row(t);
      for (std::size_t column = 0; column < columns; ++column) {
        const std::size_t state = column / lit.bands, band = column % lit.bands;
        const float front = lit.sun(t, 2 * c, state, band) + lit.lamps(2 * c, state, band),
                    back = lit.sun(t, 2 * c + 1, state, band) + lit.lamps(2 * c + 1, state, band);
        out.exitance[2 * c * columns + column] = m.reflectance_front[band] * front + m.transmittance[band] * back;
        out.exitance[(2 * c + 1) * columns + column] = m.reflectance_back[band] * back + m.transmittance[band] * front;
      }
    }
  });
  return out;
}

}  // namespace sunfleck
