#include "cli/method_choice.hpp"

#include <array>
#include <vector>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/light/wide_sun.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/extent.hpp>

#include "cli/text_units.hpp"

namespace sunfleck {

namespace {

const std::vector<std::string> methods{"instantiation", "clustering", "flat", "direct", "reference"};

constexpr double much_covered = 64;  // periodic cells that one plant covers

constexpr std::array<Quality, 3> qualities{Quality::draft, Quality::standard, Quality::fine};

std::string checked_method(const std::string& name) {
  for (const auto& known : methods)
    if (name == known) return name;
  const std::string near = nearest_name(name, methods);
  throw UsageError(fmt::format("method: found '{}'; expected one of {}{}", name, joined(methods),
                               near.empty() ? "" : " (did you mean '" + near + "'?)"));
}

Quality quality_from_name(const std::string& name) {
  for (const auto known : qualities)
    if (name == name_of(known)) return known;
  throw UsageError(fmt::format("--quality: found '{}'; expected one of draft, standard, fine", name));
}

}  // namespace

std::string name_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return "draft";
    case Quality::standard:
      return "standard";
    case Quality::fine:
      return "fine";
  }
  return {};
}

MethodChoice choose_method(const std::optional<std::string>& method, const std::optional<std::string>& quality, const SolveChoice& scene) {
  MethodChoice choice;
  choice.method = checked_method(method ? *method : scene.method.value_or("clustering"));
  if (quality)
    choice.quality = quality_from_name(*quality);
  else
    choice.quality = scene.quality.value_or(Quality::standard);
  return choice;
}

MethodReason default_method(const Scene& scene, Quality quality, Progress& progress) {
  if (!scene.lamps.empty()) return {"clustering", "instantiation knows no lamps"};
  if (!scene.sensors.empty()) return {"clustering", "instantiation knows no sensors"};
  for (const auto& state : scene.states)
    if (state.sun && state.sun->angular_diameter_deg > widest_narrow_sun_deg) return {"clustering", "instantiation knows no wide sun"};
  if (!repeats(scene)) return {"clustering", "too little repeats for instantiation to pay"};
  if (const double covered = most_cells_covered(scene); covered > much_covered)
    return {"clustering",
            fmt::format("plants cover up to {:.0f} periodic cells, far into images of their own: too much for instantiation", covered)};
  InstantiationSettings settings;
  settings.density = instantiation_density(quality);
  const auto classes = classes_of_policies(scene);
  settings.classes = classes ? &*classes : nullptr;
  const auto plan = plan_sharing(scene, place(scene, most_copies_in_plan), settings, progress);
  if (plan.tangled > much_tangled)
    return {"clustering",
            fmt::format("{:.1f} % of what is seen inside plants is hidden by others that reach into them, or by the ground: too much for "
                        "instantiation",
                        100 * plan.tangled)};
  if (plan.merged_copies > 0 && !repeats(count(scene).plant_facets, plan.unique_facets))
    return {"clustering",
            fmt::format("{} copies reach into each other, and too little else repeats for instantiation to pay", plan.merged_copies)};
  return {"instantiation", fmt::format("{} share {} {}", counted(plan.copies, "copy", "copies"), plan.originals,
                                       plan.originals == 1 ? "original" : "originals")};
}

MethodChoice choose_method(const std::optional<std::string>& method, const std::optional<std::string>& quality, const Scene& scene,
                           Progress& progress) {
  auto choice = choose_method(method, quality, scene.solve);
  if (method || scene.solve.method) return choice;
  auto reason = default_method(scene, choice.quality, progress);
  choice.method = std::move(reason.method);
  choice.why = std::move(reason.why);
  return choice;
}

void refuse_depth(const Scene& scene, const std::string& method) {
  if (method == "instantiation" || (scene.solve.only.empty() && scene.solve.stop_at.empty())) return;
  const bool stops = !scene.solve.stop_at.empty();
  if (stops || method != "reference")
    throw InputError(location(scene.file, 0, stops ? "solve.stop_at" : "solve.only"), "it with method " + method,
                     stops ? "method instantiation" : "method instantiation or reference");
}

RadiosityMethod radiosity_method(const std::string& method) {
  return method == "flat" ? RadiosityMethod::flat : method == "direct" ? RadiosityMethod::direct : RadiosityMethod::clustering;
}

}  // namespace sunfleck
