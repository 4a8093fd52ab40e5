#include <sunfleck/cli/verbs.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sunfleck/format/scene_toml.hpp>

#include "cli/plan.hpp"
#include "cli/text_units.hpp"

namespace sunfleck {

namespace {

nlohmann::ordered_json json_of(const Scene& scene, const Plan& plan) {
  nlohmann::ordered_json json;
  json["scene"] = scene.file;
  json["method"] = plan.choice.method;
  json["quality"] = name_of(plan.choice.quality);
  json["bands"] = scene.bands;
  json["states"] = scene.states.size();
  json["facets"] = {{"plants", plan.counts.plant_facets}, {"unique", plan.counts.unique_facets}, {"ground", plan.counts.ground_facets}};
  json["organs"] = plan.counts.organs;
  for (const char* list : {"done", "left_out"}) json[list] = nlohmann::ordered_json::object();
  for (const auto& item : plan.items) json[item.done ? "done" : "left_out"][item.name] = item.why;
  for (const auto& [part, bytes] : plan.memory) json["memory_bytes"][part] = bytes;
  json["memory_bytes"]["total"] = plan.memory_total();
  for (const auto& [name, amount] : plan.work) json["work"][name] = amount;
  json["notes"] = scene.notes;
  return json;
}

void print_items(const Plan& plan, bool done) {
  for (const auto& item : plan.items)
    if (item.done == done) fmt::print("  {:<14} {}\n", item.name, item.why);
}

void print_text(const Scene& scene, const Plan& plan) {
  std::uint64_t copies = 0;
  for (const auto c : plan.counts.copies) copies += c;
  fmt::print("scene     {}\nmethod    {}, quality {}{}\n", scene.file, plan.choice.method, name_of(plan.choice.quality),
             plan.choice.why.empty() ? "" : " (" + plan.choice.why + ")");
  fmt::print("facets    {} of {}, {} of the ground; {}\n", plan.counts.plant_facets, counted(copies, "placed plant", "placed plants"),
             plan.counts.ground_facets, counted(plan.counts.organs, "organ", "organs"));
  fmt::print("\ndone\n");
  print_items(plan, true);
  fmt::print("left out\n");
  print_items(plan, false);
  fmt::print("predicted memory\n");
  for (const auto& [part, bytes] : plan.memory) fmt::print("  {:<32} {:>10}\n", part, bytes_text(static_cast<double>(bytes)));
  fmt::print("  {:<32} {:>10}\n", "in all, at most", bytes_text(static_cast<double>(plan.memory_total())));
  fmt::print("predicted work\n");
  for (const auto& [name, amount] : plan.work) fmt::print("  {:<32} {:>10}\n", name, amount);
}

}  // namespace

int verb_plan(const PlanOptions& options, Progress& progress) {
  const Scene scene = read_scene(options.scene);
  const MethodChoice choice = choose_method(options.method, options.quality, scene, progress);
  for (const auto& note : scene.notes) progress.line("note: " + note);
  const Plan plan = make_plan(scene, choice, progress);
  if (options.json)
    fmt::print("{}\n", json_of(scene, plan).dump(2));
  else
    print_text(scene, plan);
  return 0;
}

}  // namespace sunfleck
