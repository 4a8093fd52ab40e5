#include <sunfleck/scene/patches.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>

#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

constexpr std::uint32_t none = 0xffffffffu;
constexpr double same_place = 1e-6;     ///< of a plant's size
constexpr double sharpest_fold = 0.55;  ///< cosine between two facets' ways from their edge: -1 is flat, 1 is folded back
constexpr double counts_in_full = 0.2;  ///< of the middle one by width
constexpr int most_at_an_edge = 16;     ///< where more meet, which go on in which is not asked

/// Open addressing; grows never: the number of keys is known beforehand.
class Table {
 public:
  explicit Table(std::size_t keys) : slots_(std::bit_ceil(2 * keys + 1), none), mask_(slots_.size() - 1) {}
  /// The slot that holds an entry for which `same` holds, or an empty one.
  template <class Same>
  std::uint32_t& find(std::uint64_t hash, const Same& same) {
    std::size_t i = hash & mask_;
    while (slots_[i] != none && !same(slots_[i])) i = (i + 1) & mask_;
    return slots_[i];
  }

 private:
  std::vector<std::uint32_t> slots_;
  std::size_t mask_;
};

/// Corners by number: equal ones have one.
std::vector<std::uint32_t> weld(std::span<const Triangle> facets) {
  Box box;
  for (const auto& t : facets)
    for (const auto& p : t) box.add(p);
  const double step = std::max(glm::length(box.size()) * same_place, 1e-300);
  struct Place {
    std::int64_t x, y, z;
    bool operator==(const Place&) const = default;
  };
  std::vector<Place> places;
  places.reserve(facets.size());
  Table table(3 * facets.size());
  std::vector<std::uint32_t> out;
  out.reserve(3 * facets.size());
  for (const auto& t : facets)
    for (const auto& p : t) {
      const Vec3 at = (p - box.low) / step;
      const Place place{std::llround(at.x), std::llround(at.y), std::llround(at.z)};
      const auto hash =
          mix(mix(static_cast<std::uint64_t>(place.x), static_cast<std::uint64_t>(place.y)), static_cast<std::uint64_t>(place.z));
      auto& slot = table.find(hash, [&](std::uint32_t i) { return places[i] == place; });
      if (slot == none) {
        slot = static_cast<std::uint32_t>(places.size());
        places.push_back(place);
      }
      out.push_back(slot);
    }
  return out;
}

/// The way from the edge between corners k and k + 1 to the third corner, across the edge.
Vec3 way_from_edge(const Triangle& t, std::size_t k) {
  const Vec3 a = t[k], along = t[(k + 1) % 3] - a, to = t[(k + 2) % 3] - a;
  const double length2 = glm::dot(along, along);
  const Vec3 across = length2 > 0 ? to - along * (glm::dot(to, along) / length2) : to;
  const double length = glm::length(across);
  return length > 0 ? across / length : across;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t f) {
  while (parent[f] != f) f = parent[f] = parent[parent[f]];
  return f;
}

/// Where half of what all weigh is reached; `areas` are sorted.
template <class Weight>
double weighted_middle(const std::vector<double>& areas, const Weight& weight) {
  double all = 0, reached = 0;
  for (const double a : areas) all += weight(a);
  for (const double a : areas)
    if ((reached += weight(a)) >= 0.5 * all) return a;
  return areas.back();
}

}  // namespace

PatchAreas patch_areas(std::vector<double> areas) {
  std::erase_if(areas, [](double a) { return !(a > 0.0); });
  PatchAreas out;
  if (areas.empty()) return out;
  std::sort(areas.begin(), areas.end());
  const double small = counts_in_full * weighted_middle(areas, [](double a) { return std::sqrt(a); });
  const auto weight = [small](double a) { return std::min(1.0, a / small); };
  out.middle = weighted_middle(areas, weight);
  for (const double a : areas) out.sum += a, out.count += weight(a);
  return out;
}

std::vector<std::uint32_t> patches_of_plant(std::span<const Triangle> corners, std::span<const std::uint32_t> optics) {
  const auto point = weld(corners);
  std::vector<std::uint32_t> parent(corners.size()), next(3 * corners.size(), none);  // of edges that are the same, the one before
  std::iota(parent.begin(), parent.end(), 0u);
  Table table(3 * corners.size());
  const auto ends = [&](std::uint32_t edge) {  // its two corners
    const std::uint32_t a = point[edge], b = point[edge / 3 * 3 + (edge + 1) % 3];
    return std::pair{std::min(a, b), std::max(a, b)};
  };
  for (std::uint32_t edge = 0; edge < next.size(); ++edge) {
    const std::uint32_t k = edge % 3, f = edge / 3;
    const auto key = ends(edge);
    if (key.first == key.second) continue;
    auto& slot = table.find(mix(key.first, key.second), [&](std::uint32_t e) { return ends(e) == key; });
    const Vec3 way = way_from_edge(corners[f], k);
    int met = 0;
    for (auto other = slot; other != none && met < most_at_an_edge; other = next[other], ++met) {
      const auto g = other / 3;
      if (optics[f] != optics[g] || !(glm::dot(way, way_from_edge(corners[g], other % 3)) < sharpest_fold)) continue;
      const auto x = root_of(parent, f), y = root_of(parent, g);
      parent[std::max(x, y)] = std::min(x, y);
    }
    next[edge] = slot;
    slot = edge;
  }
  std::vector<std::uint32_t> out(corners.size());
  std::uint32_t count = 0;
  for (std::uint32_t f = 0; f < out.size(); ++f) out[f] = parent[f] == f ? count++ : out[root_of(parent, f)];
  return out;
}

Patches find_patches(const FacetScene& facets) {
  Patches out;
  out.of_facet.resize(facets.size());
  out.end_of_copy.resize(facets.copies.size());
  std::vector<std::size_t> first(facets.copies.size() + 1, 0);
  for (const auto& shape : facets.shapes) {
    const auto next = &shape + 1 < facets.shapes.data() + facets.shapes.size() ? (&shape + 1)->first_facet : facets.plant_facets;
    first[shape.copy + 1] = next;
  }
  for (std::size_t c = 1; c < first.size(); ++c) first[c] = std::max(first[c], first[c - 1]);
  struct Found {
    std::size_t begin, end;  ///< facets of the copy that they were found from
    std::uint32_t patch;     ///< its first
  };
  std::map<std::uint32_t, Found> of_plant;
  const auto add = [&](std::size_t f, std::uint32_t patch) {
    out.of_facet[f] = patch;
    if (patch == out.size()) out.structure.push_back(facets.organs.structure[facets.organ[f]]);
  };
  for (std::size_t c = 0; c < facets.copies.size(); ++c) {
    const auto begin = static_cast<std::uint32_t>(out.size());
    const auto same = of_plant.find(facets.copy_plant[c]);
    if (same != of_plant.end() && same->second.end - same->second.begin == first[c + 1] - first[c]) {
      for (std::size_t f = first[c]; f < first[c + 1]; ++f)
        add(f, begin + out.of_facet[same->second.begin + (f - first[c])] - same->second.patch);
    } else {
      const auto patch = patches_of_plant(std::span(facets.corners).subspan(first[c], first[c + 1] - first[c]),
                                          std::span(facets.optics).subspan(first[c], first[c + 1] - first[c]));
      for (std::size_t i = 0; i < patch.size(); ++i) add(first[c] + i, begin + patch[i]);
      of_plant[facets.copy_plant[c]] = {first[c], first[c + 1], begin};
    }
    out.end_of_copy[c] = static_cast<std::uint32_t>(out.size());
  }
  const auto ground = static_cast<std::uint32_t>(out.size());
  const auto first_organ = facets.plant_facets < facets.size() ? facets.organ[facets.plant_facets] : 0u;
  for (std::size_t f = facets.plant_facets; f < facets.size(); ++f) add(f, ground + facets.organ[f] - first_organ);
  return out;
}

}  // namespace sunfleck
