#include "plant_shades.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace sunfleck {

namespace {

constexpr double pilot_share = 0.03;              ///< of a scene's lines: as many more look where light falls off
constexpr double shades_share = 0.4;              ///< and so many more, where it does, find where exactly
constexpr double fewest_pilot_lines = 5e4;        ///< cost nothing
constexpr double fewest_lines_of_element = 15.0;  ///< of a pilot: fewer tell nothing, and are not traced
constexpr double fewest_shades_lines = 1.5e6;
constexpr double most_lines_of_organ = 12800.0;  ///< beyond them, cells of a shade could not be told apart anyway
constexpr long most_shades_split = 32;

/// Fewest lines that meet a cell which faces the sun, and of the pilot: smaller ones would be met by none too often, but that matters less
/// where each sends out what it has.
struct CellLines {
  double sun, pilot;
};
constexpr CellLines cells_send{3.0, 1.0}, elements_send{12.0, 4.0};

/// A plant by itself, as one of its copies stands.
struct LonePlant {
  Scene scene;
  FacetScene facets;

  LonePlant(const Scene& of, const PlantEntry& plant, const Affine& map) {
    scene.file = of.file;
    scene.bands = of.bands;
    scene.band_units = of.band_units;
    scene.optics = of.optics;
    scene.plants.push_back(plant);
    scene.plants.back().placements = {{map}};
    facets = expand(scene);
  }
};

/// Lines that a solve traces to each mean organ, about.
double lines_of_organ(const RadiosityDensity& density) {
  return density.directions * density.lines_per_element * density.elements_per_organ + 0.5 * density.sun_lines_per_organ;
}

double plant_area(const FacetScene& facets) {
  return std::accumulate(facets.area.begin(), facets.area.begin() + static_cast<std::ptrdiff_t>(facets.plant_facets), 0.0);
}

/// Shades of one plant; `organs`: by area, in all plants that differ, and `copied`: in all copies.
class ShadeFinder {
 public:
  ShadeFinder(const Scene& scene, const RadiositySettings& settings, const ElementSizes& sizes, double organs, double copied)
      : scene_(scene), settings_(settings), sizes_(sizes), organs_(organs), lines_(lines_of_organ(settings.density) * copied) {}

  Shades find(const PlantEntry& plant, const Affine& map) const {
    const LonePlant alone(scene_, plant, map);
    return find(alone.scene, alone.facets, find_patches(alone.facets));
  }
  /// The scene is one copy of one plant, and nothing else.
  Shades find(const Scene& scene, const FacetScene& facets, const Patches& patches) const {
    constexpr std::uint32_t few_directions = 8, directions = 64;
    const bool flat = settings_.method == RadiosityMethod::flat;
    const auto pitch = [&](double lines, std::uint32_t of) { return std::sqrt(0.5 * sizes_.patch * of / lines); };
    const double few = of_organ(std::max(fewest_pilot_lines, pilot_share * lines_));
    if (few * sizes_.element < fewest_lines_of_element * sizes_.patch) return {};
    const auto coarse = splits_of(facets, 0.5 * sizes_.element);
    if (flat && std::all_of(coarse.begin(), coarse.end(), [](std::uint16_t k) { return k == 1; })) return {};  // elements of one cell
    Elements elements = gather_elements(scene, facets, patches, flat, sizes_, coarse);
    if (unevenness(facets, elements, few_directions, pitch(few, few_directions)) < settings_.density.least_unevenness) return {};
    const double lines = of_organ(std::max(fewest_shades_lines, shades_share * lines_));
    const CellLines& fewest = settings_.density.sends_by_cell ? cells_send : elements_send;
    const double cell = sizes_.patch * std::max(fewest.sun / settings_.density.sun_lines_per_organ, fewest.pilot / lines);
    elements = {};
    elements = gather_elements(scene, facets, patches, flat, sizes_, splits_of(facets, cell));
    return find_shades(facets, elements, directions, pitch(lines, directions));
  }

 private:
  static std::vector<std::uint16_t> splits_of(const FacetScene& facets, double cell) {
    std::vector<std::uint16_t> split(facets.size());
    for (std::size_t f = 0; f < split.size(); ++f)
      split[f] = static_cast<std::uint16_t>(std::clamp(std::lround(std::sqrt(facets.area[f] / cell)), 1L, most_shades_split));
    return split;
  }
  double of_organ(double lines) const { return std::min(lines / organs_, most_lines_of_organ); }

  const Scene& scene_;
  const RadiositySettings& settings_;
  const ElementSizes& sizes_;
  double organs_, lines_;
};

}  // namespace

PlantShades plant_shades(const Scene& scene, const FacetScene& facets, const Patches& patches, const RadiositySettings& settings,
                         const ElementSizes& sizes) {
  PlantShades out;
  out.of_copy.assign(facets.copies.size(), PlantShades::none);
  out.first_facet.assign(1, 0);
  if (std::isinf(settings.density.least_unevenness)) return out;
  using Alike = std::pair<const Plant*, std::vector<std::uint32_t>>;
  std::map<Alike, std::uint32_t> first_copy;
  double area_once = 0;
  const auto alike = [&](std::size_t copy) {
    const auto& entry = scene.plants[facets.copy_plant[copy]];
    return Alike{entry.plant.get(), entry.shape_optics};
  };
  for (std::uint32_t c = 0; c < facets.copies.size(); ++c) {
    const auto first = out.first_facet.back();
    out.first_facet.push_back(first + static_cast<std::uint32_t>(scene.plants[facets.copy_plant[c]].plant->facet_count()));
    if (!first_copy.try_emplace(alike(c), c).second) continue;
    for (auto f = first; f < out.first_facet.back(); ++f) area_once += facets.area[f];
  }
  if (!(area_once > 0.0)) return out;
  const ShadeFinder finder(scene, settings, sizes, area_once / sizes.patch, plant_area(facets) / sizes.patch);
  for (std::uint32_t c = 0; c < facets.copies.size(); ++c) {
    const auto first = first_copy.at(alike(c));
    if (first < c) {
      out.of_copy[c] = out.of_copy[first];
      continue;
    }
    const auto area = std::accumulate(facets.area.begin() + out.first_facet[c], facets.area.begin() + out.first_facet[c + 1], 0.0);
    if (!(area > 0.0)) continue;
    const bool alone = facets.copies.size() == 1 && facets.plant_facets == facets.size() && !facets.periodic;
    Shades shades = alone ? finder.find(scene, facets, patches) : finder.find(scene.plants[facets.copy_plant[c]], facets.copies[c]);
    if (shades.empty()) continue;
    out.of_copy[c] = static_cast<std::uint32_t>(out.found.size());
    out.found.push_back(std::move(shades));
  }
  return out;
}

std::vector<std::uint16_t> splits(const PlantShades& shades, std::size_t facets) {
  if (shades.found.empty()) return {};
  std::vector<std::uint16_t> out(facets, 0);
  for (std::size_t c = 0; c < shades.of_copy.size(); ++c)
    if (const auto k = shades.of_copy[c]; k != PlantShades::none)
      std::copy(shades.found[k].split.begin(), shades.found[k].split.end(), out.begin() + shades.first_facet[c]);
  return out;
}

namespace {

/// What each cell sends out beside the mean of its element.
void weigh_emission(const PlantShades& shades, const std::vector<std::uint32_t>& copy_of_facet, Elements& e) {
  constexpr double as_much = 32.0;
  const auto& s = e.surface;
  e.emission.assign(2 * s.cells(), static_cast<std::uint8_t>(as_much));
  for (std::size_t i = 0; i < e.size(); ++i) {
    const auto sent = [&](std::uint32_t c, std::size_t side) {
      const auto t = e.row_of_cell[c];
      const auto copy = copy_of_facet[e.order[t]];
      return static_cast<double>(
          shades.found[shades.of_copy[copy]].emission_at(e.order[t] - shades.first_facet[copy], c - s.first_cell[t], side));
    };
    const auto facet = e.order[e.row_of_cell[e.cells[e.first_cell[i]]]];
    if (facet >= copy_of_facet.size() || shades.of_copy[copy_of_facet[facet]] == PlantShades::none) continue;
    for (std::size_t side = 0; side < 2; ++side) {
      double sum = 0, area = 0;
      for (auto k = e.first_cell[i]; k < e.first_cell[i + 1]; ++k) {
        const auto t = e.row_of_cell[e.cells[k]];
        const double a = s.split[t] > 0 ? static_cast<double>(s.cell_area[t]) : 0.0;
        sum += a * sent(e.cells[k], side), area += a;
      }
      if (!(sum > 0.0)) continue;
      for (auto k = e.first_cell[i]; k < e.first_cell[i + 1]; ++k)
        e.emission[2 * e.cells[k] + side] =
            static_cast<std::uint8_t>(std::clamp(std::lround(as_much * sent(e.cells[k], side) * area / sum), 1L, 255L));
    }
  }
}

}  // namespace

void part_elements(const FacetScene& facets, const PlantShades& shades, bool weighed, Elements& e) {
  if (shades.found.empty()) return;
  const auto& s = e.surface;
  std::vector<std::uint16_t> shade(s.cells(), 0);
  std::vector<std::uint32_t> copy_of_facet(facets.plant_facets);
  for (std::uint32_t c = 0; c < shades.of_copy.size(); ++c)
    std::fill(copy_of_facet.begin() + shades.first_facet[c], copy_of_facet.begin() + shades.first_facet[c + 1], c);
  for (std::size_t t = 0; t < s.size(); ++t) {
    const auto facet = e.order[t];
    if (facet >= facets.plant_facets) continue;
    const auto copy = copy_of_facet[facet];
    if (shades.of_copy[copy] == PlantShades::none) continue;
    const auto& found = shades.found[shades.of_copy[copy]];
    for (auto c = s.first_cell[t]; c < s.first_cell[t + 1]; ++c) shade[c] = found.at(facet - shades.first_facet[copy], c - s.first_cell[t]);
  }
  // elements in their order, shades of each from the darkest to the brightest
  std::vector<float> area;
  std::vector<std::uint32_t> material, cells;
  for (std::size_t i = 0; i < e.size(); ++i) {
    cells.assign(e.cells.begin() + e.first_cell[i], e.cells.begin() + e.first_cell[i + 1]);
    std::stable_sort(cells.begin(), cells.end(), [&](std::uint32_t a, std::uint32_t b) { return shade[a] < shade[b]; });
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (k == 0 || shade[cells[k]] != shade[cells[k - 1]]) {
        area.push_back(0.0f);
        material.push_back(e.material[i]);
      }
      const auto t = e.row_of_cell[cells[k]];
      e.element_of_cell[cells[k]] = static_cast<std::uint32_t>(area.size() - 1);
      area.back() += s.split[t] > 0 ? s.cell_area[t] : 0.0f;
    }
  }
  e.area = std::move(area);
  e.material = std::move(material);
  list_cells(e);
  if (weighed) weigh_emission(shades, copy_of_facet, e);
}

}  // namespace sunfleck
