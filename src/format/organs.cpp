#include <format/organs.hpp>

#include <algorithm>
#include <array>
#include <numeric>

namespace sunfleck {

namespace {

/// For each vertex the first one at the same place.
std::vector<std::uint32_t> first_at_place(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size()), first(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const Vec3& p = mesh.vertices[i];
    return std::array{p.x, p.y, p.z};
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return std::pair{key(a), a} < std::pair{key(b), b}; });
  for (std::size_t k = 0; k < order.size(); ++k)
    first[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? first[order[k - 1]] : order[k];
  return first;
}

/// An edge by the places of its ends, and a corner of its triangle.
struct PlacedEdge {
  std::uint32_t low, high, corner;
  friend auto operator<=>(const PlacedEdge&, const PlacedEdge&) = default;
};

}  // namespace

std::vector<std::uint32_t> connected_components(const Mesh& mesh) {
  std::vector<std::uint32_t> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];  // path halving
    return i;
  };
  const auto join = [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t a = find(i), b = find(j);
    root[std::max(a, b)] = std::min(a, b);
  };
  for (const auto& t : mesh.triangles)
    for (int k = 1; k < 3; ++k) join(t[0], t[k]);
  const auto place = first_at_place(mesh);
  std::vector<PlacedEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (const auto a = place[t[k]], b = place[t[(k + 1) % 3]]; a != b) edges.push_back({std::min(a, b), std::max(a, b), t[k]});
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].low == edges[i - 1].low && edges[i].high == edges[i - 1].high) join(edges[i].corner, edges[i - 1].corner);
  constexpr std::uint32_t unseen = 0xffffffffu;
  std::vector<std::uint32_t> number(mesh.vertices.size(), unseen), component(mesh.triangles.size());
  std::uint32_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    auto& n = number[find(mesh.triangles[t][0])];
    if (n == unseen) n = count++;
    component[t] = n;
  }
  return component;
}

}  // namespace sunfleck
