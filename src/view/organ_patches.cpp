#include "view/organ_patches.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <tuple>
#include <unordered_map>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

using Mesh3 = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// OpenMesh reports facets that it refuses on std::cerr; we give them vertices of their own instead.
class QuietMesh {
 public:
  QuietMesh() : enabled_(omerr().is_enabled()) { omerr().disable(); }
  ~QuietMesh() {
    if (enabled_) omerr().enable();
  }

 private:
  bool enabled_;
};

Mesh3::Point point_of(const Vec3& p) {
  return {p.x, p.y, p.z};
}

struct Place {
  std::array<std::uint64_t, 3> bits;
  std::uint32_t organ;
  bool operator==(const Place&) const = default;
};
struct PlaceHash {
  std::size_t operator()(const Place& p) const { return mix(mix(p.bits[0], p.bits[1], p.bits[2]), p.organ); }
};

constexpr std::size_t ground_facets_a_patch = std::size_t{1} << 16;

}  // namespace

OrganPatch make_patch(const std::vector<Triangle>& corners, const std::vector<std::uint32_t>& organ) {
  const QuietMesh quiet;
  Mesh3 mesh;
  mesh.reserve(corners.size(), 2 * corners.size(), corners.size());
  std::unordered_map<Place, Mesh3::VertexHandle, PlaceHash> known;
  known.reserve(corners.size());
  std::vector<std::array<Mesh3::VertexHandle, 3>> handles;
  handles.reserve(corners.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    auto& v = handles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 p = corners[t][c] + 0.0;  // -0 becomes 0
      const Place place{{std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y), std::bit_cast<std::uint64_t>(p.z)},
                        organ[t]};
      const auto [at, added] = known.try_emplace(place);
      if (added) at->second = mesh.add_vertex(point_of(corners[t][c]));
      v[c] = at->second;
    }
    const bool degenerate = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
    if (!degenerate && mesh.add_face(v[0], v[1], v[2]).is_valid()) continue;
    for (std::size_t c = 0; c < 3; ++c) v[c] = mesh.add_vertex(point_of(corners[t][c]));
    mesh.add_face(v[0], v[1], v[2]);
  }

  // Vertices that only refused facets wanted are left out.
  OrganPatch patch;
  std::vector<std::uint32_t> row(mesh.n_vertices(), no_parent);
  patch.star_first.push_back(0);
  for (const auto v : mesh.vertices()) {
    if (mesh.is_isolated(v)) continue;
    row[static_cast<std::size_t>(v.idx())] = static_cast<std::uint32_t>(patch.vertices.size());
    const auto& p = mesh.point(v);
    patch.vertices.emplace_back(p[0], p[1], p[2]);
    const std::size_t begin = patch.star.size();
    for (const auto f : v.faces()) patch.star.push_back(static_cast<std::uint32_t>(f.idx()));
    std::sort(patch.star.begin() + static_cast<std::ptrdiff_t>(begin), patch.star.end());
    patch.star_first.push_back(static_cast<std::uint32_t>(patch.star.size()));
  }
  patch.triangles.reserve(corners.size());
  for (const auto& v : handles) {
    auto& t = patch.triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) t[c] = row[static_cast<std::size_t>(v[c].idx())];
  }
  return patch;
}

std::vector<float> OrganPatch::vertex_means(const float* values, std::size_t width, const float* area) const {
  std::vector<float> out(vertices.size() * width);
  std::vector<double> sum(width);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    double weight = 0;
    for (auto i = star_first[v]; i < star_first[v + 1]; ++i) weight += area[star[i]];
    const bool plain = !(weight > 0);
    if (plain) weight = star_first[v + 1] - star_first[v];
    std::fill(sum.begin(), sum.end(), 0.0);
    for (auto i = star_first[v]; i < star_first[v + 1]; ++i)
      for (std::size_t k = 0; k < width; ++k) sum[k] += (plain ? 1.0 : double{area[star[i]]}) * values[star[i] * width + k];
    for (std::size_t k = 0; k < width; ++k) out[v * width + k] = static_cast<float>(sum[k] / weight);
  }
  return out;
}

OrganPatches::Model OrganPatches::model_of(const Plant& plant) {
  // Shapes of an organ may lie apart in the file: a part runs to the last shape of every organ that begins in it.
  const std::size_t shapes = plant.shapes.size();
  std::vector<std::size_t> last(plant.structures.size(), 0);
  for (std::size_t s = 0; s < shapes; ++s) last[plant.shapes[s].structure] = s;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, const OrganPatch*> known;  // of whole organs made of one shape

  Model model;
  std::size_t facet = 0;
  for (std::size_t s = 0; s < shapes;) {
    std::size_t end = s + 1;
    for (std::size_t i = s; i < end; ++i) end = std::max(end, last[plant.shapes[i].structure] + 1);
    const Shape& shape = plant.shapes[s];
    const bool single = end == s + 1;
    std::vector<Triangle> corners;
    std::vector<std::uint32_t> organ;
    const OrganPatch* patch = nullptr;
    if (single) {
      auto& made = known[{shape.mesh, shape.first_triangle, shape.triangle_count}];
      if (!made) {
        for (std::uint32_t t = 0; t < shape.triangle_count; ++t)
          corners.push_back(plant.meshes[shape.mesh].corners(shape.first_triangle + t));
        organ.assign(corners.size(), 0);
        made = &patches_.emplace_back(make_patch(corners, organ));
      }
      patch = made;
    } else {
      for (std::size_t i = s; i < end; ++i)
        for (std::uint32_t t = 0; t < plant.shapes[i].triangle_count; ++t) {
          corners.push_back(shape_triangle(plant, plant.shapes[i], t));
          organ.push_back(plant.shapes[i].structure);
        }
      patch = &patches_.emplace_back(make_patch(corners, organ));
    }
    model.parts.push_back({patch, single ? shape.placement : Affine{}, facet, model.vertices});
    facet += patch->triangles.size();
    model.vertices += patch->vertices.size();
    s = end;
  }
  return model;
}

OrganPatches::Model OrganPatches::ground_of(const Mesh& ground, const std::vector<std::uint32_t>& organ) {
  Model model;
  const std::size_t n = ground.triangles.size();
  for (std::size_t first = 0; first < n;) {
    std::size_t end = std::min(n, first + ground_facets_a_patch);
    while (end < n && organ[end] == organ[end - 1]) ++end;
    std::vector<Triangle> corners;
    for (std::size_t t = first; t < end; ++t) corners.push_back(ground.corners(t));
    const auto& patch = patches_.emplace_back(
        make_patch(corners, {organ.begin() + static_cast<std::ptrdiff_t>(first), organ.begin() + static_cast<std::ptrdiff_t>(end)}));
    model.parts.push_back({&patch, Affine{}, first, model.vertices});
    model.vertices += patch.vertices.size();
    first = end;
  }
  return model;
}

OrganPatches::OrganPatches(const ResultGeometry& geometry, const std::vector<std::uint32_t>& ground_organ) : geometry_(geometry) {
  std::map<const Plant*, std::size_t> known;
  for (const auto& entry : geometry.plants) {
    const auto [place, added] = known.try_emplace(entry.plant.get(), models_.size());
    if (added) models_.push_back(model_of(*entry.plant));
    model_of_.push_back(place->second);
  }
  ground_ = ground_of(geometry.ground, ground_organ);
  for (std::size_t c = 0; c < geometry.copies.size(); ++c) {
    first_vertex_.push_back(vertex_count_);
    vertex_count_ += copy_vertices(c);
  }
  first_vertex_.push_back(vertex_count_);
  vertex_count_ += ground_.vertices;
}

std::size_t OrganPatches::copy_vertices(std::size_t copy) const {
  return plant_vertices(geometry_.copies[copy].plant);
}

void OrganPatches::place(std::size_t copy, std::size_t first_vertex, std::vector<PlacedPatch>& out) const {
  const bool ground = copy == geometry_.copies.size();
  const Affine map = ground ? Affine{} : geometry_.copies[copy].map;
  const std::size_t first_facet = ground ? geometry_.plant_facets : geometry_.copies[copy].first_facet;
  for (const auto& part : (ground ? ground_ : models_[model_of_[geometry_.copies[copy].plant]]).parts) {
    PlacedPatch placed{part.patch, map * part.placement, false, first_facet + part.first_facet, first_vertex + part.first_vertex, copy};
    placed.mirrors = placed.map.mirrors();
    out.push_back(placed);
  }
}

std::vector<PlacedPatch> OrganPatches::of_copy(std::size_t copy) const {
  std::vector<PlacedPatch> out;
  place(copy, first_vertex_[copy], out);
  return out;
}

void OrganPatches::for_each_batch(std::size_t facets, const std::function<void(std::span<const PlacedPatch>)>& batch) const {
  std::vector<PlacedPatch> waiting;
  for (std::size_t copy = 0; copy <= geometry_.copies.size(); ++copy) {
    place(copy, first_vertex_[copy], waiting);
    std::size_t begin = 0, count = 0;
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      count += waiting[i].facets();
      if (count < facets) continue;
      batch(std::span(waiting).subspan(begin, i + 1 - begin));
      begin = i + 1, count = 0;
    }
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(begin));
  }
  if (!waiting.empty()) batch(waiting);
}

}  // namespace sunfleck
