#include "policy/exact_classes.hpp"

#include <cmath>
#include <map>
#include <string>
#include <tuple>

namespace sunfleck {

namespace {

constexpr double corner_tolerance = 1e-5;  ///< of the size: coordinates in single precision, in a frame a hundred times as large
constexpr double invariant_tolerance = 1e-4;

/// What a similarity keeps.
struct Invariants {
  double gyration, edges, normals;
};

Invariants invariants_of(const Moments& m) {
  const Mat3 n = m.normals / m.area;
  double trace = 0;
  for (int c = 0; c < 3; ++c) trace += glm::dot(n[c], n[c]);
  return {m.gyration() / std::sqrt(m.area), m.edges / std::sqrt(m.area), trace};
}

bool near(double a, double b) {
  return std::abs(a - b) <= invariant_tolerance * std::max(std::abs(a), std::abs(b));
}

struct Bucket {
  std::multimap<double, std::size_t> groups;  ///< by Invariants::gyration
};

}  // namespace

std::vector<std::vector<ExactMember>> exact_groups(const std::vector<Subtrees>& plants) {
  std::vector<std::vector<ExactMember>> groups;
  std::vector<Invariants> first;
  std::map<std::tuple<std::string, std::uint64_t, std::uint64_t>, Bucket> buckets;
  for (std::uint32_t p = 0; p < plants.size(); ++p) {
    const Plant& plant = plants[p].plant();
    for (std::uint32_t s = 0; s < plant.structures.size(); ++s) {
      const Moments& m = plants[p].moments(s);
      if (!(m.area > 0)) continue;
      const Invariants own = invariants_of(m);
      Bucket& bucket = buckets[{plant.types[plant.structures[s].type], m.facets, m.optics}];
      std::vector<Triangle> facets;
      bool placed = false;
      const auto end = bucket.groups.upper_bound(own.gyration * (1 + invariant_tolerance));
      for (auto at = bucket.groups.lower_bound(own.gyration * (1 - invariant_tolerance)); at != end && !placed; ++at) {
        const Invariants& other = first[at->second];
        if (!near(own.edges, other.edges) || !near(own.normals, other.normals)) continue;
        auto& group = groups[at->second];
        if (facets.empty()) facets = plants[p].facets(s);
        const SubtreeRef& model = group.front().subtree;
        if (const auto found = find_similarity(plants[model.plant].facets(model.structure), facets, corner_tolerance)) {
          group.push_back({{p, s}, *found});
          placed = true;
        }
      }
      if (placed) continue;
      bucket.groups.emplace(own.gyration, groups.size());
      groups.push_back({{{p, s}, {}}});
      first.push_back(own);
    }
  }
  return groups;
}

}  // namespace sunfleck
