#include <sunfleck/solver/method_choice.hpp>

#include <vector>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/instantiation/solve.hpp>
#include <sunfleck/light/wide_sun.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/extent.hpp>

#include <sunfleck/core/text_units.hpp>

namespace sunfleck {

namespace {

constexpr double much_covered = 64;  // periodic cells that one plant covers

std::string checked_method(const std::string& name) {
  const auto& methods = method_names();
  for (const auto& known : methods)
    if (name == known) return name;
  const std::string near = nearest_name(name, methods);
  throw UsageError(fmt::format("method: found '{}'; expected one of {}{}", name, joined(methods),
                               near.empty() ? "" : " (did you mean '" + near + "'?)"));
}

}  // namespace

std::string why_not_judged(const std::string& method) {
  if (method == "direct") return "'direct' leaves scattered light out";
  if (method == "lattice") return "'lattice' approximates scattered light";
  if (method == "occlusion") return "'occlusion' estimates sky light alone";
  if (method == "reference") return "'reference' takes samples";
  return {};
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
  const auto plan = plan_sharing(scene, place(scene, {}, most_copies_in_plan), settings, progress);
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

MethodChoice choose_method(const RunSettings& run, const Scene& scene, Progress& progress) {
  MethodChoice choice;
  choice.quality = run.quality.value_or(run.error.empty() ? Quality::standard : Quality::draft);
  if (run.method) {
    choice.method = checked_method(*run.method);
    return choice;
  }
  auto reason = default_method(scene, choice.quality, progress);
  choice.method = std::move(reason.method);
  choice.why = std::move(reason.why);
  return choice;
}

void refuse_depth(const Scene& scene, const Depth& depth, const std::string& method) {
  if (method == "instantiation" || depth.whole()) return;
  const bool stops = !depth.stop_at.empty();
  if (stops || method != "reference")
    throw InputError(location(scene.file, 0, stops ? "solve.stop_at" : "solve.only"), "it with method " + method,
                     stops ? "method instantiation" : "method instantiation or reference");
}

}  // namespace sunfleck
