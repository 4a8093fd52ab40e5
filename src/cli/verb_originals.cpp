#include <sunfleck/cli/verbs.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sunfleck/format/policy_toml.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/policy/classes.hpp>

#include "cli/text_units.hpp"

namespace sunfleck {

namespace {

std::string label(const Scene& scene, const StructureRef& s) {
  if (s.is_group) return scene.groups[s.index].name;
  const auto& entry = scene.plants[s.index];
  const auto& structure = entry.plant->structures[s.structure];
  if (s.structure == 0) return entry.name;
  return entry.name + "/" +
         (structure.name.empty() ? fmt::format("{}_{}", entry.plant->types[structure.type], s.structure) : structure.name);
}

nlohmann::ordered_json json_of(const Scene& scene, const Classification& classification) {
  nlohmann::ordered_json json;
  json["scene"] = scene.file;
  json["classes"] = nlohmann::ordered_json::array();
  for (const auto& c : classification.classes) {
    nlohmann::ordered_json one;
    one["name"] = c.name;
    one["likeness"] = c.likeness == Likeness::exact ? "exact" : "policy";
    one["representative"] = label(scene, c.members[c.representative].structure);
    one["facets"] = c.facets;
    one["copies"] = c.copies;
    for (const auto& m : c.members)
      one["members"].push_back(
          {{"structure", label(scene, m.structure)}, {"scale", m.scale}, {"area_m2", m.area_m2}, {"copies", m.copies}});
    json["classes"].push_back(std::move(one));
  }
  json["notes"] = classification.notes;
  return json;
}

void print_text(const Scene& scene, const Classification& classification) {
  std::size_t width = 5;
  for (const auto& c : classification.classes) width = std::max(width, c.name.size());
  fmt::print("{:<{}} {:<8} {:>8} {:>8} {:>9} {:>10}  {}\n", "class", width, "likeness", "members", "copies", "facets", "area [m^2]",
             "representative");
  for (const auto& c : classification.classes) {
    const auto& r = c.members[c.representative];
    fmt::print("{:<{}} {:<8} {:>8} {:>8} {:>9} {:>10.4g}  {}\n", c.name, width, c.likeness == Likeness::exact ? "exact" : "policy",
               c.members.size(), c.copies, c.facets, r.area_m2, label(scene, r.structure));
  }
  if (classification.classes.empty()) fmt::print("nothing repeats, and no policy says what is alike\n");
}

}  // namespace

int verb_originals(const OriginalsOptions& options, Progress& progress) {
  Scene scene = read_scene(options.scene);
  if (options.policy)
    for (auto& entry : scene.plants) entry.policy_file = *options.policy;
  const Classification classification = classify(scene, read_policies(scene));
  for (const auto& note : scene.notes) progress.line("note: " + note);
  for (const auto& note : classification.notes) progress.line("note: " + note);
  if (options.json)
    fmt::print("{}\n", json_of(scene, classification).dump(2));
  else
    print_text(scene, classification);
  return 0;
}

}  // namespace sunfleck
