#include <sunfleck/cli/verbs.hpp>

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/text_units.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/solver/plan.hpp>

#include "cli/json_text.hpp"

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
  for (const auto& part : plan.memory) json["memory_bytes"][part.name] = part.amount;
  json["memory_bytes"][plan.at_once > 0 ? "at_once" : "total"] = plan.memory_total();
  for (const auto& figure : plan.work) json["work"][figure.name] = figure.amount;
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
  const auto print_bytes = [](const std::string& name, std::uint64_t bytes, const std::string& what) {
    fmt::print("  {:<16} {:>12}  {}\n", name, bytes_text(static_cast<double>(bytes)), what);
  };
  for (const auto& part : plan.memory) print_bytes(part.name, part.amount, part.what);
  if (plan.at_once > 0)
    print_bytes("at_once", plan.memory_total(), "the most at one time");
  else
    print_bytes("total", plan.memory_total(), "in all, at most");
  fmt::print("predicted work\n");
  for (const auto& figure : plan.work) fmt::print("  {:<16} {:>12}  {}\n", figure.name, figure.amount, figure.what);
}

}  // namespace

int verb_plan(const PlanOptions& options, Progress& progress) {
  const std::size_t bytes_at_start = resident_bytes();
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  const auto [scene, of_scene, output] = read_scene_file(options.scene);
  for (const auto& note : scene.notes) progress.line("note: " + note);
  RunSettings run;
  run.method = options.method;
  if (options.quality) run.quality = quality_from_name(*options.quality);
  run.threads = options.threads;
  run = filled_up(std::move(run), of_scene);
  const Plan plan = make_plan(scene, choose_method(run, scene, progress), run, progress, bytes_at_start);
  if (options.json)
    fmt::print("{}\n", json_text(json_of(scene, plan)));
  else
    print_text(scene, plan);
  return 0;
}

}  // namespace sunfleck
