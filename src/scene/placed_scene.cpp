#include <sunfleck/scene/placed_scene.hpp>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <unordered_map>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/plant/leaf_type.hpp>
#include <sunfleck/scene/counts.hpp>

#include "scene/neighbourhood.hpp"

namespace sunfleck {

namespace {

std::string label(const std::string& name, std::size_t i) {
  return name + "[" + std::to_string(i) + "]";
}

class Placing {
 public:
  Placing(const Scene& scene, std::uint64_t most_copies, PlacedScene& out)
      : scene_(scene), most_copies_(most_copies), out_(out), only_(out.depth.only, location(scene.file, 0, "solve.only")) {}

  void run() {
    out_.plant_facets.assign(scene_.plants.size(), 0);
    out_.plant_organs.assign(scene_.plants.size(), 0);
    out_.partial = !only_.empty();
    const auto copies = placed_copies(scene_);
    std::uint64_t all = 0;
    for (std::size_t p = 0; p < copies.size(); ++p) {
      all += copies[p];
      if (copies[p] > 0) count_plant(p);
    }
    if (!out_.partial && out_.depth.stop_at.empty() && all > most_copies_)
      out_.share = static_cast<double>(most_copies_) / static_cast<double>(all);
    try {
      if (!out_.partial) {
        out_.copies.reserve(std::min(all, most_copies_));
        out_.paths.reserve(std::min(all, most_copies_));
      }
      const Match match = out_.partial ? Match::inside : Match::complete;
      for (std::uint32_t p = 0; p < scene_.plants.size(); ++p) {
        const auto& entry = scene_.plants[p];
        for (std::size_t i = 0, n = listed(entry.placements.size()); i < n; ++i) {
          path_ = {label(entry.name, i)};
          visit(false, p, entry.placements[i].map, match);
        }
      }
      for (std::uint32_t g = 0; g < scene_.groups.size(); ++g) {
        const auto& group = scene_.groups[g];
        for (std::size_t i = 0, n = listed(group.placements.size()); i < n; ++i) {
          path_ = {label(group.name, i)};
          visit(true, g, group.placements[i].map, match);
        }
      }
    } catch (const std::bad_alloc&) {
      throw_too_many(all);
    } catch (const std::length_error&) {
      throw_too_many(all);
    }
    if (out_.share < 1 && !out_.copies.empty()) out_.share = static_cast<double>(out_.copies.size()) / static_cast<double>(all);
    if (const auto unmet = only_.unmet(); !unmet.empty())
      throw InputError(
          location(scene_.file, 0, "solve.only"), fmt::format("\"{}\", which no placement has", unmet),
          fmt::format("a path of placements as results name them{}", first_path_.empty() ? "" : ", such as \"" + first_path_ + '"'));
    out_.first_ground_facet = out_.facets;
    out_.first_ground_organ = out_.organs;
    if (!scene_.ground) return;
    if (out_.partial) return;
    add_ground(*scene_.ground);
    out_.facets += out_.ground.size();
    out_.organs += out_.ground.organs();
  }

 private:
  using Match = PathPatterns::Match;

  [[noreturn]] void throw_too_many(std::uint64_t all) const {
    throw OutOfMemory(copies_text(all) + " copies of plants; fewer copies, or `only` in [solve] for some of them");
  }

  /// Of so many placements, those that are listed.
  std::size_t listed(std::size_t placements) const {
    return out_.share < 1 ? static_cast<std::size_t>(std::ceil(static_cast<double>(placements) * out_.share)) : placements;
  }

  std::string path() const {
    std::string text;
    for (const auto& segment : path_) text += (text.empty() ? "" : "/") + segment;
    return text;
  }

  /// A plant or group at path_; `above` is what the patterns say of what holds it.
  void visit(bool is_group, std::uint32_t index, const Affine& map, Match above) {
    if (first_path_.empty()) first_path_ = path();
    Match match = above;
    if (match != Match::complete) match = only_.match(path_);
    if (match == Match::inside && !is_group) match = Match::none;
    if (match == Match::none || (match == Match::complete && stops_at(is_group, index))) {
      out_.closed.push_back({path(), is_group, index, 0, map, match == Match::complete});
      return;
    }
    if (!is_group) return add_plant(index, map, path());
    std::unordered_map<std::string, std::size_t> count;
    const auto& group = scene_.groups[index];
    for (const auto& member : group.members) {
      if (out_.share < 1 && out_.copies.size() >= 2 * most_copies_) return;
      const std::string& name = member.is_group ? scene_.groups[member.index].name : scene_.plants[member.index].name;
      path_.push_back(label(name, count[name]++));
      visit(member.is_group, member.index, map * member.placement.map, match);
      path_.pop_back();
    }
  }

  /// Does `stop_at` name this plant or group as a whole?
  bool stops_at(bool is_group, std::uint32_t index) {
    const auto& stop = out_.depth.stop_at;
    if (stop.empty()) return false;
    if (is_group) return stop.type == scene_.groups[index].name;
    if (!stop.type.empty()) return stop.type == "plant" || stop.type == scene_.plants[index].name;
    const Plant& plant = *scene_.plants[index].plant;
    if (stop.leaf_count) {
      std::uint64_t leaves = 0;
      for (const auto& s : plant.structures) leaves += is_leaf_type(plant.types[s.type]);
      return leaves <= *stop.leaf_count;
    }
    const Vec3 size = plant.bounds().size();
    return std::max({size.x, size.y, size.z}) <= *stop.size;
  }

  void count_plant(std::size_t p) {
    const Plant& plant = *scene_.plants[p].plant;
    std::vector<bool> organ(plant.structures.size(), false);
    for (const auto& shape : plant.shapes) {
      out_.plant_facets[p] += shape.triangle_count;
      if (!organ[shape.structure]) ++out_.plant_organs[p];
      organ[shape.structure] = true;
    }
  }

  void add_plant(std::uint32_t index, const Affine& map, const std::string& path) {
    out_.copies.push_back({index, map, out_.facets, out_.organs});
    out_.paths.push_back(path);
    out_.facets += out_.plant_facets[index];
    out_.organs += out_.plant_organs[index];
  }

  void add_ground(const Ground& ground) {
    if (ground.mesh) {
      std::vector<Triangle> facets;
      facets.reserve(ground.mesh->triangles.size());
      for (std::size_t t = 0; t < ground.mesh->triangles.size(); ++t) facets.push_back(ground.mesh->corners(t));
      out_.ground = GroundFacets(std::move(facets));
      return;
    }
    const double x0 = ground.centre[0] - 0.5 * ground.size[0], y0 = ground.centre[1] - 0.5 * ground.size[1];
    out_.ground = GroundFacets({x0, y0, x0 + ground.size[0], y0 + ground.size[1]}, ground.cells, ground.height);
  }

  const Scene& scene_;
  const std::uint64_t most_copies_;
  PlacedScene& out_;
  PathPatterns only_;
  std::vector<std::string> path_;
  std::string first_path_;
};

}  // namespace

PlantFacets plant_facets(const PlantEntry& entry) {
  const Plant& plant = *entry.plant;
  PlantFacets out;
  const std::size_t n = plant.facet_count();
  out.corners.reserve(n);
  out.optics.reserve(n);
  out.organ.reserve(n);
  std::vector<std::uint32_t> organ_of(plant.structures.size(), no_parent);
  for (std::uint32_t s = 0; s < plant.shapes.size(); ++s) {
    const auto& shape = plant.shapes[s];
    auto& organ = organ_of[shape.structure];
    if (organ == no_parent) {
      organ = static_cast<std::uint32_t>(out.organ_structure.size());
      out.organ_structure.push_back(shape.structure);
    }
    out.shape_first.push_back(static_cast<std::uint32_t>(out.corners.size()));
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) out.corners.push_back(shape_triangle(plant, shape, t));
    out.optics.resize(out.corners.size(), entry.shape_optics[s]);
    out.organ.resize(out.corners.size(), organ);
  }
  out.shape_first.push_back(static_cast<std::uint32_t>(out.corners.size()));
  return out;
}

std::string organ_name(const Plant& plant, std::uint32_t structure) {
  const auto& s = plant.structures[structure];
  return s.name.empty() ? plant.types[s.type] + "_" + std::to_string(structure) : s.name;
}

Triangle GroundFacets::operator[](std::size_t facet) const {
  if (!flat()) return facets_[facet];
  const double width = field_[2] - field_[0], depth = field_[3] - field_[1];
  const std::size_t cell = facet / 2, i = cell % cells_[0], j = cell / cells_[0];
  const auto at = [&](std::size_t column, std::size_t row) {
    return Vec3{field_[0] + width * static_cast<double>(column) / cells_[0], field_[1] + depth * static_cast<double>(row) / cells_[1],
                height_};
  };
  if (facet % 2 == 0) return {at(i, j), at(i + 1, j), at(i + 1, j + 1)};
  return {at(i, j), at(i + 1, j + 1), at(i, j + 1)};
}

std::vector<Triangle> GroundFacets::written_out() const {
  std::vector<Triangle> out(size_);
  for (std::size_t f = 0; f < size_; ++f) out[f] = (*this)[f];
  return out;
}

std::string GroundFacets::organ_name(std::size_t organ) const {
  if (!flat()) return "ground";
  return "cell_" + std::to_string(organ % cells_[0]) + "_" + std::to_string(organ / cells_[0]);
}

PlacedScene place(const Scene& scene, const Depth& depth, std::uint64_t most_copies) {
  PlacedScene out;
  out.depth = depth;
  Placing(scene, most_copies, out).run();
  if (!out.closed.empty()) add_neighbourhood(scene, out);
  if (out.facets == 0 && out.near.empty() && scene.sensors.empty())
    throw InputError(location(scene.file), "no facet", "at least one plant placed in the world, or a ground");
  return out;
}

}  // namespace sunfleck
