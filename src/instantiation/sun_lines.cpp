#include "instantiation/sun_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

namespace {

constexpr double one_class = 4.0;  // ratio of pitches that are made one

double lowest_point(const Surface& s, const Similarity& map) {
  const Vec3 middle = map.point(s.origin + s.focus.centre()), half = 0.5 * map.scale * s.focus.size();
  return middle.z - glm::dot(glm::abs(glm::transpose(map.turn)[2]), half);
}

}  // namespace

double own_sun_pitch(const OriginalLight& original, const Similarity& map, const InstantiationDensity& density) {
  const double organ = original.elements.patch_area * map.scale * map.scale;
  return std::sqrt(0.5 * organ / (density.sun_lines_per_organ / density.sun_samples));
}

std::vector<double> sun_pitches(const Members& members, const InstantiationDensity& density) {
  std::vector<double> own(members.size());
  for (std::size_t m = 0; m < own.size(); ++m) own[m] = own_sun_pitch(members.original_of(m), members.maps[m], density);
  std::vector<double> sorted = own, out(own.size());
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> smallest;  // of each class
  for (const double p : sorted)
    if (smallest.empty() || p >= one_class * smallest.back()) smallest.push_back(p);
  for (std::size_t m = 0; m < own.size(); ++m) out[m] = *(std::upper_bound(smallest.begin(), smallest.end(), own[m]) - 1);
  return out;
}

std::unique_ptr<const Surface> shading_ground(const Scene& scene, const Members& members) {
  if (!scene.ground) return nullptr;
  Scene alone;
  alone.file = scene.file;
  alone.bands = scene.bands;
  alone.band_units = scene.band_units;
  alone.states.resize(1);
  alone.periodic = scene.periodic;
  alone.ground = scene.ground;
  alone.ground->cells = {1, 1};
  double highest = -std::numeric_limits<double>::infinity(), lowest = std::numeric_limits<double>::infinity();
  if (scene.ground->mesh)
    for (const auto& p : scene.ground->mesh->vertices) highest = std::max(highest, p.z);
  else
    highest = scene.ground->height;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto& s = members.original_of(m).elements.surface;
    if (!s.focus.empty()) lowest = std::min(lowest, lowest_point(s, members.maps[m]));
  }
  if (!(lowest < highest - members.copies.ground_gap)) return nullptr;
  FacetScene facets = expand(alone);
  for (auto& t : facets.corners)
    for (auto& p : t) p.z -= members.copies.ground_gap;
  std::vector<std::uint32_t> order(facets.size());
  for (std::uint32_t f = 0; f < order.size(); ++f) order[f] = f;
  return std::make_unique<Surface>(make_surface(facets, order, std::vector<std::uint16_t>(order.size(), 1), RowPieces{}, false));
}

}  // namespace sunfleck
