#include "lattice/own_lattice.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/stand_grid.hpp"

namespace sunfleck {

StandLight::Here StandLight::at(const Vec3& point) const {
  const auto& grid = medium_.grid;
  std::array<std::int64_t, 3> low{}, high{};
  std::array<double, 3> part{};
  for (int axis = 0; axis < 3; ++axis) {
    const double at = (point[axis] - grid.low[axis]) / grid.cell[axis] - 0.5, n = static_cast<double>(grid.n[axis]);
    const bool wraps = medium_.periodic && axis < 2;
    if (!wraps && (at < -1.5 || at > n + 0.5)) return {};
    const double within = wraps ? at - n * std::floor(at / n) : std::clamp(at, 0.0, n - 1.0);
    low[axis] = std::min(static_cast<std::int64_t>(within), grid.n[axis] - 1);
    high[axis] = wraps ? (low[axis] + 1) % grid.n[axis] : std::min(low[axis] + 1, grid.n[axis] - 1);
    part[axis] = within - static_cast<double>(low[axis]);
  }
  Here out;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0 / (grid.spacing * grid.spacing);
    std::array<std::int64_t, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const bool up = (corner >> axis & 1) != 0;
      weight *= up ? part[axis] : 1.0 - part[axis];
      at[axis] = up ? high[axis] : low[axis];
    }
    if (weight == 0.0) continue;
    const auto row = medium_.row(static_cast<std::uint32_t>((at[2] * grid.n[1] + at[1]) * grid.n[0] + at[0]));
    out.fluence += weight * light_.light[row];
    out.flux += weight * Vec3{light_.flux[0][row], light_.flux[1][row], light_.flux[2][row]};
  }
  return out;
}

OwnLattice::OwnLattice(const PlantFacets& facets, std::vector<OpenSides> sides, const std::vector<Optics>& materials, std::uint32_t nodes,
                       LatticeMapping mapping, double density, std::size_t bands)
    : sides_(std::move(sides)) {
  Box box;
  for (const auto& t : facets.corners)
    for (const auto& p : t) box.add(p);
  const NodeGrid grid = grid_over(box, nodes);
  cells_ = FacetCells(grid, false, facets.size(), facets.size(), [&](std::size_t f) { return facets.corners[f]; });
  std::vector<NodeArea> leaves;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const Vec3 vector = area_vector(facets.corners[f]);
    const double area = glm::length(vector);
    normal_.push_back(area > 0.0 ? vector / area : Vec3{0.0});
    for (const auto& cell : cells_.of(f)) leaves.push_back({cell.node, facets.optics[f], leaf_area_of(area, sides_[f]) * cell.share});
  }
  medium_ = lattice_medium(grid, false, leaves, materials, nullptr, {}, mapping, density, false, bands);
}

std::vector<float> OwnLattice::light(const Affine& map, std::size_t band, const std::vector<double>& sends, const StandLight& stand,
                                     const SteadySettings& settings, const Progress& progress) const {
  const auto& grid = medium_.grid;
  const double scale = std::cbrt(std::abs(glm::determinant(map.linear))), spacing = grid.spacing * scale;
  std::vector<LatticeColumn> column(1);
  column[0].band = band;
  column[0].source.assign(medium_.nodes(), 0.0);
  for (std::size_t f = 0; f < sends.size(); ++f)
    for (const auto& cell : cells_.of(f)) column[0].source[cell.node] += cell.share * sends[f];
  column[0].inflow = [&](std::size_t d, std::int64_t x, std::int64_t y, std::int64_t z) {
    const Vec3 step{lattice_step[d][0], lattice_step[d][1], lattice_step[d][2]};
    const Vec3 from = grid.low + (Vec3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)} + 0.5 - step) * grid.cell;
    const auto here = stand.at(map.point(from));
    const Vec3 towards = glm::normalize(map.vector(step));
    return lattice_weight(d) * std::max(0.0, here.fluence + 3.0 * glm::dot(here.flux, towards)) * spacing * spacing;
  };
  const auto steady = steady_state(medium_, column, settings, progress, [](std::uint32_t, double) {});
  std::vector<float> out(2 * sends.size());
  for (std::size_t f = 0; f < sends.size(); ++f) {
    const auto sides = on_leaf(medium_, steady.columns[0], band, cells_.of(f), normal_[f], sides_[f]);
    out[2 * f] = static_cast<float>(sides.front / (scale * scale));
    out[2 * f + 1] = static_cast<float>(sides.back / (scale * scale));
  }
  return out;
}

}  // namespace sunfleck
