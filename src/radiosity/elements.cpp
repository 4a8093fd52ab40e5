#include "elements.hpp"

#include <algorithm>
#include <cmath>

#include <sunfleck/core/memory.hpp>

#include "cluster_order.hpp"

namespace sunfleck {

namespace {

/// Area-weighted mean area of plant organs (of ground cells where there is no plant) [m^2].
double mean_organ_area(const FacetScene& facets) {
  const std::size_t end = facets.plant_facets > 0 ? facets.plant_facets : facets.size();
  std::vector<double> organ(facets.organs.size(), 0.0);
  for (std::size_t f = 0; f < end; ++f) organ[facets.organ[f]] += facets.area[f];
  double sum = 0, squares = 0;
  for (const double a : organ) {
    sum += a;
    squares += a * a;
  }
  return sum > 0 ? squares / sum : 0.0;
}

std::uint16_t split_for(double area, double aim) {
  return static_cast<std::uint16_t>(std::clamp(std::lround(std::sqrt(area / aim)), 1L, 32L));
}

/// Flat ground farther from the plants than a third of their size is lit too evenly to be worth cutting.
bool near_plants(const Triangle& t, const Box& plants) {
  const Vec3 size = plants.size();
  const double margin = std::max({size.x, size.y, size.z}) / 3.0;
  for (const auto& p : t)
    if (p.x > plants.low.x - margin && p.x < plants.high.x + margin && p.y > plants.low.y - margin && p.y < plants.high.y + margin) return true;
  return false;
}

}  // namespace

std::size_t Elements::bytes() const {
  return bytes_of(order) + surface.bytes() + bytes_of(element_of_cell) + bytes_of(first_cell) + bytes_of(area) + bytes_of(material);
}

Elements make_elements(const Scene& scene, const FacetScene& facets, const RadiosityDensity& density, bool flat) {
  Elements e;
  const std::size_t n = facets.size();
  e.organ_area = mean_organ_area(facets);
  e.element_area = e.organ_area / density.elements_per_organ;
  const auto tree = cluster_order(scene, facets);
  // facets by organ, file order within
  std::vector<std::uint32_t> start(facets.organs.size() + 1, 0), members(n);
  for (std::size_t f = 0; f < n; ++f) ++start[facets.organ[f] + 1];
  for (std::size_t o = 0; o + 1 < start.size(); ++o) start[o + 1] += start[o];
  {
    auto cursor = start;
    for (std::size_t f = 0; f < n; ++f) members[cursor[facets.organ[f]]++] = static_cast<std::uint32_t>(f);
  }
  const bool ground_is_flat = scene.ground && !scene.ground->mesh && !scene.periodic;
  Box plants;
  if (ground_is_flat)
    for (std::size_t f = 0; f < facets.plant_facets; ++f)
      if (facets.area[f] > 0)
        for (const auto& p : facets.corners[f]) plants.add(p);
  std::vector<std::uint16_t> split(n);
  e.order.reserve(n);
  e.first_cell.push_back(0);
  std::uint32_t cells = 0;
  const auto end_element = [&](double area, std::uint32_t material) {
    e.area.push_back(static_cast<float>(area));
    e.material.push_back(material);
    e.first_cell.push_back(cells);
  };
  for (const auto organ : tree.organs) {
    double organ_area = 0;
    for (std::uint32_t k = start[organ]; k < start[organ + 1]; ++k) organ_area += facets.area[members[k]];
    const double parts = std::max(1.0, std::round(organ_area / e.element_area)), part_area = organ_area / parts;
    double gathered = 0;
    bool open = false;
    for (std::uint32_t k = start[organ]; k < start[organ + 1]; ++k) {
      const auto f = members[k];
      const double area = facets.area[f];
      const auto material = facets.optics[f];
      std::uint16_t s = 1;
      if (!flat && area > 0 && (f < facets.plant_facets || !ground_is_flat || facets.plant_facets == 0 || near_plants(facets.corners[f], plants)))
        s = split_for(area, e.element_area);
      split[e.order.size()] = s;
      e.order.push_back(f);
      if (open && (s > 1 || material != e.material.back())) open = false;
      if (s > 1) {
        for (int c = 0; c < s * s; ++c) {
          ++cells;
          end_element(area / (s * s), material);
        }
        continue;
      }
      ++cells;
      if (open) {
        e.area.back() += static_cast<float>(area);
        e.first_cell.back() = cells;
      } else {
        end_element(area, material);
        open = true;
        gathered = 0;
      }
      gathered += area;
      if (flat || gathered >= 0.999 * part_area) open = false;
    }
  }
  e.surface = make_surface(facets, e.order, split, ground_is_flat);
  e.element_of_cell.resize(cells);
  for (std::uint32_t i = 0; i < e.size(); ++i)
    for (std::uint32_t c = e.first_cell[i]; c < e.first_cell[i + 1]; ++c) e.element_of_cell[c] = i;
  return e;
}

}  // namespace sunfleck
