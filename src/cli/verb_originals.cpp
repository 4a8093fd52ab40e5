#include <sunfleck/cli/verbs.hpp>

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include <sunfleck/core/timer.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/original/originals.hpp>
#include <sunfleck/original/suggest.hpp>

#include "cli/json_text.hpp"
#include <sunfleck/core/text_units.hpp>

namespace sunfleck {

namespace {

struct Measured {
  OriginalTables tables;
  std::optional<ClassSpread> spread;
  CacheState state = CacheState::off;
};

std::string label(const Scene& scene, const StructureRef& s) {
  if (s.is_group) return scene.groups[s.index].name;
  const auto& entry = scene.plants[s.index];
  const auto& structure = entry.plant->structures[s.structure];
  if (s.structure == 0) return entry.name;
  return entry.name + "/" +
         (structure.name.empty() ? fmt::format("{}_{}", entry.plant->types[structure.type], s.structure) : structure.name);
}

double sphere_mean(const OriginalTables& t, double (OriginalTables::*of)(const Vec3&) const) {
  constexpr int count = 500;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count, r = std::sqrt(1.0 - z * z), phi = 2.399963229728653 * i;
    sum += (t.*of)({r * std::cos(phi), r * std::sin(phi), z}) / count;
  }
  return sum;
}

nlohmann::ordered_json json_of(const Scene& scene, const Measured& m) {
  const OriginalTables& t = m.tables;
  nlohmann::ordered_json json;
  json["basis"] = name_of(t.basis);
  if (t.basis == TableSettings::Basis::harmonics) json["order"] = t.order;
  json["cache"] = name_of(m.state);
  json["reached"] = t.reached;
  json["samples"] = t.samples;
  json["rays"] = t.rays;
  json["area_m2"] = t.area_m2;
  json["sigma_mean_m2"] = sphere_mean(t, &OriginalTables::intercepted_area);
  json["transmittance_mean"] = sphere_mean(t, &OriginalTables::transmittance);
  json["sigma_error"] = t.sigma_error;
  if (m.spread) {
    json["spread"] = {{"members", m.spread->members}, {"sigma", m.spread->sigma}, {"noise", m.spread->noise}};
    for (std::uint32_t b = 0; b < t.bands; ++b) json["spread"]["bands"][scene.bands[b]] = m.spread->phase[b];
  }
  for (std::uint32_t b = 0; b < t.bands; ++b) {
    const auto& e = t.errors[b];
    json["bands"][scene.bands[b]] = {{"albedo", t.albedo(b)},
                                     {"sampling_error", e.sampling},
                                     {"fit_residual", e.fit},
                                     {"energy_residual", e.energy},
                                     {"reciprocity_residual", e.reciprocity}};
  }
  return json;
}

nlohmann::ordered_json json_of(const Scene& scene, const Classification& classification, const std::vector<Measured>& measured) {
  nlohmann::ordered_json json;
  json["scene"] = scene.file;
  json["classes"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < classification.classes.size(); ++i) {
    const auto& c = classification.classes[i];
    nlohmann::ordered_json one;
    one["name"] = c.name;
    one["likeness"] = c.likeness == Likeness::exact ? "exact" : "policy";
    one["representative"] = label(scene, c.members[c.representative].structure);
    one["facets"] = c.facets;
    one["copies"] = c.copies;
    for (const auto& m : c.members)
      one["members"].push_back(
          {{"structure", label(scene, m.structure)}, {"scale", m.scale}, {"area_m2", m.area_m2}, {"copies", m.copies}});
    if (!measured.empty()) one["tables"] = json_of(scene, measured[i]);
    json["classes"].push_back(std::move(one));
  }
  json["notes"] = classification.notes;
  return json;
}

std::size_t name_width(const Classification& classification) {
  std::size_t width = 5;
  for (const auto& c : classification.classes) width = std::max(width, c.name.size());
  return width;
}

void print_classes(const Scene& scene, const Classification& classification) {
  const auto width = name_width(classification);
  fmt::print("{:<{}} {:<8} {:>8} {:>8} {:>9} {:>10}  {}\n", "class", width, "likeness", "members", "copies", "facets", "area [m^2]",
             "representative");
  for (const auto& c : classification.classes) {
    const auto& r = c.members[c.representative];
    fmt::print("{:<{}} {:<8} {:>8} {:>8} {:>9} {:>10.4g}  {}\n", c.name, width, c.likeness == Likeness::exact ? "exact" : "policy",
               c.members.size(), c.copies, c.facets, r.area_m2, label(scene, r.structure));
  }
  if (classification.classes.empty()) fmt::print("nothing repeats, and no policy says what is alike\n");
}

void print_tables(const Scene& scene, const Classification& classification, const std::vector<Measured>& measured) {
  if (measured.empty()) return;
  const auto width = name_width(classification);
  fmt::print("\n{:<{}} {:>12} {:>6} {:<6} {:>6}  {:>8} {:>6} {:>7} {:>11}  {:>9} {}\n", "tables", width, "sigma [m^2]", "T", "band",
             "albedo", "sampling", "fit", "energy", "reciprocity", "samples", "cache");
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const OriginalTables& t = measured[i].tables;
    for (std::uint32_t b = 0; b < t.bands; ++b) {
      const auto& e = t.errors[b];
      if (b == 0)
        fmt::print("{:<{}} {:>12.4g} {:>6.3f}", classification.classes[i].name, width, sphere_mean(t, &OriginalTables::intercepted_area),
                   sphere_mean(t, &OriginalTables::transmittance));
      else
        fmt::print("{:<{}} {:>12} {:>6}", "", width, "", "");
      fmt::print(" {:<6} {:>6.4f} {:>8.3f}% {:>5.2f}% {:>6.3f}% {:>10.3f}%", scene.bands[b], t.albedo(b), 100 * e.sampling, 100 * e.fit,
                 100 * e.energy, 100 * e.reciprocity);
      if (b == 0) fmt::print("  {:>9} {}{}", t.samples, name_of(measured[i].state), t.reached ? "" : " (sampling error not reached)");
      fmt::print("\n");
    }
  }
}

void print_spread(const Scene& scene, const Classification& classification, const std::vector<Measured>& measured) {
  if (std::none_of(measured.begin(), measured.end(), [](const Measured& m) { return m.spread.has_value(); })) return;
  const auto width = name_width(classification);
  fmt::print("\n{:<{}} {:>8} {:>8}", "spread, % of the member's own", width, "measured", "sigma");
  for (const auto& band : scene.bands) fmt::print(" {:>8}", "S " + band);
  fmt::print(" {:>8}\n", "noise");
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!measured[i].spread) continue;
    const auto& s = *measured[i].spread;
    fmt::print("{:<{}} {:>8} {:>8.2f}", classification.classes[i].name, width, s.members, 100 * s.sigma);
    for (const double p : s.phase) fmt::print(" {:>8.2f}", 100 * p);
    fmt::print(" {:>8.2f}\n", 100 * s.noise);
  }
}

}  // namespace

int verb_originals(const OriginalsOptions& options, Progress& progress) {
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  Scene scene = read_scene(options.scene);
  if (options.policy)
    for (auto& entry : scene.plants) entry.policy_file = *options.policy;
  const Classification classification = classify(scene, read_policies(scene));
  for (const auto& note : scene.notes) progress.line("note: " + note);
  for (const auto& note : classification.notes) progress.line("note: " + note);

  std::vector<Measured> measured;
  if (options.tables) {
    OriginalCache cache(options.no_cache ? std::string{} : options.cache.value_or(default_cache_folder()), options.cache_limit_mib << 20,
                        progress);
    for (const auto& c : classification.classes) {
      MeasureSettings settings;
      settings.tables = c.tables;
      const Stopwatch watch;
      Measured one;
      one.tables = cache.tables(original_geometry(scene, c), settings, one.state);
      progress.line(fmt::format("{}: {} facets, {} rays, {:.1f} s, cache: {}", c.name, c.facets,
                                one.state == CacheState::found ? 0 : one.tables.rays, watch.seconds(), name_of(one.state)));
      if (options.spread > 0 && c.likeness == Likeness::policy) one.spread = class_spread(scene, c, options.spread, 0.01, progress);
      measured.push_back(std::move(one));
    }
  }
  if (options.json) {
    fmt::print("{}\n", json_text(json_of(scene, classification, measured)));
  } else {
    print_classes(scene, classification);
    print_tables(scene, classification, measured);
    print_spread(scene, classification, measured);
  }
  return 0;
}

}  // namespace sunfleck
