#include <sunfleck/scene/facets.hpp>

#include <limits>
#include <new>
#include <unordered_map>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/counts.hpp>

namespace sunfleck {

namespace {

/// Strings that get a row when first seen.
class Interned {
 public:
  explicit Interned(std::vector<std::string>& rows) : rows_(rows) {}
  std::uint32_t row(const std::string& text) {
    const auto [place, added] = index_.try_emplace(text, static_cast<std::uint32_t>(rows_.size()));
    if (added) rows_.push_back(text);
    return place->second;
  }

 private:
  std::vector<std::string>& rows_;
  std::unordered_map<std::string, std::uint32_t> index_;
};

class Expansion {
 public:
  Expansion(const Scene& scene, FacetScene& out)
      : scene_(scene),
        out_(out),
        names_(out.organs.names),
        types_(out.organs.types),
        plants_(out.organs.plants),
        placements_(out.organs.placements) {}

  void run() {
    reserve();
    for (std::uint32_t p = 0; p < scene_.plants.size(); ++p) {
      const auto& entry = scene_.plants[p];
      for (std::size_t i = 0; i < entry.placements.size(); ++i) add_plant(p, entry.placements[i].map, label(entry.name, i));
    }
    for (const auto& group : scene_.groups)
      for (std::size_t i = 0; i < group.placements.size(); ++i) add_group(group, group.placements[i].map, label(group.name, i));
    out_.plant_facets = out_.size();
    if (scene_.ground) add_ground(*scene_.ground);
  }

 private:
  /// Takes the memory of what will be written, or refuses to, before a facet of it is.
  void reserve() {
    constexpr std::uint64_t limit = std::uint64_t{1} << 31;
    std::uint64_t facets = 0, shapes = 0, copies = 0;
    if (const auto& ground = scene_.ground)
      facets += ground->mesh ? ground->mesh->triangles.size() : std::uint64_t{2} * ground->cells[0] * ground->cells[1];
    const auto copies_of = placed_copies(scene_);
    for (std::size_t p = 0; p < copies_of.size() && facets <= limit; ++p) {
      const Plant& plant = *scene_.plants[p].plant;
      facets += copies_of[p] * plant.facet_count();
      shapes += copies_of[p] * plant.shapes.size();
      copies += copies_of[p];
    }
    if (facets > limit) throw InputError(location(scene_.file), "more than 2^31 facets", "fewer copies, or smaller plants");
    try {
      out_.corners.reserve(facets);
      out_.area.reserve(facets);
      out_.optics.reserve(facets);
      out_.organ.reserve(facets);
      out_.shapes.reserve(shapes);
      out_.copies.reserve(copies);
      out_.copy_plant.reserve(copies);
    } catch (const std::bad_alloc&) {
      throw InputError(location(scene_.file), std::to_string(facets) + " facets, for which there is not enough memory",
                       "fewer copies, or smaller plants");
    }
  }

  static std::string label(const std::string& name, std::size_t i) { return name + "[" + std::to_string(i) + "]"; }

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

  void add_facet(const Triangle& corners, std::uint32_t material, std::uint32_t organ) {
    const double area = glm::length(area_vector(corners));
    if (!(area <= std::numeric_limits<float>::max()))
      throw InputError(location(scene_.file), "facet " + std::to_string(out_.size()) + " of infinite area",
                       "coordinates of metres, not beyond all bounds");
    out_.corners.push_back(corners);
    out_.area.push_back(static_cast<float>(area));
    out_.optics.push_back(material);
    out_.organ.push_back(organ);
    if (out_.area.back() > 0.0f)
      for (const auto& p : corners) out_.bounds.add(p);
    else
      ++out_.zero_area_facets;
  }

  std::uint32_t add_organ(const std::string& name, const std::string& type, std::uint32_t plant, std::uint32_t placement,
                          std::uint32_t structure) {
    auto& organs = out_.organs;
    organs.name.push_back(names_.row(name));
    organs.type.push_back(types_.row(type));
    organs.plant.push_back(plant);
    organs.placement.push_back(placement);
    organs.structure.push_back(structure);
    return static_cast<std::uint32_t>(organs.size() - 1);
  }

  void add_plant(std::uint32_t index, const Affine& map, const std::string& path) {
    const auto& entry = scene_.plants[index];
    const Plant& plant = *entry.plant;
    const auto plant_row = plants_.row(entry.name), placement_row = placements_.row(path);
    const auto copy = static_cast<std::uint32_t>(out_.copies.size());
    out_.copies.push_back(map);
    out_.copy_plant.push_back(index);
    std::vector<std::uint32_t> organ_of(plant.structures.size(), no_parent);
    for (std::uint32_t s = 0; s < plant.shapes.size(); ++s) {
      const auto& shape = plant.shapes[s];
      auto& organ = organ_of[shape.structure];
      if (organ == no_parent) {
        const auto& structure = plant.structures[shape.structure];
        const auto& type = plant.types[structure.type];
        const std::string name = structure.name.empty() ? type + "_" + std::to_string(shape.structure) : structure.name;
        organ = add_organ(name, type, plant_row, placement_row, shape.structure);
      }
      out_.shapes.push_back({index, s, static_cast<std::uint32_t>(out_.size()), copy});
      const Mesh& mesh = plant.meshes[shape.mesh];
      const Affine to_world = map * shape.placement;
      const bool mirrors = to_world.mirrors();  // a mirror on a mirror leaves the order as it was
      for (std::uint32_t t = 0; t < shape.triangle_count; ++t) {
        Triangle c = mesh.corners(shape.first_triangle + t);
        for (auto& p : c) p = to_world.point(p);
        if (mirrors) std::swap(c[1], c[2]);
        add_facet(c, entry.shape_optics[s], organ);
      }
    }
  }

  void add_ground(const Ground& ground) {
    const auto material = static_cast<std::uint32_t>(out_.materials.size() - 1);
    const auto plant_row = plants_.row("ground"), placement_row = placements_.row("ground");
    if (ground.mesh) {
      const auto organ = add_organ("ground", "ground", plant_row, placement_row, no_parent);
      for (std::size_t t = 0; t < ground.mesh->triangles.size(); ++t) add_facet(ground.mesh->corners(t), material, organ);
      return;
    }
    const auto [columns, rows] = ground.cells;
    const double x0 = ground.centre[0] - 0.5 * ground.size[0], y0 = ground.centre[1] - 0.5 * ground.size[1];
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      return Vec3{x0 + ground.size[0] * i / columns, y0 + ground.size[1] * j / rows, ground.height};
    };
    for (std::uint32_t j = 0; j < rows; ++j)
      for (std::uint32_t i = 0; i < columns; ++i) {
        const auto organ = add_organ("cell_" + std::to_string(i) + "_" + std::to_string(j), "ground", plant_row, placement_row, no_parent);
        add_facet({at(i, j), at(i + 1, j), at(i + 1, j + 1)}, material, organ);
        add_facet({at(i, j), at(i + 1, j + 1), at(i, j + 1)}, material, organ);
      }
  }

  const Scene& scene_;
  FacetScene& out_;
  Interned names_, types_, plants_, placements_;
};

}  // namespace

FacetScene expand(const Scene& scene) {
  FacetScene out;
  out.bands = scene.band_count();
  out.periodic = scene.periodic;
  out.materials = scene.optics;
  if (scene.ground) out.materials.push_back(scene.ground->optics);
  Expansion(scene, out).run();
  if (out.size() == 0) throw InputError(location(scene.file), "no facet", "at least one plant placed in the world, or a ground");
  return out;
}

}  // namespace sunfleck
