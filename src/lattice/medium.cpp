#include "lattice/medium.hpp"

#include <algorithm>
#include <cmath>

namespace sunfleck {

namespace {

constexpr double ground_lifts = 4.0;  // upward directions have a fourth of the weights: what the ground sends is spread over them alone

/// Extinction of leaves in a node [m^-1], and its shares.
struct Extinction {
  double whole = 0, absorbed = 0, transport = 0;
};

struct Coefficients {
  double total = 0, absorption = 0, on_leaves = 0;
};

Coefficients coefficients(const Extinction& k, double spacing, LatticeMapping mapping) {
  Coefficients c;
  if (!(k.whole > 0.0)) return c;
  if (mapping == LatticeMapping::matched) {
    c.total = 1.0 / (0.5 + 2.0 / (3.0 * k.transport * spacing));
    c.absorption = std::min(k.absorbed * spacing, c.total);
    c.on_leaves = k.absorbed > 0.0 ? c.absorption / (k.absorbed * spacing) : 1.0;
  } else {
    c.total = -std::expm1(-k.whole * spacing);
    c.absorption = c.total * k.absorbed / k.whole;
    c.on_leaves = c.total / (k.whole * spacing);
  }
  return c;
}

double mean_reflectance(const Optics& o, std::size_t band) {
  return 0.5 * (static_cast<double>(o.reflectance_front[band]) + o.reflectance_back[band]);
}

}  // namespace

std::size_t LatticeMedium::bytes() const {
  return (passes.capacity() + scatters.capacity() + absorbs.capacity() + on_leaves.capacity()) * sizeof(double);
}

LatticeMedium lattice_medium(const NodeGrid& grid, bool periodic, const std::vector<NodeArea>& leaves, const std::vector<Optics>& materials,
                             const Optics* ground, const std::vector<double>& ground_share, LatticeMapping mapping, double density,
                             bool black, std::size_t bands) {
  LatticeMedium medium;
  medium.grid = grid, medium.periodic = periodic, medium.ground = ground != nullptr, medium.bands = bands;
  const std::size_t n = medium.nodes(), inner = grid.nodes(), first = n - inner;
  medium.passes.assign(bands * n, 1.0), medium.scatters.assign(bands * n, 0.0), medium.absorbs.assign(bands * n, 0.0);
  medium.on_leaves.assign(bands * inner, 0.0);
  const double volume = grid.spacing * grid.spacing * grid.spacing;
  std::vector<Extinction> extinction(inner);
  for (std::size_t band = 0; band < bands; ++band) {
    std::fill(extinction.begin(), extinction.end(), Extinction{});
    double bent = 0.0, scattered = 0.0;
    for (const auto& leaf : leaves) {
      const auto& o = materials[leaf.material];
      const double k = 0.5 * density * leaf.area / volume, sends = black ? 0.0 : 1.0;
      const double rho = sends * mean_reflectance(o, band), tau = sends * o.transmittance[band];
      auto& e = extinction[leaf.node];
      e.whole += k;
      e.absorbed += k * std::max(0.0, 1.0 - rho - tau);
      e.transport += k * (1.0 - 4.0 / 9.0 * (tau - rho));
      bent += leaf.area * (tau - rho), scattered += leaf.area * (tau + rho);
    }
    for (std::size_t i = 0; i < inner; ++i) {
      const auto c = coefficients(extinction[i], grid.spacing, mapping);
      const std::size_t at = band * n + first + i;
      medium.passes[at] = 1.0 - c.total;
      medium.absorbs[at] = c.absorption;
      medium.scatters[at] = std::max(0.0, c.total - c.absorption);
      medium.on_leaves[band * inner + i] = density * c.on_leaves;
    }
    for (std::size_t i = 0; ground && i < first; ++i) {
      const double albedo = black ? 0.0 : ground->reflectance_front[band];
      medium.passes[band * n + i] = 0.0;
      medium.scatters[band * n + i] = ground_lifts * albedo * ground_share[i];
      medium.absorbs[band * n + i] = (1.0 - albedo) * ground_share[i];
    }
    if (mapping == LatticeMapping::paper) medium.phase.push_back(lattice_phase(scattered > 0.0 ? bent / scattered : 0.0));
  }
  return medium;
}

}  // namespace sunfleck
