#include <sunfleck/plant/species.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sunfleck/core/error.hpp>
#include <plant/growing.hpp>
#include <plant/organ_meshes.hpp>

namespace sunfleck {

namespace {

std::string text(double x) {
  std::string t = std::to_string(x);
  t.erase(t.find_last_not_of('0') + 1);
  if (t.back() == '.') t.pop_back();
  return t;
}

std::string where(const Species& species) {
  return species.file.empty() ? "species \"" + species.name + "\"" : species.file;
}

}  // namespace

Mat3 rotation(const Vec3& axis, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const auto turn = [&](const Vec3& v) { return c * v + s * glm::cross(axis, v) + (1 - c) * glm::dot(axis, v) * axis; };
  return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})};
}

Mat3 organ_frame(const Vec3& along, const Vec3& front) {
  Vec3 x = glm::cross(front, along);
  if (glm::length(x) < 1e-6) {  // front along the organ: any normal will do
    Vec3 u, v;
    orthonormal_frame(along, u, v);
    x = u;
  }
  x = glm::normalize(x);
  return {x, glm::cross(along, x), along};
}

Vec3 turned_towards(const Vec3& d, const Vec3& to, double angle_rad) {
  const Vec3 axis = glm::cross(d, to);
  const double sine = glm::length(axis), between = std::atan2(sine, glm::dot(d, to));
  if (sine < 1e-9) return d;
  return glm::normalize(rotation(axis / sine, std::min(angle_rad, between)) * d);
}

Mat3 carried(const Mat3& frame, const Vec3& d) {
  const Vec3 axis = glm::cross(frame[2], d);
  const double sine = glm::length(axis);
  const Mat3 turned = sine < 1e-12 ? frame : rotation(axis / sine, std::atan2(sine, glm::dot(frame[2], d))) * frame;
  const Vec3 x = glm::normalize(turned[0] - glm::dot(turned[0], d) * d);  // rounding must not pile up along an axis
  return {x, glm::cross(d, x), d};
}

PlantBuilder::PlantBuilder(const Species& species) {
  plant_.name = species.name;
  plant_.file = species.file;
  leaf_count_ = plant_.attribute_index("leaf_count");
  order_ = plant_.attribute_index("order");
  physiological_age_ = plant_.attribute_index("physiological_age");
  length_ = plant_.attribute_index("length");
}

std::uint32_t PlantBuilder::open(std::uint32_t parent, const std::string& type, const Affine& frame, std::int64_t order,
                                 std::int64_t physiological_age, double length_m) {
  Structure s;
  s.parent = parent;
  s.type = plant_.type_index(type);
  s.frame = frame;
  s.attributes = {
      {leaf_count_, std::int64_t{type == "leaf"}}, {order_, order}, {physiological_age_, physiological_age}, {length_, length_m}};
  plant_.structures.push_back(std::move(s));
  return static_cast<std::uint32_t>(plant_.structures.size() - 1);
}

void PlantBuilder::shape(std::uint32_t structure, std::uint32_t mesh, const std::string& material, const Affine& placement) {
  const auto count = static_cast<std::uint32_t>(plant_.meshes[mesh].triangles.size());
  plant_.shapes.push_back({structure, mesh, 0, count, plant_.material_index(material), placement});
}

std::uint32_t PlantBuilder::add_mesh(Mesh mesh) {
  plant_.meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(plant_.meshes.size() - 1);
}

void PlantBuilder::internode(std::uint32_t structure, const std::string& material, std::int64_t sides, const Vec3& from, const Vec3& to,
                             const Mat3& frame, double radius_from, double radius_to) {
  const int tenths = std::clamp(static_cast<int>(std::lround(10 * radius_to / radius_from)), 3, 10);
  const auto [entry, fresh] = frusta_.try_emplace({sides, tenths}, 0u);
  if (fresh) entry->second = add_mesh(frustum_mesh(sides, 0.1 * tenths));
  const Mat3 along = carried(frame, glm::normalize(to - from));
  shape(structure, entry->second, material, {Mat3{radius_from * along[0], radius_from * along[1], to - from}, from});
}

double PlantBuilder::lowest(std::uint32_t mesh, const Affine& placement) const {
  double z = std::numeric_limits<double>::infinity();
  for (const auto& v : plant_.meshes[mesh].vertices) z = std::min(z, placement.point(v).z);
  return z;
}

Plant PlantBuilder::finish() {
  auto count = [&](std::size_t i) -> std::int64_t& { return std::get<std::int64_t>(plant_.structures[i].attributes[0].second); };
  for (std::size_t i = plant_.structures.size(); i-- > 1;) count(plant_.structures[i].parent) += count(i);
  if (!plant_.shapes.empty()) plant_.structures[0].attributes[3].second = plant_.bounds().high.z;
  check_plant(plant_);
  plant_.structures.shrink_to_fit();  // kept as long as the scene, next to others
  plant_.shapes.shrink_to_fit();
  return std::move(plant_);
}

void too_many_nodes(const Species& species, double age) {
  throw InputError(where(species), "more than " + std::to_string(node_limit) + " nodes at age " + text(age) + " " + species.age_unit,
                   "fewer branches, or a lower age");
}

Plant grow(const Species& species, double age, std::uint64_t seed) {
  if (!(age >= species.age_low && age <= species.age_high))  // false for NaN
    throw InputError(where(species), "age " + text(age) + " " + species.age_unit,
                     text(species.age_low) + " to " + text(species.age_high) + " " + species.age_unit);
  if (const auto* tree = std::get_if<TreeGrowth>(&species.growth)) return grow_tree(species, *tree, age, seed);
  return grow_cereal(species, std::get<CerealGrowth>(species.growth), age, seed);
}

LeafTotals leaf_totals(const Plant& plant) {
  LeafTotals totals;
  std::vector<bool> in_leaf(plant.structures.size(), false);
  for (std::size_t i = 0; i < plant.structures.size(); ++i) {
    const auto& s = plant.structures[i];
    const bool leaf = plant.types[s.type] == "leaf";
    totals.leaves += leaf;
    in_leaf[i] = leaf || (s.parent != no_parent && in_leaf[s.parent]);
  }
  for (const auto& shape : plant.shapes)
    if (in_leaf[shape.structure] && plant.materials[shape.material] == "leaf")
      for (std::uint32_t t = 0; t < shape.triangle_count; ++t) totals.area_m2 += glm::length(area_vector(shape_triangle(plant, shape, t)));
  return totals;
}

}  // namespace sunfleck
