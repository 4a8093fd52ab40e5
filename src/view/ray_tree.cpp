#include "view/ray_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <sunfleck/core/error.hpp>

namespace sunfleck::raytree {

namespace {

// Geometries of a node: its triangles first, then its children.
constexpr unsigned triangles_id = 0, children_id = 1;

Vec3 linear(const std::array<float, 12>& m, const Vec3& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z, m[8] * v.x + m[9] * v.y + m[10] * v.z};
}

/// The same ray in the frame of a child; it keeps its parameter, so distances need no change.
TreeQuery into(const TreeQuery& outer, const Child& child) {
  TreeQuery inner = outer;
  inner.node = child.node;
  const auto& m = child.to_local;
  inner.origin = linear(m, outer.origin) + Vec3{m[3], m[7], m[11]};
  inner.direction = linear(m, outer.direction);
  inner.base = outer.base + child.first;
  return inner;
}

/// What the ray met, after a query on its node.
std::size_t facet_met(const TreeQuery& query, const RTCHit& hit) {
  return hit.geomID == triangles_id ? static_cast<std::size_t>(query.base + query.node->facet(hit.primID)) : query.facet;
}

void bounds(const RTCBoundsFunctionArguments* a) {
  *a->bounds_o = static_cast<const TreeNode*>(a->geometryUserPtr)->child_bounds[a->primID];
}

void intersect(const RTCIntersectFunctionNArguments* a) {
  if (a->valid[0] == 0) return;
  auto& outer = *static_cast<TreeQuery*>(a->context);
  auto& ray = *reinterpret_cast<RTCRayHit*>(a->rayhit);  // one ray at a time: the layouts are the same
  TreeQuery inner = into(outer, static_cast<const TreeNode*>(a->geometryUserPtr)->children[a->primID]);
  RTCRayHit found;
  if (!embree_meets(inner.node->scene.get(), inner, embree_ray(inner.origin, inner.direction, ray.ray.tnear, ray.ray.tfar), found)) return;
  outer.facet = facet_met(inner, found.hit);
  ray.ray.tfar = found.ray.tfar;
  ray.hit = found.hit;
  ray.hit.geomID = a->geomID, ray.hit.primID = a->primID;
}

void occluded(const RTCOccludedFunctionNArguments* a) {
  if (a->valid[0] == 0) return;
  auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
  TreeQuery inner = into(*static_cast<TreeQuery*>(a->context), static_cast<const TreeNode*>(a->geometryUserPtr)->children[a->primID]);
  if (embree_occluded(inner.node->scene.get(), inner, embree_ray(inner.origin, inner.direction, ray.tnear, ray.tfar)))
    ray.tfar = -std::numeric_limits<float>::infinity();  // Embree's sign for it
}

/// Leaves out the facet on which the ray starts.
void leave_start(const RTCFilterFunctionNArguments* a) {
  const auto& q = *static_cast<const TreeQuery*>(a->context);
  if (q.base + q.node->facet(RTCHitN_primID(a->hit, a->N, 0)) == q.start) a->valid[0] = 0;
}

}  // namespace

Tree::Tree(const DrawnScene& scene, std::size_t written_out) {
  const auto& g = scene.geometry();
  std::map<const Plant*, const TreeNode*> models;
  std::size_t facets = 0;
  for (const auto& entry : g.plants)
    if (models.try_emplace(entry.plant.get(), nullptr).second) facets += entry.shape_facet.back();
  for (const auto& entry : g.plants)
    if (auto& node = models[entry.plant.get()]; !node) node = plant_node(*entry.plant, facets <= written_out);
  TreeNode* ground = g.ground.triangles.empty() ? nullptr : mesh_node(g.ground, 0, g.ground.triangles.size());
  ground_ = ground, ground_first_ = g.plant_facets;

  TreeNode* world = new_node();
  Box all;
  for (const auto& copy : g.copies) all.add(copy.map.point(models[g.plants[copy.plant].plant.get()]->middle));
  if (ground) all.add(ground->middle);
  if (!all.empty()) world->middle = all.centre();
  for (const auto& copy : g.copies) place(*world, *models[g.plants[copy.plant].plant.get()], copy.map, copy.first_facet);
  if (ground) place(*world, *ground, {}, g.plant_facets);
  finish(*world);
  world_ = world;
}

TreeNode* Tree::new_node() {
  return nodes_.emplace_back(std::make_unique<TreeNode>()).get();
}

TreeNode* Tree::mesh_node(const Mesh& mesh, std::size_t first, std::size_t count) {
  std::vector<Triangle> triangles;
  triangles.reserve(count);
  for (std::size_t t = first; t < first + count; ++t) triangles.push_back(mesh.corners(t));
  TreeNode* node = new_node();
  set_triangles(*node, triangles);
  finish(*node);
  return node;
}

TreeNode* Tree::plant_node(const Plant& plant, bool write_out) {
  std::map<Piece, std::pair<std::size_t, TreeNode*>> pieces;  // how often each is placed
  if (!write_out)
    for (const auto& s : plant.shapes) ++pieces[{s.mesh, s.first_triangle, s.triangle_count}].first;
  TreeNode* node = new_node();
  std::vector<Triangle> own;
  std::uint32_t facet = 0;
  std::vector<std::pair<const Shape*, std::uint32_t>> placed;
  for (const auto& s : plant.shapes) {
    const auto at = pieces.find({s.mesh, s.first_triangle, s.triangle_count});
    if (at != pieces.end() && at->second.first >= 4 && s.triangle_count > 1) {
      placed.emplace_back(&s, facet);
      if (!at->second.second) at->second.second = mesh_node(plant.meshes[s.mesh], s.first_triangle, s.triangle_count);
    } else {
      for (std::uint32_t t = 0; t < s.triangle_count; ++t) {
        Triangle c = plant.meshes[s.mesh].corners(s.first_triangle + t);
        for (auto& p : c) p = s.placement.point(p);
        own.push_back(c);
        node->facet_of.push_back(facet + t);
      }
    }
    facet += s.triangle_count;
  }
  if (placed.empty()) node->facet_of = {};
  set_triangles(*node, own);
  if (own.empty()) {  // else its middle is that of its own triangles
    Box box;
    for (const auto& [shape, first] : placed) box.add(shape->placement.translation);
    if (!box.empty()) node->middle = box.centre();
  }
  for (const auto& [shape, first] : placed)
    place(*node, *pieces[{shape->mesh, shape->first_triangle, shape->triangle_count}].second, shape->placement, first);
  finish(*node);
  return node;
}

void Tree::set_triangles(TreeNode& node, const std::vector<Triangle>& triangles) {
  node.scene = device_.new_scene(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  if (triangles.empty()) return;
  Box box;
  for (const auto& t : triangles)
    for (const auto& p : t) box.add(p);
  node.middle = box.centre();
  node.box = {box.low - node.middle, box.high - node.middle};
  EmbreeTriangles attached(device_, triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    attached.set(i, {t[0] - node.middle, t[1] - node.middle, t[2] - node.middle});
  }
  attached.attach(node.scene.get(), triangles_id);
}

void Tree::place(TreeNode& parent, const TreeNode& child, const Affine& map, std::uint64_t first) {
  if (child.box.empty()) return;
  const double determinant = glm::determinant(map.linear);
  const Mat3 back = glm::inverse(map.linear);
  const Vec3 shift = back * (parent.middle - map.translation) - child.middle;
  Child out{{}, &child, first};
  bool finite = determinant != 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      out.to_local[static_cast<std::size_t>(4 * row + column)] = static_cast<float>(back[column][row]);
    out.to_local[static_cast<std::size_t>(4 * row + 3)] = static_cast<float>(shift[row]);
  }
  for (const float v : out.to_local) finite = finite && std::isfinite(v);
  if (!finite) return;  // flattened to nothing that has a volume: Embree cannot map rays into it
  Box box;
  for (int corner = 0; corner < 8; ++corner) {
    const auto pick = [&](int axis, double low, double high) { return (corner >> axis) & 1 ? high : low; };
    const Vec3 p{pick(0, child.box.low.x, child.box.high.x), pick(1, child.box.low.y, child.box.high.y),
                 pick(2, child.box.low.z, child.box.high.z)};
    box.add(map.point(p + child.middle) - parent.middle);
  }
  const double reach = std::max({std::fabs(box.low.x), std::fabs(box.low.y), std::fabs(box.low.z), std::fabs(box.high.x),
                                 std::fabs(box.high.y), std::fabs(box.high.z)});
  const Vec3 slack{2e-6 * reach};  // of single precision, in both frames
  box = {box.low - slack, box.high + slack};
  RTCBounds b{};
  b.lower_x = static_cast<float>(box.low.x), b.lower_y = static_cast<float>(box.low.y), b.lower_z = static_cast<float>(box.low.z);
  b.upper_x = static_cast<float>(box.high.x), b.upper_y = static_cast<float>(box.high.y), b.upper_z = static_cast<float>(box.high.z);
  parent.children.push_back(out);
  parent.child_bounds.push_back(b);
  parent.box.add(box);
}

void Tree::finish(TreeNode& node) {
  if (!node.scene) set_triangles(node, {});
  if (!node.children.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(node.children.size()));
    rtcSetGeometryUserData(geometry, &node);
    rtcSetGeometryBoundsFunction(
        geometry, [](const RTCBoundsFunctionArguments* a) { bounds(a); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occluded);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(node.scene.get(), geometry, children_id);
    rtcReleaseGeometry(geometry);
  }
  device_.commit(node.scene.get());
  device_.check(std::to_string(node.children.size()) + " copies and the facets of a plant");
  node.child_bounds = {};
  node.children.shrink_to_fit();
}

PlacedHit Tree::trace(const TreeNode* node, const Vec3& origin, const Vec3& direction, double from, double to, std::size_t start,
                      bool any) const {
  TreeQuery query{};
  rtcInitIntersectContext(&query);
  query.node = node;
  query.base = node == ground_ ? ground_first_ : 0;
  query.origin = origin - node->middle, query.direction = direction;
  query.start = start;
  if (start != no_placed_facet) query.filter = leave_start;
  PlacedHit hit;
  from = std::max(0.0, from);
  if (!(static_cast<float>(from) <= static_cast<float>(to))) return hit;
  const RTCRay ray = embree_ray(query.origin, query.direction, from, to);
  if (any) {
    if (embree_occluded(node->scene.get(), query, ray)) hit.facet = 0, hit.distance = 0;
    return hit;
  }
  RTCRayHit found;
  if (!embree_meets(node->scene.get(), query, ray, found)) return hit;
  hit.facet = facet_met(query, found.hit);
  hit.u = found.hit.u, hit.v = found.hit.v, hit.distance = found.ray.tfar;
  return hit;
}

std::size_t Tree::bytes() const {
  std::size_t sum = device_.bytes();
  for (const auto& n : nodes_) sum += n->children.capacity() * sizeof(Child) + n->facet_of.capacity() * sizeof(std::uint32_t);
  return sum;
}

}  // namespace sunfleck::raytree
