#include "view/ray_tree.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <sunfleck/core/error.hpp>

namespace sunfleck::raytree {

namespace {

// Geometries of a node: its triangles first, then its children.
constexpr unsigned triangles_id = 0, children_id = 1;

RTCRay ray_of(const Query& q, float from, float to) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(q.origin.x), ray.org_y = static_cast<float>(q.origin.y), ray.org_z = static_cast<float>(q.origin.z);
  ray.dir_x = static_cast<float>(q.direction.x), ray.dir_y = static_cast<float>(q.direction.y),
  ray.dir_z = static_cast<float>(q.direction.z);
  ray.tnear = from, ray.tfar = to, ray.mask = ~0u;
  return ray;
}

Vec3 linear(const std::array<float, 12>& m, const Vec3& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z, m[8] * v.x + m[9] * v.y + m[10] * v.z};
}

/// The same ray in the frame of a child; it keeps its parameter, so distances need no change.
Query into(const Query& outer, const Child& child) {
  Query inner = outer;
  inner.node = child.node;
  const auto& m = child.to_local;
  inner.origin = linear(m, outer.origin) + Vec3{m[3], m[7], m[11]};
  inner.direction = linear(m, outer.direction);
  inner.base = outer.base + child.first;
  return inner;
}

/// What the ray met, after a query on its node.
std::size_t facet_met(const Query& query, const RTCHit& hit) {
  return hit.geomID == triangles_id ? static_cast<std::size_t>(query.base + query.node->facet(hit.primID)) : query.facet;
}

void bounds(const RTCBoundsFunctionArguments* a) {
  *a->bounds_o = static_cast<const Node*>(a->geometryUserPtr)->child_bounds[a->primID];
}

void intersect(const RTCIntersectFunctionNArguments* a) {
  if (a->valid[0] == 0) return;
  auto& outer = *static_cast<Query*>(a->context);
  auto& ray = *reinterpret_cast<RTCRayHit*>(a->rayhit);  // one ray at a time: the layouts are the same
  Query inner = into(outer, static_cast<const Node*>(a->geometryUserPtr)->children[a->primID]);
  RTCRayHit found{};
  found.ray = ray_of(inner, ray.ray.tnear, ray.ray.tfar);
  found.hit.geomID = found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(inner.node->scene.get(), &inner, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  outer.facet = facet_met(inner, found.hit);
  ray.ray.tfar = found.ray.tfar;
  ray.hit = found.hit;
  ray.hit.geomID = a->geomID, ray.hit.primID = a->primID;
}

void occluded(const RTCOccludedFunctionNArguments* a) {
  if (a->valid[0] == 0) return;
  auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
  Query inner = into(*static_cast<Query*>(a->context), static_cast<const Node*>(a->geometryUserPtr)->children[a->primID]);
  RTCRay found = ray_of(inner, ray.tnear, ray.tfar);
  rtcOccluded1(inner.node->scene.get(), &inner, &found);
  if (found.tfar < 0) ray.tfar = found.tfar;
}

/// Leaves out the facet on which the ray starts.
void leave_start(const RTCFilterFunctionNArguments* a) {
  const auto& q = *static_cast<const Query*>(a->context);
  if (q.base + q.node->facet(RTCHitN_primID(a->hit, a->N, 0)) == q.start) a->valid[0] = 0;
}

}  // namespace

bool Tree::monitor(void* self, ssize_t bytes, bool) {
  static_cast<Tree*>(self)->held_ += bytes;
  return true;
}

Tree::Tree(const DrawnScene& scene, std::size_t written_out) {
  // One thread builds: the trees, and with them which of two facets a ray through their common edge meets, are then always the same.
  device_.reset(rtcNewDevice("threads=1"));
  if (!device_) throw Error("Embree could not be started (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcSetDeviceMemoryMonitorFunction(device_.get(), monitor, this);
  const auto& g = scene.geometry();
  std::map<const Plant*, const Node*> models;
  std::size_t facets = 0;
  for (const auto& entry : g.plants)
    if (models.try_emplace(entry.plant.get(), nullptr).second) facets += entry.shape_facet.back();
  for (const auto& entry : g.plants)
    if (auto& node = models[entry.plant.get()]; !node) node = plant_node(*entry.plant, facets <= written_out);
  Node* ground = g.ground.triangles.empty() ? nullptr : mesh_node(g.ground, 0, g.ground.triangles.size());
  ground_ = ground, ground_first_ = g.plant_facets;

  Node* world = new_node();
  Box all;
  for (const auto& copy : g.copies) all.add(copy.map.point(models[g.plants[copy.plant].plant.get()]->middle));
  if (ground) all.add(ground->middle);
  if (!all.empty()) world->middle = all.centre();
  for (const auto& copy : g.copies) place(*world, *models[g.plants[copy.plant].plant.get()], copy.map, copy.first_facet);
  if (ground) place(*world, *ground, {}, g.plant_facets);
  finish(*world);
  world_ = world;
}

Node* Tree::new_node() {
  return nodes_.emplace_back(std::make_unique<Node>()).get();
}

Node* Tree::mesh_node(const Mesh& mesh, std::size_t first, std::size_t count) {
  std::vector<Triangle> triangles;
  triangles.reserve(count);
  for (std::size_t t = first; t < first + count; ++t) triangles.push_back(mesh.corners(t));
  Node* node = new_node();
  set_triangles(*node, triangles);
  finish(*node);
  return node;
}

Node* Tree::plant_node(const Plant& plant, bool write_out) {
  std::map<Piece, std::pair<std::size_t, Node*>> pieces;  // how often each is placed
  if (!write_out)
    for (const auto& s : plant.shapes) ++pieces[{s.mesh, s.first_triangle, s.triangle_count}].first;
  Node* node = new_node();
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

void Tree::set_triangles(Node& node, const std::vector<Triangle>& triangles) {
  node.scene.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(node.scene.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  if (triangles.empty()) return;
  Box box;
  for (const auto& t : triangles)
    for (const auto& p : t) box.add(p);
  node.middle = box.centre();
  node.box = {box.low - node.middle, box.high - node.middle};
  const std::size_t n = triangles.size();
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices =
      static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * n));
  auto* indices =
      static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), n));
  if (!vertices || !indices) {
    rtcReleaseGeometry(geometry);
    throw Error("not enough memory to draw " + std::to_string(n) + " facets");
  }
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = triangles[t][k] - node.middle;
      for (int c = 0; c < 3; ++c) vertices[9 * t + 3 * k + static_cast<std::size_t>(c)] = static_cast<float>(p[c]);
      indices[3 * t + k] = static_cast<unsigned>(3 * t + k);
    }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(node.scene.get(), geometry, triangles_id);
  rtcReleaseGeometry(geometry);
}

void Tree::place(Node& parent, const Node& child, const Affine& map, std::uint64_t first) {
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

void Tree::finish(Node& node) {
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
  rtcCommitScene(node.scene.get());
  if (const auto error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
    throw Error("Embree could not build its trees: not enough memory? (error " + std::to_string(error) + ")");
  node.child_bounds = {};
  node.children.shrink_to_fit();
}

PlacedHit Tree::trace(const Node* node, const Vec3& origin, const Vec3& direction, double from, double to, std::size_t start,
                      bool any) const {
  Query query{};
  rtcInitIntersectContext(&query);
  query.node = node;
  query.base = node == ground_ ? ground_first_ : 0;
  query.origin = origin - node->middle, query.direction = direction;
  query.start = start;
  if (start != no_placed_facet) query.filter = leave_start;
  PlacedHit hit;
  RTCRayHit found{};
  found.ray = ray_of(query, static_cast<float>(std::max(0.0, from)), static_cast<float>(to));
  if (!(found.ray.tnear <= found.ray.tfar)) return hit;
  if (any) {
    rtcOccluded1(node->scene.get(), &query, &found.ray);
    if (found.ray.tfar < 0) hit.facet = 0, hit.distance = 0;
    return hit;
  }
  found.hit.geomID = found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(node->scene.get(), &query, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.facet = facet_met(query, found.hit);
  hit.u = found.hit.u, hit.v = found.hit.v, hit.distance = found.ray.tfar;
  return hit;
}

std::size_t Tree::bytes() const {
  std::size_t sum = static_cast<std::size_t>(std::max<std::int64_t>(0, held_));
  for (const auto& n : nodes_) sum += n->children.capacity() * sizeof(Child) + n->facet_of.capacity() * sizeof(std::uint32_t);
  return sum;
}

}  // namespace sunfleck::raytree
