#include "policy/subtrees.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/plant/leaf_type.hpp>
#include <sunfleck/policy/classes.hpp>

#include "policy/parameters.hpp"
#include "policy/similarity.hpp"

namespace sunfleck {

double Moments::gyration() const {
  if (!(area > 0)) return 0;
  const Vec3 c = centroid();
  return std::sqrt(std::max(0.0, second / area - glm::dot(c, c)));
}

Subtrees::Subtrees(const PlantEntry& entry) : entry_(&entry) {
  const Plant& plant = *entry.plant;
  const auto n = static_cast<std::uint32_t>(plant.structures.size());
  // Depth-first order by counting: a structure's range begins after its parent and the earlier siblings' ranges.
  std::vector<std::uint32_t> size(n, 1), next(n);
  for (std::uint32_t s = n; s-- > 1;) size[plant.structures[s].parent] += size[s];
  begin_.resize(n), end_.resize(n), order_.resize(n);
  for (std::uint32_t s = 0; s < n; ++s) {
    if (s > 0) {
      auto& at = next[plant.structures[s].parent];
      begin_[s] = at;
      at += size[s];
    }
    next[s] = begin_[s] + 1;
    end_[s] = begin_[s] + size[s];
    order_[begin_[s]] = s;
  }
  first_shape_.assign(n + 1, 0);
  for (const auto& shape : plant.shapes) ++first_shape_[shape.structure + 1];
  std::partial_sum(first_shape_.begin(), first_shape_.end(), first_shape_.begin());
  shape_order_.resize(plant.shapes.size());
  auto put = first_shape_;
  for (std::uint32_t k = 0; k < plant.shapes.size(); ++k) shape_order_[put[plant.shapes[k].structure]++] = k;

  const auto same = [](const Affine& a, const Affine& b) { return a.linear == b.linear && a.translation == b.translation; };
  frames_.resize(n);
  for (std::uint32_t s = n; s-- > 0;) {
    const Structure& own = plant.structures[s];
    const bool placed =
        first_shape_[s] < first_shape_[s + 1] || own.parent == no_parent || !same(own.frame, plant.structures[own.parent].frame);
    frames_[s] = placed || size[s] == 1 ? own.frame : frames_[order_[begin_[s] + 1]];
  }

  moments_.resize(n);
  for (std::uint32_t s = 0; s < n; ++s) {
    Moments& m = moments_[s];
    m.leaves = is_leaf_type(plant.types[plant.structures[s].type]) ? 1 : 0;
    for (auto k = first_shape_[s]; k < first_shape_[s + 1]; ++k) {
      const Shape& shape = plant.shapes[shape_order_[k]];
      const std::uint32_t material = entry.shape_optics[shape_order_[k]];
      m.facets += shape.triangle_count;
      m.optics = mix(m.optics, material, shape.triangle_count);
      if (shape.triangle_count > 0 && std::find(m.materials.begin(), m.materials.end(), material) == m.materials.end())
        m.materials.insert(std::lower_bound(m.materials.begin(), m.materials.end(), material), material);
      for (std::uint32_t t = 0; t < shape.triangle_count; ++t) {
        const Triangle c = shape_triangle(plant, shape, t);
        const Vec3 vector = area_vector(c);
        const double area = glm::length(vector);
        if (!(area > 0)) continue;
        for (const auto& p : c) m.bounds.add(p);
        const Vec3 centre = (c[0] + c[1] + c[2]) / 3.0;
        m.area += area;
        m.first += area * centre;
        m.second += area * glm::dot(centre, centre);
        m.normals += glm::outerProduct(vector, vector) / area;
        m.edges += glm::length(c[1] - c[0]) + glm::length(c[2] - c[1]) + glm::length(c[0] - c[2]);
      }
    }
  }
  for (std::uint32_t k = n; k-- > 1;) {  // children in reverse depth-first order
    const auto s = order_[k];
    const Moments& m = moments_[s];
    Moments& p = moments_[plant.structures[s].parent];
    p.area += m.area;
    p.first += m.first;
    p.second += m.second;
    p.normals += m.normals;
    p.edges += m.edges;
    p.facets += m.facets;
    p.optics = mix(p.optics, m.optics);
    p.leaves += m.leaves;
    p.bounds.add(m.bounds);
    std::vector<std::uint32_t> both;
    std::set_union(p.materials.begin(), p.materials.end(), m.materials.begin(), m.materials.end(), std::back_inserter(both));
    p.materials = std::move(both);
  }
}

template <class Call>
void Subtrees::each_shape(std::uint32_t structure, Call&& call) const {
  for (auto k = begin_[structure]; k < end_[structure]; ++k)
    for (auto i = first_shape_[order_[k]]; i < first_shape_[order_[k] + 1]; ++i) call(shape_order_[i]);
}

std::vector<Triangle> Subtrees::facets(std::uint32_t structure) const {
  std::vector<std::uint32_t> optics;
  return facets(structure, optics);
}

std::vector<Triangle> Subtrees::facets(std::uint32_t structure, std::vector<std::uint32_t>& optics) const {
  std::vector<Triangle> all;
  all.reserve(moments_[structure].facets);
  optics.clear();
  optics.reserve(moments_[structure].facets);
  each_shape(structure, [&](std::uint32_t k) {
    const Shape& shape = plant().shapes[k];
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) {
      all.push_back(shape_triangle(plant(), shape, t));
      optics.push_back(entry_->shape_optics[k]);
    }
  });
  return all;
}

StructureFacets structure_facets(const PlantEntry& entry, std::uint32_t structure) {
  const Subtrees subtrees(entry);
  StructureFacets out;
  out.corners = subtrees.facets(structure, out.optics);
  out.upright = alignment(Alignment::upright, subtrees.frame(structure));
  out.frame = {nearest_rotation(subtrees.frame(structure).linear), subtrees.frame(structure).translation};
  return out;
}

}  // namespace sunfleck
