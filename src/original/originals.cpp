#include <sunfleck/original/originals.hpp>

#include <set>
#include <utility>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

OriginalGeometry empty_geometry(const Scene& scene) {
  OriginalGeometry g;
  g.materials = scene.optics;
  g.bands = static_cast<std::uint32_t>(scene.band_count());
  return g;
}

void append(OriginalGeometry& out, const std::vector<Triangle>& corners, const std::vector<std::uint32_t>& optics, const Affine& map) {
  const bool mirrors = map.mirrors();
  for (auto t : corners) {
    for (auto& p : t) p = map.point(p);
    if (mirrors) std::swap(t[1], t[2]);
    out.corners.push_back(t);
  }
  out.optics.insert(out.optics.end(), optics.begin(), optics.end());
}

void append_plant(OriginalGeometry& out, const Scene& scene, std::uint32_t plant, const Affine& map) {
  const auto facets = structure_facets(scene.plants[plant], 0);
  append(out, facets.corners, facets.optics, map);
}

void append_group(OriginalGeometry& out, const Scene& scene, std::uint32_t group, const Affine& map) {
  for (const auto& member : scene.groups[group].members) {
    const Affine inner = map * member.placement.map;
    if (member.is_group)
      append_group(out, scene, member.index, inner);
    else
      append_plant(out, scene, member.index, inner);
  }
}

/// Materials that facets have, in order of their rows, so that other entries of a scene do not change the original.
void keep_used_materials(OriginalGeometry& g) {
  const std::set<std::uint32_t> used(g.optics.begin(), g.optics.end());
  std::vector<std::uint32_t> row(g.materials.size(), 0);
  std::vector<Optics> kept;
  for (const auto m : used) {
    row[m] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(g.materials[m]);
  }
  for (auto& m : g.optics) m = row[m];
  g.materials = std::move(kept);
}

}  // namespace

OriginalGeometry original_geometry(const Scene& scene, const OriginalClass& original, std::uint64_t most_facets) {
  const StructureRef& ref = original.members[original.representative].structure;
  if (original.facets > most_facets)
    throw InputError(location(scene.file), "\"" + original.name + "\" of " + std::to_string(original.facets) + " facets",
                     "at most " + std::to_string(most_facets) + " facets in an original that is measured as a whole");
  OriginalGeometry out = empty_geometry(scene);
  const Affine stretch{original.stretch, Vec3{0.0}};
  if (ref.is_group) {
    append_group(out, scene, ref.index, stretch);
  } else {
    const auto facets = structure_facets(scene.plants[ref.index], ref.structure);
    append(out, facets.corners, facets.optics, stretch);
  }
  keep_used_materials(out);
  return out;
}

OriginalGeometry structure_geometry(const Scene& scene, std::uint32_t plant, std::uint32_t structure) {
  OriginalGeometry out = empty_geometry(scene);
  const auto facets = structure_facets(scene.plants[plant], structure);
  append(out, facets.corners, facets.optics, Affine{});
  keep_used_materials(out);
  return out;
}

}  // namespace sunfleck
