#include <sunfleck/view/drawn_scene.hpp>

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/facet_rows.hpp>

#include "view/outline.hpp"

namespace sunfleck {

namespace {

/// A FacetScene as one plant of one mesh, shapes where organ or optics change.
ResultGeometry as_geometry(const FacetScene& scene, std::vector<std::uint32_t>& shape_organ) {
  ResultGeometry out;
  out.plant_facets = std::min(scene.plant_facets, scene.size());
  out.periodic = scene.periodic;
  const auto add = [&](Mesh& mesh, std::size_t f) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), scene.corners[f].begin(), scene.corners[f].end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  if (out.plant_facets > 0) {
    auto plant = std::make_shared<Plant>();
    plant->types = scene.organs.types;
    plant->meshes.emplace_back();
    ResultGeometry::Entry entry{"", nullptr, {}, {0}};
    for (std::size_t f = 0; f < out.plant_facets; ++f) {
      add(plant->meshes[0], f);
      if (f == 0 || scene.organ[f] != scene.organ[f - 1] || scene.optics[f] != scene.optics[f - 1]) {
        Structure organ;
        organ.type = scene.organs.type[scene.organ[f]];
        plant->shapes.push_back({static_cast<std::uint32_t>(plant->structures.size()), 0, static_cast<std::uint32_t>(f), 0, 0, {}});
        plant->structures.push_back(organ);
        entry.shape_optics.push_back(scene.optics[f]);
        shape_organ.push_back(scene.organ[f]);
      }
      ++plant->shapes.back().triangle_count;
    }
    for (const auto& s : plant->shapes) entry.shape_facet.push_back(entry.shape_facet.back() + s.triangle_count);
    entry.plant = std::move(plant);
    out.plants.push_back(std::move(entry));
    out.copies.push_back({0, {}, 0});
  }
  for (std::size_t f = out.plant_facets; f < scene.size(); ++f) add(out.ground, f);
  if (out.plant_facets < scene.size()) out.ground_optics = scene.optics[out.plant_facets];
  return out;
}

}  // namespace

DrawnScene::DrawnScene(const Result& result, bool ground) : geometry_(result.geometry()), materials_(result.materials()) {
  number_organs(result.organ_count(), result.file());
  if (!ground) geometry_.ground = {};
  if (size() == 0) throw InputError(result.file(), ground ? "no facet" : "no plant, only ground", "something to draw");
  measure();
  if (all_bounds_.empty()) throw InputError(result.file(), "only facets without area", "something to draw");
}

DrawnScene::DrawnScene(const Scene& scene, const PlacedScene& placed) : materials_(FacetRows(scene, placed).materials()) {
  for (const auto& entry : scene.plants) {
    geometry_.plants.push_back({entry.name, entry.plant, entry.shape_optics, {0}});
    auto& starts = geometry_.plants.back().shape_facet;
    for (const auto& shape : entry.plant->shapes) starts.push_back(starts.back() + shape.triangle_count);
  }
  for (const auto& copy : placed.copies) geometry_.copies.push_back({copy.plant, copy.map, copy.first_facet});
  for (std::size_t f = 0; f < placed.ground.size(); ++f) {
    const Triangle t = placed.ground[f];
    const auto first = static_cast<std::uint32_t>(geometry_.ground.vertices.size());
    geometry_.ground.vertices.insert(geometry_.ground.vertices.end(), t.begin(), t.end());
    geometry_.ground.triangles.push_back({first, first + 1, first + 2});
  }
  geometry_.ground_optics = static_cast<std::uint32_t>(materials_.size() - 1);
  geometry_.plant_facets = placed.first_ground_facet;
  geometry_.periodic = scene.periodic;
  number_organs(placed.organs, scene.file);
  if (size() == 0) throw InputError(scene.file, "no facet", "something to draw");
  measure();
  if (all_bounds_.empty()) throw InputError(scene.file, "only facets without area", "something to draw");
}

DrawnScene::DrawnScene(const FacetScene& scene) : materials_(scene.materials) {
  std::vector<std::uint32_t> organs;
  geometry_ = as_geometry(scene, organs);
  if (!geometry_.copies.empty()) shape_organ_.push_back(std::move(organs)), copy_organ_.push_back(0);
  if (geometry_.plant_facets < scene.size()) {
    ground_organ_ = scene.organ[geometry_.plant_facets];
    ground_in_one_ = scene.organ.back() == ground_organ_;
  }
  measure();
}

void DrawnScene::number_organs(std::uint64_t in_all, const std::string& file) {
  // Organs are numbered as their first facet comes, per copy and structure, then the ground, two facets a cell or all of one mesh.
  std::vector<std::uint32_t> organs_of_plant;
  for (const auto& entry : geometry_.plants) {
    std::vector<std::uint32_t> organ_of(entry.plant->structures.size(), no_parent);
    std::uint32_t next = 0;
    auto& rows = shape_organ_.emplace_back();
    for (const auto& shape : entry.plant->shapes) {
      auto& organ = organ_of[shape.structure];
      if (organ == no_parent) organ = next++;
      rows.push_back(organ);
    }
    organs_of_plant.push_back(next);
  }
  std::uint64_t next = 0;
  for (const auto& copy : geometry_.copies) {
    copy_organ_.push_back(static_cast<std::uint32_t>(next));
    next += organs_of_plant[copy.plant];
  }
  const std::size_t cells = geometry_.ground.triangles.size();
  const std::uint64_t left = in_all - std::min<std::uint64_t>(next, in_all);
  ground_in_one_ = left == 1;
  if (next > in_all || (cells > 0 && left != 1 && left < (cells + 1) / 2))
    throw InputError(location(file, 0, "geometry"), "shapes that do not match the organs", "facets that belong to the rows of /organs");
  ground_organ_ = static_cast<std::uint32_t>(next);
}

DrawnScene::Place DrawnScene::place(std::size_t facet) const {
  const auto& g = geometry_;
  if (facet >= g.plant_facets) return {static_cast<std::uint32_t>(g.copies.size()), 0, facet - g.plant_facets};
  const auto copy =
      std::upper_bound(g.copies.begin(), g.copies.end(), facet, [](std::size_t f, const auto& c) { return f < c.first_facet; }) - 1;
  const auto& starts = g.plants[copy->plant].shape_facet;
  const std::size_t local = facet - copy->first_facet;
  const auto shape = std::upper_bound(starts.begin(), starts.end(), local) - starts.begin() - 1;
  return {static_cast<std::uint32_t>(copy - g.copies.begin()), static_cast<std::uint32_t>(shape),
          local - starts[static_cast<std::size_t>(shape)]};
}

std::size_t DrawnScene::run_begin(const Place& p) const {
  if (is_ground(p)) return geometry_.plant_facets;
  const auto& copy = geometry_.copies[p.copy];
  return copy.first_facet + geometry_.plants[copy.plant].shape_facet[p.shape];
}

std::size_t DrawnScene::run_length(const Place& p) const {
  if (is_ground(p)) return geometry_.ground.triangles.size();
  return geometry_.plants[geometry_.copies[p.copy].plant].plant->shapes[p.shape].triangle_count;
}

Triangle DrawnScene::corners(const Place& p) const {
  if (is_ground(p)) return geometry_.ground.corners(p.triangle);
  const auto& copy = geometry_.copies[p.copy];
  const Plant& plant = *geometry_.plants[copy.plant].plant;
  const Shape& shape = plant.shapes[p.shape];
  const Affine to_world = copy.map * shape.placement;
  Triangle c = plant.meshes[shape.mesh].corners(shape.first_triangle + p.triangle);
  for (auto& v : c) v = to_world.point(v);
  if (to_world.mirrors()) std::swap(c[1], c[2]);
  return c;
}

bool DrawnScene::swapped(const Place& p) const {
  if (is_ground(p)) return false;
  const auto& copy = geometry_.copies[p.copy];
  return (copy.map * geometry_.plants[copy.plant].plant->shapes[p.shape].placement).mirrors();
}

std::uint32_t DrawnScene::optics(const Place& p) const {
  return is_ground(p) ? geometry_.ground_optics : geometry_.plants[geometry_.copies[p.copy].plant].shape_optics[p.shape];
}

std::uint32_t DrawnScene::organ(const Place& p) const {
  if (is_ground(p)) return ground_organ_ + (ground_in_one_ ? 0 : static_cast<std::uint32_t>(p.triangle / 2));
  return copy_organ_[p.copy] + shape_organ_[geometry_.copies[p.copy].plant][p.shape];
}

const std::string& DrawnScene::organ_type(const Place& p) const {
  static const std::string ground = "ground";
  if (is_ground(p)) return ground;
  const Plant& plant = *geometry_.plants[geometry_.copies[p.copy].plant].plant;
  return plant.types[plant.structures[plant.shapes[p.shape].structure].type];
}

std::uint32_t DrawnScene::level(const Place& p) const {
  if (is_ground(p)) return 0;
  const Plant& plant = *geometry_.plants[geometry_.copies[p.copy].plant].plant;
  std::uint32_t level = 0;
  for (auto s = plant.structures[plant.shapes[p.shape].structure].parent; s != no_parent; s = plant.structures[s].parent) ++level;
  return level;
}

void DrawnScene::measure() {
  std::map<const Plant*, std::vector<Vec3>> hulls;
  for (const auto& entry : geometry_.plants)
    if (auto& hull = hulls[entry.plant.get()]; hull.empty()) hull = outline_points(*entry.plant);
  std::size_t points = 0;
  for (const auto& copy : geometry_.copies) points += hulls[geometry_.plants[copy.plant].plant.get()].size();
  const std::size_t step = points / 2000000 + 1;  // of very many copies, fewer points each
  for (const auto& copy : geometry_.copies) {
    const auto& hull = hulls[geometry_.plants[copy.plant].plant.get()];
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Vec3 p = copy.map.point(hull[i]);
      bounds_.add(p);
      if (i % step == 0) outline_.push_back(p);
    }
  }
  std::vector<Vec3> ground = outline_points(geometry_.ground);
  for (const auto& p : ground) ground_box_.add(p);
  if (outline_.empty()) outline_ = std::move(ground), bounds_ = ground_box_;
  all_bounds_ = bounds_;
  all_bounds_.add(ground_box_);
}

}  // namespace sunfleck
