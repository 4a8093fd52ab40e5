#include "light_rows.hpp"

#include <tbb/parallel_for.h>

namespace sunfleck {

namespace {

/// Light on the two sides of a facet, means over its cells.
struct ArrivingLight {
  std::vector<float> scattered;  ///< [2][columns] irradiance [W m^-2]
  std::vector<float> sky, lit;   ///< [2][skies], [2][suns] as in DirectLight
  std::vector<float> wide;       ///< [2][suns] DirectLight::wide_sun; 0 for narrow suns
  std::vector<float> lamp;       ///< [2][sets of lamps][b] irradiance [W m^-2]
};

class RowBlock {
 public:
  RowBlock(const LitElements& lit, const ScatteredLight& scattered) : lit_(lit), scattered_(scattered) {}

  /// Facets `first` to first + count - 1; their irradiance [s][count][2][b] and sunlit fractions [s][count][2].
  std::vector<float> irradiance, sunlit;

  void start(std::size_t first, std::size_t count) {
    first_ = first;
    count_ = count;
    irradiance.assign(lit_.states * count * 2 * lit_.bands, 0.0f);
    if (!lit_.direct.sunlit.empty()) sunlit.assign(lit_.states * count * 2, 0.0f);
  }

  /// Facet first + i, whose first row of the surface is t.
  void facet(std::size_t i, std::size_t t, ArrivingLight& light, std::vector<Balance>& balance) {
    const auto& optics = lit_.optics_of_row(t);
    const double area = lit_.facets.area[first_ + i];
    const bool is_plant = first_ + i < lit_.facets.plant_facets;
    const auto& direct_light = lit_.direct;
    const std::size_t skies = direct_light.sky.size(), suns = direct_light.sunlit.size(), bands = lit_.bands;
    light_of_facet(t, light);
    for (std::size_t state = 0; state < lit_.states; ++state) {
      const auto& sky = lit_.scene.states[state].sky;
      const auto& sun = lit_.scene.states[state].sun;
      const auto sky_row = direct_light.sky_of_state[state], sun_row = direct_light.sun_of_state[state];
      const auto lamp_row = lit_.lamp.empty() ? Lamps::none : lit_.lamp.set_of_state[state];
      for (std::size_t side = 0; side < 2; ++side) {
        const float seen = sky_row == DirectLight::none ? 0.0f : light.sky[side * skies + sky_row];
        float lit = 0.0f;
        if (sun_row != DirectLight::none) {
          const float cosine = direct_light.sun_cosine[sun_row][t];
          sunlit[(state * count_ + i) * 2 + side] = light.lit[side * suns + sun_row];
          lit = direct_light.wide_sun[sun_row].empty() ? light.lit[side * suns + sun_row] * std::max(0.0f, side == 0 ? cosine : -cosine)
                                                       : light.wide[side * suns + sun_row];
        }
        for (std::size_t band = 0; band < bands; ++band) {
          float direct = 0.0f;
          if (sky_row != DirectLight::none) direct += static_cast<float>(sky->irradiance[band]) * seen;
          if (sun_row != DirectLight::none) direct += static_cast<float>(sun->irradiance[band]) * lit;
          if (lamp_row != Lamps::none) direct += light.lamp[(side * lit_.lamp.sets.size() + lamp_row) * bands + band];
          const std::size_t column = state * bands + band;
          const float e = scattered_.empty() ? direct : direct + light.scattered[side * lit_.columns() + column];
          irradiance[((state * count_ + i) * 2 + side) * bands + band] = e;
          auto& sums = balance[column];
          sums.incident += area * direct;
          const double kept =
              (1.0 - (side == 0 ? optics.reflectance_front[band] : optics.reflectance_back[band])) - optics.transmittance[band];
          (is_plant ? sums.leaves : sums.ground) += area * kept * e;
        }
      }
    }
  }

 private:
  void light_of_facet(std::size_t t, ArrivingLight& light) const {
    const auto& e = lit_.elements;
    const auto& direct = lit_.direct;
    const std::size_t skies = direct.sky.size(), suns = direct.sunlit.size(), bands = lit_.bands, columns = lit_.columns();
    const std::size_t lamp_values = lit_.lamp.sets.size() * bands;
    light.scattered.assign(scattered_.empty() ? 0 : 2 * columns, 0.0f);
    light.sky.assign(2 * skies, 0.0f);
    light.lit.assign(2 * suns, 0.0f);
    light.wide.assign(2 * suns, 0.0f);
    light.lamp.assign(2 * lamp_values, 0.0f);
    const auto add = [&](std::size_t part, std::size_t side, float part_share) {
      const float* from = scattered_.gathered.data() + (2 * part + side) * columns;
      float* to = light.scattered.data() + side * columns;
      for (std::size_t column = 0; column < columns; ++column) to[column] += part_share * from[column];
    };
    e.for_cells_of_facet(t, [&](std::uint32_t c, float share) {
      for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t cell_side = 2 * std::size_t{c} + side;
        for (std::size_t k = 0; k < skies; ++k) light.sky[side * skies + k] += share * direct.sky[k][cell_side];
        for (std::size_t k = 0; k < suns; ++k) light.lit[side * suns + k] += share * direct.sunlit[k][cell_side];
        for (std::size_t k = 0; k < suns; ++k)
          if (!direct.wide_sun[k].empty()) light.wide[side * suns + k] += share * direct.wide_sun[k][cell_side];
        for (std::size_t k = 0; k < lamp_values; ++k)
          light.lamp[side * lamp_values + k] += share * lit_.lamp.sets[k / bands][cell_side * bands + k % bands];
        if (scattered_.empty()) continue;
        const auto element = lit_.elements.element_of_cell[c];
        const float inside = scattered_.enclosed_share(c);
        add(element, side, share * (lit_.rest(cell_side) - inside));
        if (inside > 0.0f) add(scattered_.enclosed_part[element], side, share * inside);
      }
    });
  }

  const LitElements& lit_;
  const ScatteredLight& scattered_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace

void write_light_rows(const LitElements& lit, const ScatteredLight& scattered, const std::vector<std::uint32_t>& row_of_facet,
                      IrradianceSink& sink, std::vector<std::vector<Balance>>& balance, Progress& progress) {
  constexpr std::size_t chunk = 16384, blocks = 16, block = chunk / blocks;
  const auto& surface = lit.elements.surface;
  const std::size_t n = lit.facets.size();
  RowBlock rows(lit, scattered);
  std::vector<std::vector<Balance>> partial(blocks, std::vector<Balance>(lit.columns()));
  for (std::size_t first = 0; first < n; first += chunk) {
    progress.check();
    const std::size_t count = std::min(chunk, n - first);
    rows.start(first, count);
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
      std::fill(partial[b].begin(), partial[b].end(), Balance{});
      ArrivingLight light;
      for (std::size_t i = b * block, end = std::min(count, (b + 1) * block); i < end; ++i) {
        const std::size_t t = row_of_facet[first + i];
        if (surface.split[t] > 0) rows.facet(i, t, light, partial[b]);
      }
    });
    for (const auto& p : partial)
      for (std::size_t c = 0; c < lit.columns(); ++c) {
        auto& sums = balance[c / lit.bands][c % lit.bands];
        sums.incident += p[c].incident;
        sums.leaves += p[c].leaves;
        sums.ground += p[c].ground;
      }
    sink.rows({first, count, rows.irradiance.data(), rows.sunlit.empty() ? nullptr : rows.sunlit.data(), nullptr});
  }
}

}  // namespace sunfleck
