#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/view/export.hpp>

#include "view/organ_rows.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t sensors_at_once = 16384;

std::vector<StoredSensor> chosen(const Result& result, const std::vector<std::string>& names) {
  auto all = result.sensors();
  if (all.empty()) throw InputError(location(result.file()), "no sensor", "a result of a scene with [[sensor]]");
  if (names.empty()) return all;
  std::vector<std::string> known;
  for (const auto& sensor : all) known.push_back(sensor.name);
  for (const auto& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string near = nearest_name(name, known);
      throw UsageError(fmt::format("--sensor: found '{}'; expected all, or some of {}{}", name, joined(known),
                                   near.empty() ? "" : " (did you mean '" + near + "'?)"));
    }
  std::erase_if(all, [&](const StoredSensor& sensor) { return std::find(names.begin(), names.end(), sensor.name) == names.end(); });
  return all;
}

/// Writes columns of a table: named once, then filled row by row.
class SensorTable {
 public:
  SensorTable(const Result& result, bool back) : bands_(result.bands().size()), back_(back) {
    const auto& states = result.states();
    for (const auto& state : states) {
      durations_.push_back(state.duration_s);
      const std::string suffix = states.size() > 1 ? "_" + state.name : "";
      for (const auto& band : result.bands())
        for (const char* side : {"", "_back"})
          if (*side == '\0' || back) {
            columns_.push_back(fmt::format("irradiance{}_{}{}", side, band, suffix));
            columns_.push_back(fmt::format("standard_error{}_{}{}", side, band, suffix));
          }
    }
    sums_ = std::all_of(durations_.begin(), durations_.end(), [](double d) { return d > 0; });
    if (!sums_) return;
    for (std::size_t b = 0; b < bands_; ++b)
      columns_.push_back((counts_photons(result.band_units()[b]) ? "exposure_umol_m2_" : "exposure_J_m2_") + result.bands()[b]);
  }

  std::string header() const {
    std::string text = "sensor,kind,cell,x,y,z,normal_x,normal_y,normal_z,area_m2";
    for (const auto& name : distinct_names(columns_, same_name)) text += "," + csv_field(name);
    return text + "\n";
  }

  void row(const StoredSensor& sensor, std::size_t k, fmt::memory_buffer& text) const {
    const auto put = std::back_inserter(text);
    const double *c = &sensor.centroid[3 * k], *n = &sensor.normal[3 * k];
    fmt::format_to(put, "{},{},{},{},{},{},{},{},{},{}", csv_field(sensor.name), sensor.kind, k, c[0], c[1], c[2], n[0], n[1], n[2],
                   sensor.area[k]);
    const auto& r = sensor.reading;
    for (std::size_t s = 0; s < durations_.size(); ++s)
      for (std::size_t b = 0; b < bands_; ++b) {
        const std::size_t at = (s * sensor.size() + k) * bands_ + b;
        fmt::format_to(put, ",{},{}", r.irradiance[at], r.standard_error[at]);
        if (!back_) continue;
        if (r.back.empty())
          fmt::format_to(put, ",,");
        else
          fmt::format_to(put, ",{},{}", r.back[at], r.back_standard_error[at]);
      }
    if (sums_)
      for (std::size_t b = 0; b < bands_; ++b) {
        double sum = 0.0;
        for (std::size_t s = 0; s < durations_.size(); ++s) sum += durations_[s] * r.irradiance[(s * sensor.size() + k) * bands_ + b];
        fmt::format_to(put, ",{}", static_cast<float>(sum));
      }
    text.push_back('\n');
  }

 private:
  std::size_t bands_;
  bool back_, sums_ = false;
  std::vector<double> durations_;
  std::vector<std::string> columns_;
};

}  // namespace

std::size_t export_sensors(const Result& result, const std::string& file, const std::vector<std::string>& names, Progress& progress) {
  const auto sensors = chosen(result, names);
  const SensorTable table(result, std::any_of(sensors.begin(), sensors.end(), [](const auto& s) { return !s.reading.back.empty(); }));
  std::size_t rows = 0;
  ReplacedFile out(file);
  const std::string header = table.header();
  out.write(header.data(), header.size());
  fmt::memory_buffer text;
  for (const auto& sensor : sensors)
    for (std::size_t first = 0; first < sensor.size(); first += sensors_at_once) {
      progress.check();
      const std::size_t end = std::min(sensor.size(), first + sensors_at_once);
      for (std::size_t k = first; k < end; ++k) table.row(sensor, k, text);
      out.write(text.data(), text.size());
      text.clear();
      rows += end - first;
    }
  out.commit();
  return rows;
}

}  // namespace sunfleck
