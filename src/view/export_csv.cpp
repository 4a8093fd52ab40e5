#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/view/export.hpp>

#include "view/organ_rows.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t lines_at_once = 16384;

}  // namespace

void export_csv(const Result& result, const std::string& file, Progress& progress) {
  const std::size_t m = result.organ_count(), bands = result.bands().size(), states = result.states().size();
  const KeptValues kept = kept_values(result, "organs");
  const OrganTexts names(result);

  ReplacedFile out(file);
  fmt::memory_buffer text;
  const auto put = std::back_inserter(text);
  text.append(header_line({"organ", "plant", "placement", "name", "type", "area_m2"}, result, kept));
  std::vector<double> sum(bands);
  for (std::size_t first = 0; first < m; first += lines_at_once) {
    progress.check();
    const std::size_t count = std::min(lines_at_once, m - first);
    const OrganBlock organs(result, names, first, count);
    const auto area = result.rows<float>("organs/area", first, count);
    std::vector<LightBlock> values;
    for (std::size_t s = 0; s < states; ++s) values.emplace_back(result, "organs", kept, s, first, count);
    for (std::size_t i = 0; i < count; ++i) {
      fmt::format_to(put, "{},{},{},{},{},{}", first + i, csv_field(names.plants[organs.plant[i]]),
                     csv_field(names.placements[organs.placement[i]]), csv_field(names.names[organs.name[i]]),
                     csv_field(names.types[organs.type[i]]), area[i]);
      std::fill(sum.begin(), sum.end(), 0.0);
      for (std::size_t s = 0; s < states; ++s) {
        for (std::size_t b = 0; b < bands; ++b) {
          if (kept.absorbed) {
            const float power = values[s].absorbed[i * bands + b];
            sum[b] += double{power} * result.states()[s].duration_s;
            fmt::format_to(put, ",{}", power);
          }
          if (kept.irradiance)
            fmt::format_to(put, ",{},{}", values[s].irradiance[2 * i * bands + b], values[s].irradiance[(2 * i + 1) * bands + b]);
        }
        if (kept.sunlit) fmt::format_to(put, ",{},{}", values[s].sunlit[2 * i], values[s].sunlit[2 * i + 1]);
      }
      if (kept.sums)
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
