#include <sunfleck/result/result_geometry.hpp>

#include <algorithm>

namespace sunfleck {

namespace {

/// Calls plant(copy, shape, first triangle of the shape, count, position in the range) and ground(first triangle, count, position).
template <class PlantPart, class GroundPart>
void walk(const ResultGeometry& g, std::size_t first, std::size_t count, PlantPart plant, GroundPart ground) {
  const std::size_t end = first + count;
  std::size_t at = first;
  while (at < std::min(end, g.plant_facets)) {
    const auto after =
        std::upper_bound(g.copies.begin(), g.copies.end(), at, [](std::size_t f, const auto& c) { return f < c.first_facet; });
    const auto& copy = *(after - 1);
    const auto& starts = g.plants[copy.plant].shape_facet;
    const std::size_t local = at - copy.first_facet;
    const auto shape = static_cast<std::size_t>(std::upper_bound(starts.begin(), starts.end(), local) - starts.begin()) - 1;
    const std::size_t taken = std::min(end - at, starts[shape + 1] - local);
    plant(copy, shape, local - starts[shape], taken, at - first);
    at += taken;
  }
  if (at < end) ground(at - g.plant_facets, end - at, at - first);
}

}  // namespace

std::vector<Triangle> ResultGeometry::corners(std::size_t first, std::size_t count) const {
  std::vector<Triangle> out(count);
  walk(
      *this, first, count,
      [&](const Copy& copy, std::size_t shape, std::size_t triangle, std::size_t n, std::size_t at) {
        const Plant& plant = *plants[copy.plant].plant;
        const Shape& piece = plant.shapes[shape];
        const Affine to_world = copy.map * piece.placement;
        const bool mirrors = to_world.mirrors();
        for (std::size_t i = 0; i < n; ++i) {
          Triangle c = plant.meshes[piece.mesh].corners(piece.first_triangle + triangle + i);
          for (auto& p : c) p = to_world.point(p);
          if (mirrors) std::swap(c[1], c[2]);
          out[at + i] = c;
        }
      },
      [&](std::size_t triangle, std::size_t n, std::size_t at) {
        for (std::size_t i = 0; i < n; ++i) out[at + i] = ground.corners(triangle + i);
      });
  return out;
}

std::vector<std::uint32_t> ResultGeometry::optics(std::size_t first, std::size_t count) const {
  std::vector<std::uint32_t> out(count);
  walk(
      *this, first, count,
      [&](const Copy& copy, std::size_t shape, std::size_t, std::size_t n, std::size_t at) {
        std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(at), n, plants[copy.plant].shape_optics[shape]);
      },
      [&](std::size_t, std::size_t n, std::size_t at) { std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(at), n, ground_optics); });
  return out;
}

std::vector<std::uint32_t> ResultGeometry::types_of(std::size_t first, std::size_t count) const {
  std::vector<std::uint32_t> out(count);
  walk(
      *this, first, count,
      [&](const Copy& copy, std::size_t shape, std::size_t, std::size_t n, std::size_t at) {
        const Plant& plant = *plants[copy.plant].plant;
        std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(at), n, plant.structures[plant.shapes[shape].structure].type);
      },
      [&](std::size_t, std::size_t n, std::size_t at) { std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(at), n, no_parent); });
  return out;
}

const std::vector<std::string>& ResultGeometry::types() const {
  static const std::vector<std::string> none;
  return plants.empty() ? none : plants.front().plant->types;
}

}  // namespace sunfleck
