#include <sunfleck/radiosity/elements.hpp>

#include <algorithm>
#include <cmath>

#include <sunfleck/core/memory.hpp>

namespace sunfleck {

namespace {

/// Mean area of plant organs (of ground cells where no plant has an area; 1 where nothing has one: no line meets anything, however many
/// there are) [m^2]. The plain mean, not the area-weighted one: with lines
/// of even density, N_o ~ A_o lines meet organ o, its squared error goes like 1 / A_o, and the area-weighted mean squared error like
/// (number of organs) / (total area).
double mean_organ_area(const FacetScene& facets) {
  const auto plants = facets.area.begin() + static_cast<std::ptrdiff_t>(facets.plant_facets);
  const bool any_plant = std::any_of(facets.area.begin(), plants, [](float area) { return area > 0.0f; });
  const std::size_t end = any_plant ? facets.plant_facets : facets.size();
  std::vector<bool> seen(facets.organs.size(), false);
  double sum = 0, organs = 0;
  for (std::size_t f = 0; f < end; ++f) {
    if (facets.area[f] == 0.0f) continue;
    sum += facets.area[f];
    if (!seen[facets.organ[f]]) organs += 1;
    seen[facets.organ[f]] = true;
  }
  return organs > 0 ? sum / organs : 1.0;
}

/// Organs in tree order, but within small clusters those of one material together, so that small ones can share an element.
std::vector<std::uint32_t> gather_materials(const ClusterOrder& tree, const std::vector<std::uint32_t>& material_of_organ) {
  auto organs = tree.organs;
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const auto& node = tree.nodes[stack.back()];
    stack.pop_back();
    if (node.organ_count <= organs_sharing_elements)
      std::stable_sort(organs.begin() + node.first_organ, organs.begin() + node.first_organ + node.organ_count,
                       [&](std::uint32_t a, std::uint32_t b) { return material_of_organ[a] < material_of_organ[b]; });
    else
      for (std::uint32_t c = 0; c < node.child_count; ++c) stack.push_back(node.first_child + c);
  }
  return organs;
}

/// Cells tell sunlit from shaded parts of an element apart, where it reflects the sun's light on.
constexpr double cells_per_element = 2.0;

std::uint16_t split_for(double area, double aim) {
  return static_cast<std::uint16_t>(std::clamp(std::lround(std::sqrt(area / aim)), 1L, 32L));
}

/// Flat ground farther from the plants than a third of their size is lit too evenly to be worth cutting.
bool near_plants(const Triangle& t, const Box& plants) {
  const Vec3 size = plants.size();
  const double margin = std::max({size.x, size.y, size.z}) / 3.0;
  for (const auto& p : t)
    if (p.x > plants.low.x - margin && p.x < plants.high.x + margin && p.y > plants.low.y - margin && p.y < plants.high.y + margin)
      return true;
  return false;
}

/// An element that cells are being gathered into.
struct OpenElement {
  bool open = false;
  std::uint32_t index = 0;
};

}  // namespace

std::size_t Elements::bytes() const {
  return bytes_of(order) + surface.bytes() + bytes_of(element_of_cell) + bytes_of(row_of_cell) + bytes_of(organ_of_row) +
         bytes_of(first_cell) + bytes_of(cells) + bytes_of(area) + bytes_of(material);
}

Elements make_elements(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings) {
  const bool flat = settings.method == RadiosityMethod::flat;
  Elements e;
  const std::size_t n = facets.size();
  e.organ_area = mean_organ_area(facets);
  e.element_area = e.organ_area / settings.density.elements_per_organ;
  e.tree = cluster_order(scene, facets);
  // facets by organ, file order within
  std::vector<std::uint32_t> start(facets.organs.size() + 1, 0), members(n), material_of_organ(facets.organs.size(), 0);
  for (std::size_t f = 0; f < n; ++f) ++start[facets.organ[f] + 1];
  for (std::size_t o = 0; o + 1 < start.size(); ++o) start[o + 1] += start[o];
  {
    auto cursor = start;
    for (std::size_t f = 0; f < n; ++f) members[cursor[facets.organ[f]]++] = static_cast<std::uint32_t>(f);
  }
  for (std::size_t f = n; f-- > 0;) material_of_organ[facets.organ[f]] = facets.optics[f];
  const auto organs = gather_materials(e.tree, material_of_organ);

  const bool ground_is_flat = scene.ground && !scene.ground->mesh && !scene.periodic;
  Box plants;
  if (ground_is_flat)
    for (std::size_t f = 0; f < facets.plant_facets; ++f)
      if (facets.area[f] > 0)
        for (const auto& p : facets.corners[f]) plants.add(p);
  std::vector<std::uint16_t> split;
  split.reserve(n);
  e.order.reserve(n);
  for (const auto organ : organs)
    for (std::uint32_t k = start[organ]; k < start[organ + 1]; ++k) {
      const auto f = members[k];
      const bool cut = !flat && facets.area[f] > 0 &&
                       (f < facets.plant_facets || !ground_is_flat || facets.plant_facets == 0 || near_plants(facets.corners[f], plants));
      split.push_back(cut ? split_for(facets.area[f], e.element_area / cells_per_element) : std::uint16_t{1});
      e.order.push_back(f);
    }
  e.surface = make_surface(facets, e.order, split, ground_is_flat);
  const auto& s = e.surface;
  e.organ_of_row.resize(n);
  for (std::size_t t = 0; t < n; ++t) e.organ_of_row[t] = facets.organ[e.order[t]];
  e.row_of_cell.resize(s.cells());
  for (std::uint32_t t = 0; t < s.size(); ++t)
    for (std::uint32_t c = s.first_cell[t]; c < s.first_cell[t + 1]; ++c) e.row_of_cell[c] = t;

  e.element_of_cell.resize(s.cells());
  const double small = 0.5 * e.element_area;  // smaller organs share an element with neighbours of their material
  OpenElement current;
  Box box;
  std::uint32_t row = 0;
  for (const auto organ : organs) {
    double organ_area = 0;
    Box organ_box;
    for (std::uint32_t k = start[organ]; k < start[organ + 1]; ++k) {
      organ_area += facets.area[members[k]];
      for (const auto& p : facets.corners[members[k]]) organ_box.add(p);
    }
    const bool is_small = !flat && organ_area < small && start[organ] < start[organ + 1] && members[start[organ]] < facets.plant_facets;
    Box both = box;
    both.add(organ_box);
    const bool joins = is_small && glm::length(both.size()) < 6.0 * std::sqrt(e.element_area);
    if (!joins) {
      current.open = false;
      box = organ_box;
    } else {
      box = both;
    }
    const double part_area = is_small ? e.element_area : organ_area / std::max(1.0, std::round(organ_area / e.element_area));
    for (std::uint32_t k = start[organ]; k < start[organ + 1]; ++k, ++row)
      for (std::uint32_t c = s.first_cell[row]; c < s.first_cell[row + 1]; ++c) {
        const auto material = facets.optics[e.order[row]];
        if (!current.open || e.material[current.index] != material) {
          current = {true, static_cast<std::uint32_t>(e.size())};
          e.area.push_back(0.0f);
          e.material.push_back(material);
        }
        e.element_of_cell[c] = current.index;
        e.area[current.index] += s.split[row] > 0 ? s.cell_area[row] : 0.0f;
        if (flat || (!is_small && e.area[current.index] >= 0.999 * part_area)) current.open = false;
      }
    current.open = is_small && current.open && e.area[current.index] < part_area;
  }
  e.first_cell.assign(e.size() + 1, 0);
  for (const auto i : e.element_of_cell) ++e.first_cell[i + 1];
  for (std::size_t i = 0; i < e.size(); ++i) e.first_cell[i + 1] += e.first_cell[i];
  e.cells.resize(s.cells());
  auto cursor = e.first_cell;
  for (std::uint32_t c = 0; c < s.cells(); ++c) e.cells[cursor[e.element_of_cell[c]]++] = c;
  return e;
}

}  // namespace sunfleck
