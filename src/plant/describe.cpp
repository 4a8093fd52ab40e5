#include <sunfleck/plant/describe.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>

#include <fmt/format.h>

#include <sunfleck/core/memory.hpp>

namespace sunfleck {

PlantSummary summarize_plant(const Plant& plant) {
  PlantSummary summary;
  summary.name = plant.name;
  summary.file = plant.file;
  summary.structures = plant.structures.size();
  summary.meshes = plant.meshes.size();
  summary.shapes = plant.shapes.size();
  summary.materials = plant.materials;
  summary.attributes = plant.attribute_names;
  summary.notes = plant.notes;
  for (const auto& type : plant.types) summary.types.push_back({.type = type});
  for (const auto& structure : plant.structures) ++summary.types[structure.type].structures;
  std::vector<bool> seen(plant.structures.size(), false);
  for (const auto& shape : plant.shapes) {
    TypeSummary& type = summary.types[plant.structures[shape.structure].type];
    if (!seen[shape.structure]) ++type.organs, ++summary.organs;
    seen[shape.structure] = true;
    type.facets += shape.triangle_count;
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) {
      const Triangle corners = shape_triangle(plant, shape, t);
      const double area = glm::length(area_vector(corners));
      type.area_m2 += area;
      if (area == 0) ++summary.zero_area_facets;
      for (const auto& p : corners) summary.bounds.add(p);
    }
  }
  for (const auto& type : summary.types) {
    summary.facets += type.facets;
    summary.area_m2 += type.area_m2;
  }
  return summary;
}

std::string describe_plant(const Plant& plant) {
  return describe_plant(summarize_plant(plant));
}

std::string describe_plant(const PlantSummary& s) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "plant      {}{}\n", s.name.empty() ? "(no name)" : s.name, s.file.empty() ? "" : fmt::format(" ({})", s.file));
  fmt::format_to(out, "structures {}, of which {} are organs\n", s.structures, s.organs);
  std::size_t width = 4;
  for (const auto& type : s.types) width = std::max(width, type.type.size());
  fmt::format_to(out, "  {:<{}} {:>10} {:>10} {:>10} {:>12}\n", "type", width, "structures", "organs", "facets", "area [m^2]");
  for (const auto& type : s.types)
    fmt::format_to(out, "  {:<{}} {:>10} {:>10} {:>10} {:>12.6g}\n", type.type, width, type.structures, type.organs, type.facets,
                   type.area_m2);
  fmt::format_to(out, "facets     {}, {} of them with zero area\n", s.facets, s.zero_area_facets);
  fmt::format_to(out, "area       {:.6g} m^2, one side\n", s.area_m2);
  if (!s.bounds.empty())
    fmt::format_to(out, "bounds     x {:.4g} to {:.4g} m, y {:.4g} to {:.4g} m, z {:.4g} to {:.4g} m\n", s.bounds.low.x, s.bounds.high.x,
                   s.bounds.low.y, s.bounds.high.y, s.bounds.low.z, s.bounds.high.z);
  fmt::format_to(out, "meshes     {}, placed {} times\n", s.meshes, s.shapes);
  std::vector<std::string> named;
  std::copy_if(s.materials.begin(), s.materials.end(), std::back_inserter(named), [](const auto& name) { return !name.empty(); });
  if (!named.empty()) fmt::format_to(out, "materials  {}\n", fmt::join(named, ", "));
  if (!s.attributes.empty()) fmt::format_to(out, "attributes {}\n", fmt::join(s.attributes, ", "));
  for (const auto& note : s.notes) fmt::format_to(out, "note       {}\n", note);
  return text;
}

std::uint32_t branching_order(const Plant& plant, std::uint32_t structure) {
  static const std::array axes{"axis", "branch", "trunk", "stem", "tiller"};
  std::uint32_t order = 0;
  for (auto s = structure; s != no_parent; s = plant.structures[s].parent) {
    std::string type = plant.types[plant.structures[s].type];
    for (auto& c : type) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    order += std::any_of(axes.begin(), axes.end(), [&](const char* name) { return type == name; });
  }
  return order;
}

std::size_t held_bytes(const Plant& plant) {
  const auto text = [](const std::string& s) { return s.capacity() > 15 ? s.capacity() + 1 : 0; };  // longer than fits in the string itself
  std::size_t total = bytes_of(plant.structures) + bytes_of(plant.shapes) + bytes_of(plant.meshes);
  for (const auto& s : plant.structures) {
    total += text(s.name) + bytes_of(s.attributes) + (s.attributes.empty() ? 0 : 16);  // the latter for the allocation itself
    for (const auto& [key, value] : s.attributes)
      if (const auto* words = std::get_if<std::string>(&value)) total += text(*words);
  }
  for (const auto& mesh : plant.meshes) total += bytes_of(mesh.vertices) + bytes_of(mesh.triangles);
  return total;
}

}  // namespace sunfleck
