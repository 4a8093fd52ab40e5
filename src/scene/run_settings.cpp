#include <sunfleck/scene/run_settings.hpp>

namespace sunfleck {

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

std::optional<Quality> quality_from_name(const std::string& name) {
  for (const auto known : {Quality::draft, Quality::standard, Quality::fine})
    if (name == name_of(known)) return known;
  return std::nullopt;
}

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names{"instantiation", "clustering", "flat", "direct", "lattice", "occlusion", "reference"};
  return names;
}

const std::vector<std::string>& output_fields() {
  static const std::vector<std::string> names{
      "facets/irradiance", "facets/absorbed", "facets/sunlit", "facets/area",     "facets/centroid", "facets/organ", "organs/irradiance",
      "organs/absorbed",   "organs/sunlit",   "organs/area",   "variance/facets", "variance/organs", "geometry"};
  return names;
}

RunSettings filled_up(RunSettings given, const RunSettings& defaults) {
  const auto fill = [](auto& value, const auto& other) {
    if (!value) value = other;
  };
  fill(given.method, defaults.method);
  // a wanted error takes the place of a quality, and the other way round
  if (!given.quality && given.error.empty()) given.quality = defaults.quality, given.error = defaults.error;
  fill(given.seed, defaults.seed);
  if (given.error.empty()) fill(given.certificate, defaults.certificate);  // a wanted error cannot do without
  fill(given.certificate_organs, defaults.certificate_organs);
  fill(given.certificate_rays, defaults.certificate_rays);
  fill(given.samples, defaults.samples);
  fill(given.lattice_mapping, defaults.lattice_mapping);
  fill(given.lattice_nodes, defaults.lattice_nodes);
  fill(given.occlusion_model, defaults.occlusion_model);
  if (given.depth.only.empty()) given.depth.only = defaults.depth.only;
  if (given.depth.stop_at.empty()) given.depth.stop_at = defaults.depth.stop_at;
  if (given.threads == 0) given.threads = defaults.threads;
  return given;
}

}  // namespace sunfleck
