#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/view/export.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t rows_at_once = 16384;

/// Quoted where RFC 4180 wants it.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

bool photons(const std::string& unit) {
  return unit.find("mol") != std::string::npos;
}

/// Values of a block of organs in one state; empty where the file does not keep them.
struct Block {
  std::vector<float> absorbed, irradiance, sunlit;
};

}  // namespace

void export_csv(const Result& result, const std::string& file, Progress& progress) {
  const std::size_t m = result.organ_count(), bands = result.bands().size(), states = result.states().size();
  const bool absorbed = result.has("organs/absorbed"), irradiance = result.has("organs/irradiance"), sunlit = result.has("organs/sunlit");
  if (!absorbed && !irradiance && !sunlit)
    throw InputError(location(result.file(), 0, "/organs"), "no values", "some; [output] fields of the scene left them out");
  const bool sums =
      absorbed && std::all_of(result.states().begin(), result.states().end(), [](const LightState& s) { return s.duration_s > 0; });
  const OrganTable organs = result.organs();
  const auto area = result.rows<float>("organs/area", 0, m);

  ReplacedFile out(file);
  fmt::memory_buffer text;
  const auto put = std::back_inserter(text);
  fmt::format_to(put, "organ,plant,placement,name,type,area_m2");
  for (std::size_t s = 0; s < states; ++s) {
    const std::string suffix = states > 1 ? "_" + result.states()[s].name : "";
    const auto column = [&](const std::string& name) { fmt::format_to(put, ",{}", field(name + suffix)); };
    for (std::size_t b = 0; b < bands; ++b) {
      const std::string& band = result.bands()[b];
      if (absorbed) column((photons(result.band_units()[b]) ? "absorbed_umol_s_" : "absorbed_W_") + band);
      if (irradiance) column("irradiance_front_" + band), column("irradiance_back_" + band);
    }
    if (sunlit) column("sunlit_front"), column("sunlit_back");
  }
  if (sums)
    for (std::size_t b = 0; b < bands; ++b)
      fmt::format_to(put, ",{}", field((photons(result.band_units()[b]) ? "absorbed_umol_" : "absorbed_J_") + result.bands()[b]));
  text.push_back('\n');

  std::vector<double> sum(bands);
  for (std::size_t first = 0; first < m; first += rows_at_once) {
    progress.check();
    const std::size_t count = std::min(rows_at_once, m - first);
    std::vector<Block> blocks(states);
    for (std::size_t s = 0; s < states; ++s) {
      if (absorbed) blocks[s].absorbed = result.state_rows<float>("organs/absorbed", s, first, count);
      if (irradiance) blocks[s].irradiance = result.state_rows<float>("organs/irradiance", s, first, count);
      if (sunlit) blocks[s].sunlit = result.state_rows<float>("organs/sunlit", s, first, count);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t o = first + i;
      fmt::format_to(put, "{},{},{},{},{},{}", o, field(organs.plants[organs.plant[o]]), field(organs.placements[organs.placement[o]]),
                     field(organs.names[organs.name[o]]), field(organs.types[organs.type[o]]), area[o]);
      std::fill(sum.begin(), sum.end(), 0.0);
      for (std::size_t s = 0; s < states; ++s) {
        for (std::size_t b = 0; b < bands; ++b) {
          if (absorbed) {
            const float power = blocks[s].absorbed[i * bands + b];
            sum[b] += double{power} * result.states()[s].duration_s;
            fmt::format_to(put, ",{}", power);
          }
          if (irradiance)
            fmt::format_to(put, ",{},{}", blocks[s].irradiance[2 * i * bands + b], blocks[s].irradiance[(2 * i + 1) * bands + b]);
        }
        if (sunlit) fmt::format_to(put, ",{},{}", blocks[s].sunlit[2 * i], blocks[s].sunlit[2 * i + 1]);
      }
      if (sums)
        for (std::size_t b = 0; b < bands; ++b) fmt::format_to(put, ",{}", static_cast<float>(sum[b]));
      text.push_back('\n');
    }
    out.write(text.data(), text.size());
    text.clear();
    progress.fraction("export", static_cast<double>(first + count) / static_cast<double>(m));
  }
  out.commit();
}

}  // namespace sunfleck
