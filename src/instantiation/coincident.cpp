#include "instantiation/coincident.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace sunfleck {

namespace {

constexpr double tolerance = 1e-6;  // of the scene's size: that of single precision, as for stacked facets

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> coincident_members(const Members& members) {
  const auto surface = [&](std::uint32_t m) -> const Surface& { return members.original_of(m).elements.surface; };
  const auto middle = [&](std::uint32_t m) { return members.maps[m].point(surface(m).origin + surface(m).focus.centre()); };
  std::vector<Vec3> place(members.size());
  std::vector<std::uint32_t> order;
  Box all;
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    if (surface(m).focus.empty()) continue;
    order.push_back(m);
    all.add(place[m] = middle(m));
  }
  double reach = 0;  // from the middle of a member to its farthest corner
  for (const auto m : order) reach = std::max(reach, 0.5 * members.maps[m].scale * glm::length(surface(m).focus.size()));
  const double near = tolerance * (glm::length(all.size()) + 2 * reach);
  const auto on_each_other = [&](std::uint32_t a, std::uint32_t b) {
    const auto &p = members.maps[a], &q = members.maps[b];
    const double half = 0.5 * glm::length(surface(a).focus.size());
    const Mat3 difference = p.scale * p.turn - q.scale * q.turn;
    double stretch = 0;  // Frobenius: at most this times a distance from the middle
    for (int i = 0; i < 3; ++i) stretch += glm::dot(difference[i], difference[i]);
    return glm::length(place[a] - place[b]) + half * std::sqrt(stretch) <= near;
  };
  const auto key = [&](std::uint32_t m) { return std::tuple(members.found.members[m].original, place[m].x, m); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const auto a = order[i], b = order[j];
      if (members.found.members[a].original != members.found.members[b].original || place[b].x - place[a].x > near) break;
      if (!on_each_other(a, b)) continue;
      out.emplace_back(std::min(a, b), std::max(a, b));
      break;
    }
  return out;
}

}  // namespace sunfleck
