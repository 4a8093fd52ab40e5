#include <sunfleck/scene/placed_scene.hpp>

#include <new>
#include <unordered_map>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/counts.hpp>

namespace sunfleck {

namespace {

std::string label(const std::string& name, std::size_t i) {
  return name + "[" + std::to_string(i) + "]";
}

class Placing {
 public:
  Placing(const Scene& scene, PlacedScene& out) : scene_(scene), out_(out) {}

  void run() {
    out_.plant_facets.assign(scene_.plants.size(), 0);
    out_.plant_organs.assign(scene_.plants.size(), 0);
    const auto copies = placed_copies(scene_);
    std::uint64_t all = 0;
    for (std::size_t p = 0; p < copies.size(); ++p) {
      all += copies[p];
      if (copies[p] > 0) count_plant(p);
    }
    try {
      out_.copies.reserve(all);
      out_.paths.reserve(all);
    } catch (const std::exception&) {
      throw InputError(location(scene_.file), std::to_string(all) + " copies of plants, for which there is not enough memory",
                       "fewer copies");
    }
    for (std::uint32_t p = 0; p < scene_.plants.size(); ++p) {
      const auto& entry = scene_.plants[p];
      for (std::size_t i = 0; i < entry.placements.size(); ++i) add_plant(p, entry.placements[i].map, label(entry.name, i));
    }
    for (const auto& group : scene_.groups)
      for (std::size_t i = 0; i < group.placements.size(); ++i) add_group(group, group.placements[i].map, label(group.name, i));
    out_.first_ground_facet = out_.facets;
    out_.first_ground_organ = out_.organs;
    if (scene_.ground) add_ground(*scene_.ground);
    out_.facets += out_.ground.size();
    out_.organs += out_.ground_names.size();
  }

 private:
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

  void add_group(const GroupEntry& group, const Affine& map, const std::string& path) {
    std::unordered_map<std::string, std::size_t> count;
    for (const auto& member : group.members) {
      const std::string& name = member.is_group ? scene_.groups[member.index].name : scene_.plants[member.index].name;
      const std::string inner = path + "/" + label(name, count[name]++);
      if (member.is_group)
        add_group(scene_.groups[member.index], map * member.placement.map, inner);
      else
        add_plant(member.index, map * member.placement.map, inner);
    }
  }

  void add_ground(const Ground& ground) {
    if (ground.mesh) {
      out_.ground_names.push_back("ground");
      for (std::size_t t = 0; t < ground.mesh->triangles.size(); ++t) out_.ground.push_back(ground.mesh->corners(t));
      out_.ground_organ.assign(out_.ground.size(), 0);
      return;
    }
    const auto columns = ground.cells[0], rows = ground.cells[1];  // Clang 14 does not capture structured bindings
    const double x0 = ground.centre[0] - 0.5 * ground.size[0], y0 = ground.centre[1] - 0.5 * ground.size[1];
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      return Vec3{x0 + ground.size[0] * i / columns, y0 + ground.size[1] * j / rows, ground.height};
    };
    for (std::uint32_t j = 0; j < rows; ++j)
      for (std::uint32_t i = 0; i < columns; ++i) {
        const auto organ = static_cast<std::uint32_t>(out_.ground_names.size());
        out_.ground_names.push_back("cell_" + std::to_string(i) + "_" + std::to_string(j));
        out_.ground.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        out_.ground.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        out_.ground_organ.insert(out_.ground_organ.end(), 2, organ);
      }
  }

  const Scene& scene_;
  PlacedScene& out_;
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

PlacedScene place(const Scene& scene) {
  PlacedScene out;
  Placing(scene, out).run();
  if (out.facets == 0 && scene.sensors.empty())
    throw InputError(location(scene.file), "no facet", "at least one plant placed in the world, or a ground");
  return out;
}

}  // namespace sunfleck
