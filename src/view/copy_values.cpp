#include <sunfleck/view/copy_values.hpp>

#include <algorithm>
#include <limits>
#include <span>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

#include "view/organ_rows.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t copies_at_once = 16384;
constexpr std::size_t names_in_message = 10;

/// Names of placed copies; the ground's placement is none.
std::uint32_t placement_row(const Result& result, const ResultGeometry& geometry, const OrganTexts& names,
                            const std::optional<std::string>& placement) {
  std::vector<std::string> copies = names.placements;
  if (!geometry.ground.triangles.empty()) copies.erase(std::remove(copies.begin(), copies.end(), "ground"), copies.end());
  if (copies.empty()) throw InputError(result.file(), "no plant, only ground", "a plant to write");
  const std::string some =
      joined({copies.begin(), copies.begin() + static_cast<std::ptrdiff_t>(std::min(copies.size(), names_in_message))}) +
      (copies.size() > names_in_message ? fmt::format(", ... ({} in all)", copies.size()) : "");
  if (!placement && copies.size() > 1) throw UsageError(fmt::format("--copy: found nothing; expected one of {}", some));
  const std::string name = placement.value_or(copies.front());
  if (std::find(copies.begin(), copies.end(), name) == copies.end()) {
    const std::string nearest = nearest_name(name, copies);
    throw UsageError(
        fmt::format("--copy: found '{}'; expected one of {}{}", name, some, nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
  }
  return static_cast<std::uint32_t>(std::find(names.placements.begin(), names.placements.end(), name) - names.placements.begin());
}

}  // namespace

CopyValues copy_values(const Result& result, const ResultGeometry& geometry, const std::optional<std::string>& placement,
                       Progress& progress) {
  const KeptValues kept = kept_values(result, "organs");
  const OrganTexts names(result);
  const std::uint32_t wanted = placement_row(result, geometry, names, placement);
  const std::size_t m = result.organ_count(), bands = result.bands().size(), states = result.states().size();

  CopyValues out;
  out.placement = names.placements[wanted];
  out.names = {"area_m2"};
  for (auto& name : value_names(result, kept, attribute_name)) out.names.push_back(std::move(name));
  bool found = false;
  for (std::size_t first = 0; first < m; first += copies_at_once) {
    progress.check();
    const std::size_t count = std::min(copies_at_once, m - first);
    const OrganBlock organs(result, names, first, count);
    if (std::find(organs.placement.begin(), organs.placement.end(), wanted) == organs.placement.end()) {
      if (found) break;  // organs of a copy follow one another
      continue;
    }
    const auto area = result.rows<float>("organs/area", first, count);
    std::vector<LightBlock> values;
    for (std::size_t s = 0; s < states; ++s) values.emplace_back(result, "organs", kept, s, first, count);
    for (std::size_t i = 0; i < count; ++i) {
      if (organs.placement[i] != wanted) continue;
      if (!found) {
        found = true;
        const std::string& plant = names.plants[organs.plant[i]];
        while (out.plant < geometry.plants.size() && geometry.plants[out.plant].name != plant) ++out.plant;
        if (out.plant == geometry.plants.size())
          throw InputError(location(result.file(), 0, "/organs/plant"), "\"" + plant + "\"", "a plant of /geometry/plant_name");
        const std::size_t structures = geometry.plants[out.plant].plant->structures.size();
        out.organ_names.assign(structures, {});
        out.values.assign(out.names.size(), std::vector<double>(structures, std::numeric_limits<double>::quiet_NaN()));
      }
      const auto structure = organs.structure[i];
      if (structure >= out.values[0].size())
        throw InputError(location(result.file(), 0, "/organs/structure"), "row " + std::to_string(structure),
                         "a row below " + std::to_string(out.values[0].size()));
      out.organ_names[structure] = names.names[organs.name[i]];
      std::size_t c = 0;
      const auto put = [&](double value) { out.values[c++][structure] = value; };
      put(area[i]);
      std::vector<double> energy(bands, 0.0);
      for (std::size_t s = 0; s < states; ++s) {
        for (std::size_t b = 0; b < bands; ++b) {
          if (kept.absorbed) {
            put(values[s].absorbed[i * bands + b]);
            energy[b] += double{values[s].absorbed[i * bands + b]} * result.states()[s].duration_s;
          }
          if (kept.irradiance) put(values[s].irradiance[2 * i * bands + b]), put(values[s].irradiance[(2 * i + 1) * bands + b]);
        }
        if (kept.sunlit) put(values[s].sunlit[2 * i]), put(values[s].sunlit[2 * i + 1]);
      }
      if (kept.sums)
        for (const double e : energy) put(static_cast<float>(e));
    }
  }
  if (!found) throw InputError(location(result.file(), 0, "/organs/placement"), "no organ of " + out.placement, "at least one");
  return out;
}

}  // namespace sunfleck
