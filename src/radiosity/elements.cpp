#include <sunfleck/radiosity/elements.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/visibility/ground_gap.hpp>

#include "gather_elements.hpp"
#include "plant_shades.hpp"
#include "transport.hpp"

namespace sunfleck {

namespace {

/// So many times the middle patch is the mean at most: five walls over a hundred leaves do not make leaves parts of a wall.
constexpr double most_middle_patches = 3.0;
/// What large surfaces then take: the work of so many patches in all, or of so many for each that there is.
constexpr double least_budget = 3'000.0, budget_per_patch = 4.0;
/// Mean area of the plants' patches (of the ground's where no plant has an area; 1 where nothing has one: no line meets anything, however
/// many there are), within the limits above [m^2]. Not the area-weighted one: with lines of even density, N ~ A lines meet a patch of
/// area A, its squared error goes like 1 / A, and the area-weighted mean squared error like (number of patches) / (total area).
double mean_patch_area(const FacetScene& facets, const Patches& patches, double fewest_organs) {
  const auto plants = facets.area.begin() + static_cast<std::ptrdiff_t>(facets.plant_facets);
  const bool any_plant = std::any_of(facets.area.begin(), plants, [](float area) { return area > 0.0f; });
  const std::size_t end = any_plant ? facets.plant_facets : facets.size();
  std::vector<double> area(patches.size(), 0.0);
  for (std::size_t f = 0; f < end; ++f) area[patches.of_facet[f]] += facets.area[f];
  const auto all = patch_areas(std::move(area));
  if (!(all.count > 0.0)) return 1.0;
  return std::min({all.sum / all.count, all.sum / fewest_organs,
                   std::max(most_middle_patches * all.middle, all.sum / std::max(least_budget, budget_per_patch * all.count))});
}

/// Leaves wider than their periodic cell lie many on each other: one value for a cell's width of them tells nothing of how light fades from
/// one to the next [m^2]. Plants out of all proportion to the cell are a mistake of units, and are not worth the lines.
double largest_periodic_element(double cell_area, double patch_area) {
  constexpr double out_of_proportion = 16.0;
  const double ratio = patch_area / cell_area;
  return ratio > 1.0 && ratio <= out_of_proportion ? cell_area / (128.0 * ratio) : std::numeric_limits<double>::infinity();
}

/// Organs in tree order, but within small clusters those of one material together, so that small ones can share an element.
std::vector<std::uint32_t> gather_materials(const ClusterOrder& tree, const std::vector<std::uint32_t>& material_of_patch) {
  auto patches = tree.patches;
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const auto& node = tree.nodes[stack.back()];
    stack.pop_back();
    if (node.patch_count <= patches_sharing_elements)
      std::stable_sort(patches.begin() + node.first_patch, patches.begin() + node.first_patch + node.patch_count,
                       [&](std::uint32_t a, std::uint32_t b) { return material_of_patch[a] < material_of_patch[b]; });
    else
      for (std::uint32_t c = 0; c < node.child_count; ++c) stack.push_back(node.first_child + c);
  }
  return patches;
}

/// Cells tell sunlit from shaded parts of an element apart, where it reflects the sun's light on.
constexpr double cells_per_element = 2.0;
constexpr long most_split = 32;

std::uint16_t split_for(double area, double aim) {
  return static_cast<std::uint16_t>(std::clamp(std::lround(std::sqrt(area / aim)), 1L, most_split));
}

/// Ground farther from the plants than a third of their size is lit too evenly to be worth cutting.
double lit_unevenly_within(const Box& plants) {
  const Vec3 size = plants.size();
  return std::max({size.x, size.y, size.z}) / 3.0;
}

/// Facets of the ground under plants that are too wide to be split finely enough are cut in pieces.
class GroundUnderPlants {
 public:
  /// `aim`: area of a cell [m^2].
  GroundUnderPlants(const FacetScene& facets, double aim, double plant_cells, bool split) : facets_(facets) {
    if (facets.plant_facets == 0 || facets.plant_facets == facets.size()) return;
    std::vector<Box> copies(facets.copies.size());
    Box plants;
    for (const auto& shape : facets.shapes) {
      const auto next = &shape + 1 < facets.shapes.data() + facets.shapes.size() ? (&shape + 1)->first_facet : facets.plant_facets;
      for (std::size_t f = shape.first_facet; f < next; ++f)
        if (facets.area[f] > 0.0f)
          for (const auto& p : facets.corners[f]) copies[shape.copy].add(p);
    }
    for (const auto& box : copies) plants.add(box);
    if (plants.empty()) return;
    if (const auto& cell = facets.periodic) {  // images of plants are everywhere
      plants.add(Vec3{cell->x_low, cell->y_low, plants.low.z});
      plants.add(Vec3{cell->x_high, cell->y_high, plants.high.z});
      copies = {plants};
    }
    plants_.emplace(std::move(copies));
    all_ = plants;
    margin_ = lit_unevenly_within(plants);
    aim_ = std::max(aim, plants_->area(margin_) / (20'000.0 + 4.0 * plant_cells));
    finest_ = (split ? 8.0 : 1.5) * std::sqrt(aim_);
  }
  bool cuts(std::size_t facet) const {
    if (!plants_ || facet < facets_.plant_facets) return false;
    return facets_.area[facet] > most_split * most_split * aim_ && near(facets_.corners[facet]);
  }
  std::vector<GroundPiece> pieces(std::size_t facet) const { return cut_ground_facet(facets_.corners[facet], *plants_, finest_); }
  bool near(const Triangle& t) const {
    if (!plants_) return false;
    for (const auto& p : t)
      if (p.x > all_.low.x - margin_ && p.x < all_.high.x + margin_ && p.y > all_.low.y - margin_ && p.y < all_.high.y + margin_)
        return true;
    return plants_->distance(t) < margin_;
  }
  double aim() const { return aim_; }

 private:
  const FacetScene& facets_;
  std::optional<Footprints> plants_;
  Box all_;
  double margin_ = 0, aim_ = 0, finest_ = 0;
};

/// An element that cells are being gathered into.
struct OpenElement {
  bool open = false;
  std::uint32_t index = 0;
};

}  // namespace

std::size_t Elements::bytes() const {
  return bytes_of(order) + surface.bytes() + bytes_of(element_of_cell) + bytes_of(row_of_cell) + bytes_of(patch_of_row) +
         bytes_of(first_cell) + bytes_of(cells) + bytes_of(emission) + bytes_of(area) + bytes_of(material) + bytes_of(pieces.of_row) +
         bytes_of(pieces.corners) + piece_index.bytes();
}

Elements::Place Elements::place_of(std::uint32_t first_row, double u, double v) const {
  const std::uint32_t row = piece_index.knows(order[first_row]) ? piece_index.find(order[first_row], u, v) : first_row;
  return {row, surface.first_cell[row] + cell_of(static_cast<float>(u), static_cast<float>(v), surface.split[row])};
}

void list_cells(Elements& e) {
  e.first_cell.assign(e.size() + 1, 0);
  for (const auto i : e.element_of_cell) ++e.first_cell[i + 1];
  for (std::size_t i = 0; i < e.size(); ++i) e.first_cell[i + 1] += e.first_cell[i];
  e.cells.resize(e.element_of_cell.size());
  auto cursor = e.first_cell;
  for (std::uint32_t c = 0; c < e.cells.size(); ++c) e.cells[cursor[e.element_of_cell[c]]++] = c;
}

Elements gather_elements(const Scene& scene, const FacetScene& facets, const Patches& patches, bool flat, const ElementSizes& sizes,
                         const std::vector<std::uint16_t>& wanted_split) {
  Elements e;
  const std::size_t n = facets.size();
  e.plant_facets = facets.plant_facets;
  e.patch_area = sizes.patch;
  e.element_area = sizes.element;
  e.tree = cluster_order(scene, facets, patches);
  // facets by patch, file order within
  std::vector<std::uint32_t> start(patches.size() + 1, 0), members(n), material_of_patch(patches.size(), 0);
  for (std::size_t f = 0; f < n; ++f) ++start[patches.of_facet[f] + 1];
  for (std::size_t o = 0; o + 1 < start.size(); ++o) start[o + 1] += start[o];
  {
    auto cursor = start;
    for (std::size_t f = 0; f < n; ++f) members[cursor[patches.of_facet[f]]++] = static_cast<std::uint32_t>(f);
  }
  for (std::size_t f = n; f-- > 0;) material_of_patch[patches.of_facet[f]] = facets.optics[f];
  const auto in_order = gather_materials(e.tree, material_of_patch);

  const bool ground_is_flat = scene.ground && !scene.periodic && ground_is_level(facets);
  double plant_area = 0;
  for (std::size_t f = 0; f < facets.plant_facets; ++f) plant_area += facets.area[f];
  const double aim = e.element_area / cells_per_element;
  const GroundUnderPlants ground(facets, flat ? e.element_area : aim, plant_area / aim, !flat);
  std::vector<std::uint16_t> split;
  split.reserve(n);
  e.order.reserve(n);
  const auto add_row = [&](std::uint32_t facet, std::uint16_t cells, std::uint32_t piece) {
    if (piece != RowPieces::whole) e.pieces.of_row.resize(e.order.size(), RowPieces::whole);
    if (!e.pieces.of_row.empty()) e.pieces.of_row.push_back(piece);
    split.push_back(cells);
    e.order.push_back(facet);
  };
  for (const auto patch : in_order)
    for (std::uint32_t k = start[patch]; k < start[patch + 1]; ++k) {
      const auto f = members[k];
      const bool wider_than_cell = facets.periodic && f < facets.plant_facets && facets.area[f] > 0.5 * facets.periodic->area();
      if (ground.cuts(f)) {
        for (const auto& piece : ground.pieces(f)) {
          const double area = glm::length(area_vector(piece.corners));
          e.piece_index.add(f, piece, static_cast<std::uint32_t>(e.order.size()));
          e.pieces.corners.push_back(piece.corners);
          add_row(f, !flat && ground.near(piece.corners) ? split_for(area, ground.aim()) : std::uint16_t{1},
                  static_cast<std::uint32_t>(e.pieces.corners.size() - 1));
        }
        continue;
      }
      const bool cut = facets.area[f] > 0 && (wider_than_cell || (!flat && (f < facets.plant_facets || !ground_is_flat ||
                                                                            facets.plant_facets == 0 || ground.near(facets.corners[f]))));
      const bool wanted = !wanted_split.empty() && wanted_split[f] > 0;
      add_row(f, wanted ? wanted_split[f] : cut ? split_for(facets.area[f], aim) : std::uint16_t{1}, RowPieces::whole);
    }
  e.surface = make_surface(facets, e.order, split, e.pieces, ground_is_flat);
  const auto& s = e.surface;
  e.patch_of_row.resize(s.size());
  for (std::size_t t = 0; t < s.size(); ++t) e.patch_of_row[t] = patches.of_facet[e.order[t]];
  e.row_of_cell.resize(s.cells());
  for (std::uint32_t t = 0; t < s.size(); ++t)
    for (std::uint32_t c = s.first_cell[t]; c < s.first_cell[t + 1]; ++c) e.row_of_cell[c] = t;

  e.element_of_cell.resize(s.cells());
  const double small = 0.5 * e.element_area;  // smaller patches share an element with neighbours of their material
  OpenElement current;
  Box box;
  std::uint32_t row = 0;
  for (const auto patch : in_order) {
    double patch_area = 0;
    Box patch_box;
    for (std::uint32_t k = start[patch]; k < start[patch + 1]; ++k) {
      patch_area += facets.area[members[k]];
      for (const auto& p : facets.corners[members[k]]) patch_box.add(p);
    }
    const bool is_small = !flat && patch_area < small && start[patch] < start[patch + 1] && members[start[patch]] < facets.plant_facets;
    Box both = box;
    both.add(patch_box);
    const bool joins = is_small && glm::length(both.size()) < 6.0 * std::sqrt(e.element_area);
    if (!joins) {
      current.open = false;
      box = patch_box;
    } else {
      box = both;
    }
    const double part_area = is_small ? e.element_area : patch_area / std::max(1.0, std::round(patch_area / e.element_area));
    for (; row < s.size() && e.patch_of_row[row] == patch; ++row)
      for (std::uint32_t c = s.first_cell[row]; c < s.first_cell[row + 1]; ++c) {
        const auto material = facets.optics[e.order[row]];
        const bool fills_one = !e.pieces.of_row.empty() && e.order[row] >= e.plant_facets && s.cell_area[row] >= 0.999f * part_area;
        if (!current.open || fills_one || e.material[current.index] != material) {
          current = {true, static_cast<std::uint32_t>(e.size())};
          e.area.push_back(0.0f);
          e.material.push_back(material);
        }
        e.element_of_cell[c] = current.index;
        e.area[current.index] += s.split[row] > 0 ? s.cell_area[row] : 0.0f;
        const bool by_facet = flat && !wanted_split.empty() && wanted_split[e.order[row]] > 0;  // shades part it later
        if (by_facet ? c + 1 == s.first_cell[row + 1] : flat || (!is_small && e.area[current.index] >= 0.999 * part_area))
          current.open = false;
      }
    current.open = is_small && current.open && e.area[current.index] < part_area;
  }
  list_cells(e);
  return e;
}

Elements make_elements(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings) {
  const Patches patches = find_patches(facets);
  const double patch = mean_patch_area(facets, patches, settings.method == RadiosityMethod::flat ? 1.0 : settings.density.fewest_organs);
  ElementSizes sizes{patch, patch / settings.density.elements_per_organ};
  if (scene.periodic) sizes.element = std::min(sizes.element, largest_periodic_element(scene.periodic->area(), patch));
  PlantShades shades;
  if (settings.method != RadiosityMethod::direct && anything_scatters(facets))
    shades = plant_shades(scene, facets, patches, settings, sizes);
  Elements e = gather_elements(scene, facets, patches, settings.method == RadiosityMethod::flat, sizes, splits(shades, facets.size()));
  part_elements(facets, shades, settings.density.sends_by_cell, e);
  return e;
}

}  // namespace sunfleck
