#include "lattice/facet_light.hpp"

#include <algorithm>
#include <cmath>

namespace sunfleck {

std::vector<OpenSides> open_sides(const FacetScene& facets) {
  constexpr double shut = 0.2, outward = 0.8;
  struct Organ {
    double area = 0, out = 0, off = 0;
    Vec3 first{0.0}, whole{0.0};
  };
  std::vector<Organ> organs(facets.organs.size());
  const auto middle = [&](std::size_t f) { return (facets.corners[f][0] + facets.corners[f][1] + facets.corners[f][2]) / 3.0; };
  for (std::size_t f = 0; f < facets.plant_facets; ++f) {
    auto& organ = organs[facets.organ[f]];
    organ.area += facets.area[f];
    organ.first += static_cast<double>(facets.area[f]) * middle(f);
    organ.whole += area_vector(facets.corners[f]);
  }
  for (std::size_t f = 0; f < facets.plant_facets; ++f) {
    auto& organ = organs[facets.organ[f]];
    if (!(organ.area > 0.0)) continue;
    const double out = glm::dot(middle(f) - organ.first / organ.area, area_vector(facets.corners[f]));
    organ.out += out, organ.off += std::abs(out);
  }
  std::vector<OpenSides> sides(facets.size(), OpenSides::both);
  for (std::size_t f = 0; f < facets.plant_facets; ++f) {
    const auto& organ = organs[facets.organ[f]];
    if (glm::length(organ.whole) < shut * organ.area && std::abs(organ.out) > outward * organ.off)
      sides[f] = organ.out > 0.0 ? OpenSides::front : OpenSides::back;
  }
  return sides;
}

TwoSides on_leaf(const LatticeMedium& medium, const LatticeLight& light, std::size_t band, std::span<const CellShare> cells,
                 const Vec3& normal, OpenSides sides) {
  TwoSides out;
  const double area = medium.grid.spacing * medium.grid.spacing;
  const double* on_leaves = medium.on_leaves.data() + band * medium.grid.nodes();
  for (const auto& cell : cells) {
    const std::size_t row = medium.row(cell.node);
    const double scale = cell.share * on_leaves[cell.node] / area, both = 0.5 * std::max(0.0, light.light[row]);
    const double along = light.flux[0][row] * normal.x + light.flux[1][row] * normal.y + light.flux[2][row] * normal.z;
    const double front = std::clamp(0.5 * both - 0.5 * along, 0.0, both);
    if (sides != OpenSides::back) out.front += scale * front;
    if (sides != OpenSides::front) out.back += scale * (both - front);
  }
  return out;
}

double on_ground(const LatticeMedium& medium, const LatticeLight& light, std::span<const CellShare> cells) {
  double out = 0.0;
  for (const auto& cell : cells) out += cell.share * std::max(0.0, light.light[cell.node]);
  return out / (medium.grid.cell.x * medium.grid.cell.y);
}

}  // namespace sunfleck
