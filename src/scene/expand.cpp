#include <sunfleck/scene/facets.hpp>

#include <limits>
#include <new>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/facet_rows.hpp>

namespace sunfleck {

namespace {

/// Takes the memory of what will be written, or refuses to, before a facet of it is.
void reserve(const Scene& scene, FacetScene& out) {
  constexpr std::uint64_t limit = std::uint64_t{1} << 31;
  std::uint64_t facets = 0, shapes = 0, copies = 0;
  if (const auto& ground = scene.ground)
    facets += ground->mesh ? ground->mesh->triangles.size() : std::uint64_t{2} * ground->cells[0] * ground->cells[1];
  const auto copies_of = placed_copies(scene);
  for (std::size_t p = 0; p < copies_of.size() && facets <= limit; ++p) {
    const Plant& plant = *scene.plants[p].plant;
    facets += copies_of[p] * plant.facet_count();
    shapes += copies_of[p] * plant.shapes.size();
    copies += copies_of[p];
  }
  if (facets > limit) throw InputError(location(scene.file), "more than 2^31 facets", "fewer copies, or smaller plants");
  try {
    out.corners.reserve(facets);
    out.area.reserve(facets);
    out.optics.reserve(facets);
    out.organ.reserve(facets);
    out.shapes.reserve(shapes);
    out.copies.reserve(copies);
    out.copy_plant.reserve(copies);
  } catch (const std::bad_alloc&) {
    throw OutOfMemory(std::to_string(facets) + " facets of all copies and the ground; fewer copies or ground cells, or smaller plants");
  }
}

void add_organs(const OrganNames::Columns& columns, std::uint32_t placement, OrganTable& organs) {
  organs.name.insert(organs.name.end(), columns.name.begin(), columns.name.end());
  organs.type.insert(organs.type.end(), columns.type.begin(), columns.type.end());
  organs.structure.insert(organs.structure.end(), columns.structure.begin(), columns.structure.end());
  organs.plant.resize(organs.name.size(), columns.plant);
  organs.placement.resize(organs.name.size(), placement);
}

}  // namespace

FacetScene expand(const Scene& scene) {
  FacetScene out;
  reserve(scene, out);
  PlacedScene placed = place(scene);
  const FacetRows rows(scene, placed);
  out.bands = scene.band_count();
  out.periodic = scene.periodic;
  out.materials = rows.materials();
  out.plant_facets = placed.first_ground_facet;
  auto names = organ_names(rows);

  for (std::uint32_t copy = 0; copy <= placed.copies.size(); ++copy) {
    const std::uint64_t first_organ = rows.first_organ(copy);
    if (rows.is_ground(copy)) {
      add_organs(names.ground, copy, out.organs);
    } else {
      const auto plant = placed.copies[copy].plant;
      add_organs(names.of_plant[plant], copy, out.organs);
      std::size_t facet = out.size();
      for (std::uint32_t s = 0; s < scene.plants[plant].plant->shapes.size(); ++s) {
        out.shapes.push_back({plant, s, static_cast<std::uint32_t>(facet), copy});
        facet += scene.plants[plant].plant->shapes[s].triangle_count;
      }
      out.copies.push_back(placed.copies[copy].map);
      out.copy_plant.push_back(plant);
    }
    rows.visit(copy, 0, rows.facet_count(copy), [&](std::uint64_t, const Triangle& corners, std::uint32_t material, std::uint32_t organ) {
      const double area = glm::length(area_vector(corners));
      if (!(area <= std::numeric_limits<float>::max()))
        throw InputError(location(scene.file), "facet " + std::to_string(out.size()) + " of infinite area",
                         "coordinates of metres, not beyond all bounds");
      out.corners.push_back(corners);
      out.area.push_back(static_cast<float>(area));
      out.optics.push_back(material);
      out.organ.push_back(static_cast<std::uint32_t>(first_organ + organ));
      if (out.area.back() > 0.0f)
        for (const auto& p : corners) out.bounds.add(p);
      else
        ++out.zero_area_facets;
    });
  }
  out.organs.names = std::move(names.names);
  out.organs.types = std::move(names.types);
  out.organs.plants = std::move(names.plants);
  out.organs.placements = std::move(placed.paths);
  if (scene.ground) out.organs.placements.push_back("ground");
  return out;
}

}  // namespace sunfleck
