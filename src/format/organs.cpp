#include <format/organs.hpp>

#include <numeric>

namespace sunfleck {

std::vector<std::uint32_t> connected_components(const Mesh& mesh) {
  std::vector<std::uint32_t> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];  // path halving
    return i;
  };
  for (const auto& t : mesh.triangles)
    for (int k = 1; k < 3; ++k) {
      const std::uint32_t a = find(t[0]), b = find(t[k]);
      if (a < b) root[b] = a;
      if (b < a) root[a] = b;
    }
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
