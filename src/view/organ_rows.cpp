#include "view/organ_rows.hpp"

#include <algorithm>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

KeptValues kept_values(const Result& result, const std::string& rows) {
  KeptValues kept{result.has(rows + "/absorbed"), result.has(rows + "/irradiance"), result.has(rows + "/sunlit"), false};
  if (!kept.absorbed && !kept.irradiance && !kept.sunlit)
    throw InputError(location(result.file(), 0, "/" + rows), "no values", "some; [output] fields of the scene left them out");
  kept.sums =
      kept.absorbed && std::all_of(result.states().begin(), result.states().end(), [](const LightState& s) { return s.duration_s > 0; });
  return kept;
}

OrganTexts::OrganTexts(const Result& result)
    : names(result.strings("names/organ")),
      types(result.strings("names/type")),
      plants(result.strings("names/plant")),
      placements(result.strings("names/placement")) {}

OrganBlock::OrganBlock(const Result& result, const OrganTexts& texts, std::size_t first_row, std::size_t rows)
    : first(first_row), count(rows) {
  const auto column = [&](const char* dataset, std::size_t below) {
    auto values = result.rows<std::uint32_t>(dataset, first, count);
    for (const auto v : values)
      if (v >= below)
        throw InputError(location(result.file(), 0, std::string("/") + dataset), "row " + std::to_string(v),
                         "a row below " + std::to_string(below));
    return values;
  };
  name = column("organs/name", texts.names.size());
  type = column("organs/type", texts.types.size());
  plant = column("organs/plant", texts.plants.size());
  placement = column("organs/placement", texts.placements.size());
  structure = result.rows<std::uint32_t>("organs/structure", first, count);
}

LightBlock::LightBlock(const Result& result, const std::string& rows, const KeptValues& kept, std::size_t state, std::size_t first,
                       std::size_t count) {
  if (kept.absorbed) absorbed = result.state_rows<float>(rows + "/absorbed", state, first, count);
  if (kept.irradiance) irradiance = result.state_rows<float>(rows + "/irradiance", state, first, count);
  if (kept.sunlit) sunlit = result.state_rows<float>(rows + "/sunlit", state, first, count);
}

bool counts_photons(const std::string& unit) {
  return unit.find("mol") != std::string::npos;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> value_names(const Result& result, const KeptValues& kept, ColumnNames::Clean clean) {
  const ColumnNames called(result, clean);
  const std::size_t bands = result.bands().size(), states = result.states().size();
  std::vector<std::string> names;
  for (std::size_t s = 0; s < states; ++s) {
    const std::string suffix = states > 1 ? "_" + called.states[s] : "";
    const auto column = [&](const std::string& name) { names.push_back(name + suffix); };
    for (std::size_t b = 0; b < bands; ++b) {
      const std::string& band = called.bands[b];
      if (kept.absorbed) column((counts_photons(result.band_units()[b]) ? "absorbed_umol_s_" : "absorbed_W_") + band);
      if (kept.irradiance) column("irradiance_front_" + band), column("irradiance_back_" + band);
    }
    if (kept.sunlit) column("sunlit_front"), column("sunlit_back");
  }
  if (kept.sums)
    for (std::size_t b = 0; b < bands; ++b)
      names.push_back((counts_photons(result.band_units()[b]) ? "absorbed_umol_" : "absorbed_J_") + called.bands[b]);
  return distinct_names(names, same_name);
}

std::string header_line(std::vector<std::string> first, const Result& result, const KeptValues& kept) {
  for (auto& name : value_names(result, kept)) first.push_back(std::move(name));
  std::string header;
  for (const auto& name : distinct_names(first, same_name)) header += (header.empty() ? "" : ",") + csv_field(name);
  return header + "\n";
}

}  // namespace sunfleck
