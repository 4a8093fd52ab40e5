// A scene cut into elements, and the light that meets them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <sunfleck/radiosity/elements.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/scene.hpp>

#include "direct_light.hpp"
#include "lamp_cells.hpp"
#include "transport.hpp"

namespace sunfleck {

/// Reflectance and transmittance of one side together.
inline double albedo(const Optics& optics, std::size_t side, std::size_t band) {
  return static_cast<double>(side == 0 ? optics.reflectance_front[band] : optics.reflectance_back[band]) + optics.transmittance[band];
}

/// Elements of a scene and what sun, sky and lamps bring to their cells before any scattering. Columns are states x bands. Side index:
/// 2 * cell + (0 front, 1 back); irradiance is in W m^-2, or the band's unit.
struct LitElements {
  LitElements(const Scene& in, const FacetScene& of) : scene(in), facets(of), states(in.states.size()), bands(of.bands) {}

  const Scene& scene;
  const FacetScene& facets;
  std::size_t states, bands;
  Elements elements;
  DirectLight direct;
  LampIrradiance lamp;

  std::size_t columns() const { return states * bands; }
  const Optics& optics_of_row(std::size_t t) const { return facets.materials[facets.optics[elements.order[t]]]; }

  float sky(std::size_t cell_side, std::size_t state, std::size_t band) const {
    const auto k = direct.sky_of_state[state];
    return k == DirectLight::none ? 0.0f : static_cast<float>(scene.states[state].sky->irradiance[band]) * direct.sky[k][cell_side];
  }
  /// On a cell of row t of the surface.
  float sun(std::size_t t, std::size_t cell_side, std::size_t state, std::size_t band) const {
    const auto k = direct.sun_of_state[state];
    if (k == DirectLight::none) return 0.0f;
    const auto irradiance = static_cast<float>(scene.states[state].sun->irradiance[band]);
    if (!direct.wide_sun[k].empty()) return irradiance * direct.wide_sun[k][cell_side];
    const float cosine = cell_side & 1 ? -direct.sun_cosine[k][t] : direct.sun_cosine[k][t];
    return irradiance * std::max(0.0f, cosine) * direct.sunlit[k][cell_side];
  }
  float lamps(std::size_t cell_side, std::size_t state, std::size_t band) const { return lamp.at(cell_side, state, band, bands); }

  /// Fraction of a side's hemisphere that is not open sky.
  float rest(std::size_t cell_side) const { return direct.sky_seen.empty() ? 1.0f : std::max(0.0f, 1.0f - direct.sky_seen[cell_side]); }

  /// Calls f(cell, its area) for the cells of an element that have one.
  template <class F>
  void for_cells(std::size_t element, const F& f) const {
    const auto& s = elements.surface;
    for (std::uint32_t k = elements.first_cell[element]; k < elements.first_cell[element + 1]; ++k) {
      const auto c = elements.cells[k];
      const auto t = elements.row_of_cell[c];
      if (s.split[t] > 0) f(c, static_cast<double>(s.cell_area[t]));
    }
  }
};

/// Scattered light on the parts of a scene (the elements, then their enclosed parts, see LineLinks), spread over what of a cell's
/// hemisphere is not open sky. Empty where nothing scatters.
struct ScatteredLight {
  Field gathered;                    ///< [2 * parts][columns] mean over what is not open sky
  std::vector<float> area;           ///< [parts] one-sided [m^2]
  std::vector<float> rest_sent;      ///< [2 * parts] the same mean, each cell by Elements::emission; empty = mean_rest
  std::vector<float> mean_rest;      ///< [2 * parts] fraction of the hemisphere that is not open sky, area mean over the part's cells
  std::vector<std::uint32_t> whole;  ///< [parts] the element that a part belongs to
  std::vector<std::uint32_t> enclosed_part;  ///< [elements] as LineLinks
  std::vector<float> enclosed;               ///< [cells] fraction of a cell that is enclosed; may be empty

  bool empty() const { return gathered.empty(); }
  float enclosed_share(std::size_t cell) const { return enclosed.empty() ? 0.0f : enclosed[cell]; }

  /// Irradiance on a side of a cell.
  float on(const LitElements& lit, std::uint32_t cell, std::size_t side, std::size_t column) const {
    if (empty()) return 0.0f;
    const std::size_t columns = lit.columns();
    const auto element = lit.elements.element_of_cell[cell];
    const float open = lit.rest(2 * cell + side), inside = enclosed_share(cell), seen = gathered[(2 * element + side) * columns + column];
    if (inside == 0.0f) return open * seen;
    const float seen_inside = gathered[(2 * enclosed_part[element] + side) * columns + column];
    return (open - inside) * seen + inside * seen_inside;
  }
};

}  // namespace sunfleck
