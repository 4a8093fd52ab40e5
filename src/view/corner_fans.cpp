#include "view/corner_fans.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>

#include <tbb/parallel_for.h>

namespace sunfleck {

namespace {

constexpr std::size_t most_triangles = std::size_t{1} << 20;
constexpr std::size_t most_in_fan = 64;  ///< a fan without end: leave its facets alone rather than spend its square

struct Corner {
  std::array<std::uint64_t, 3> at;
  std::uint32_t index;
  friend bool operator<(const Corner& a, const Corner& b) { return std::tie(a.at, a.index) < std::tie(b.at, b.index); }
};

/// A piece of a mesh of a plant.
struct Key {
  const Plant* plant;
  std::uint32_t mesh, first, count;
  friend auto operator<=>(const Key&, const Key&) = default;
};

std::unique_ptr<const CornerFans::Piece> fans_of(const Mesh& mesh, std::size_t first, std::size_t count) {
  if (count > most_triangles) return nullptr;
  auto out = std::make_unique<CornerFans::Piece>();
  std::vector<Corner> corners;
  std::vector<Vec3> normals;
  for (std::size_t t = 0; t < count; ++t) {
    const Triangle c = mesh.corners(first + t);
    const Vec3 n = area_vector(c);
    const double area = glm::length(n);
    out->area.push_back(static_cast<float>(area));
    normals.push_back(area > 0 ? n / area : Vec3{0.0});
    for (std::size_t k = 0; k < 3 && area > 0; ++k)
      corners.push_back({{std::bit_cast<std::uint64_t>(c[k].x), std::bit_cast<std::uint64_t>(c[k].y), std::bit_cast<std::uint64_t>(c[k].z)},
                         static_cast<std::uint32_t>(3 * t + k)});
  }
  std::sort(corners.begin(), corners.end());
  std::vector<std::vector<std::uint32_t>> fan(3 * count);
  for (std::size_t i = 0; i < corners.size();) {
    std::size_t end = i + 1;
    while (end < corners.size() && corners[end].at == corners[i].at) ++end;
    for (std::size_t a = i; a < end; ++a) {
      const std::uint32_t own = corners[a].index / 3;
      auto& list = fan[corners[a].index];
      if (end - i > most_in_fan) {
        list = {own};
        continue;
      }
      for (std::size_t b = i; b < end; ++b)
        if (const std::uint32_t t = corners[b].index / 3; glm::dot(normals[own], normals[t]) > 0.5) list.push_back(t);
    }
    i = end;
  }
  out->begin.push_back(0);
  for (const auto& list : fan) {
    out->triangle.insert(out->triangle.end(), list.begin(), list.end());
    out->begin.push_back(static_cast<std::uint32_t>(out->triangle.size()));
  }
  return out;
}

}  // namespace

CornerFans::CornerFans(const DrawnScene& scene) : scene_(scene) {
  std::map<Key, std::uint32_t> known;
  std::vector<Key> keys;
  for (const auto& entry : scene.geometry().plants) {
    auto& rows = row_.emplace_back();
    for (const auto& s : entry.plant->shapes) {
      const auto [at, fresh] =
          known.try_emplace({entry.plant.get(), s.mesh, s.first_triangle, s.triangle_count}, static_cast<std::uint32_t>(keys.size()));
      if (fresh) keys.push_back(at->first);
      rows.push_back(at->second);
    }
  }
  pieces_.resize(keys.size());
  tbb::parallel_for(std::size_t{0}, keys.size(),
                    [&](std::size_t i) { pieces_[i] = fans_of(keys[i].plant->meshes[keys[i].mesh], keys[i].first, keys[i].count); });
  const auto& ground = scene.geometry().ground;
  ground_ = fans_of(ground, 0, ground.triangles.size());
}

const CornerFans::Piece* CornerFans::piece(const DrawnScene::Place& place) const {
  if (scene_.is_ground(place)) return ground_.get();
  return pieces_[row_[scene_.geometry().copies[place.copy].plant][place.shape]].get();
}

}  // namespace sunfleck
