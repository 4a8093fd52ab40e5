#include "cli/info_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sunfleck/result/plant_shares.hpp>
#include <sunfleck/result/result_reader.hpp>

#include "cli/json_text.hpp"
#include "cli/solve_table.hpp"
#include <sunfleck/core/text_units.hpp>

namespace sunfleck {

namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string>& datasets() {
  static const std::vector<std::string> names{"facets/irradiance", "facets/absorbed", "facets/sunlit",     "facets/area",
                                              "facets/centroid",   "facets/organ",    "organs/irradiance", "organs/absorbed",
                                              "organs/sunlit",     "organs/area",     "variance/facets",   "variance/organs"};
  return names;
}

std::string shape_text(const std::vector<std::size_t>& dims) {
  return fmt::format("[{}]", fmt::join(dims, ", "));
}

/// Mean of a sensor's cells by area, in a state and band.
double sensor_mean(const StoredSensor& sensor, const std::vector<float>& values, std::size_t state, std::size_t band, std::size_t bands) {
  double sum = 0.0, area = 0.0;
  for (std::size_t k = 0; k < sensor.size(); ++k) {
    sum += double{sensor.area[k]} * values[(state * sensor.size() + k) * bands + band];
    area += sensor.area[k];
  }
  return area > 0.0 ? sum / area : 0.0;
}

void add_devices(const Result& r, Json& json) {
  const std::size_t bands = r.bands().size();
  for (const auto& lamp : r.lamps()) {
    Json row{{"name", lamp.name}, {"copies", lamp.copies}};
    for (std::size_t b = 0; b < bands; ++b) row["power"][r.bands()[b]] = lamp.power[b];
    for (const bool on : lamp.shines) row["shines"].push_back(on);
    json["lamps"].push_back(row);
  }
  for (const auto& sensor : r.sensors()) {
    Json row{{"name", sensor.name}, {"kind", sensor.kind}, {"cells", sensor.size()}};
    for (std::size_t s = 0; s < r.states().size(); ++s)
      for (std::size_t b = 0; b < bands; ++b) {
        row["mean"][r.bands()[b]].push_back(sensor_mean(sensor, sensor.reading.irradiance, s, b, bands));
        if (!sensor.reading.back.empty()) row["mean_back"][r.bands()[b]].push_back(sensor_mean(sensor, sensor.reading.back, s, b, bands));
      }
    json["sensors"].push_back(row);
  }
}

void print_devices(const Result& r) {
  const std::size_t bands = r.bands().size();
  for (const auto& lamp : r.lamps())
    fmt::print("lamp       {}: {}, {:g} {} in all\n", lamp.name, counted(lamp.copies, "copy", "copies"), fmt::join(lamp.power, " / "),
               r.band_units()[0] == "W m^-2" ? "W" : "umol/s");
  for (const auto& sensor : r.sensors()) {
    fmt::print("sensor     {}: {}, {}\n", sensor.name, sensor.kind, counted(sensor.size(), "cell", "cells"));
    for (std::size_t s = 0; s < r.states().size(); ++s)
      for (std::size_t b = 0; b < bands; ++b) {
        fmt::print("  {}{}: mean {:.5g}", r.states().size() > 1 ? r.states()[s].name + ", " : "", r.bands()[b],
                   sensor_mean(sensor, sensor.reading.irradiance, s, b, bands));
        if (!sensor.reading.back.empty()) fmt::print(", back {:.5g}", sensor_mean(sensor, sensor.reading.back, s, b, bands));
        fmt::print(" {}\n", r.band_units()[b]);
      }
  }
}

Json json_of(const Result& r) {
  const auto& header = r.header();
  Json json{{"file", r.file()},
            {"kind", "result"},
            {"method", header.method},
            {"status", header.status},
            {"software_version", header.software_version},
            {"scene_file", header.scene_file},
            {"scene_sha256", header.scene_sha256}};
  json["bands"] = Json::array();
  for (std::size_t b = 0; b < r.bands().size(); ++b) json["bands"].push_back({{"name", r.bands()[b]}, {"unit", r.band_units()[b]}});
  const auto balance = r.balance();
  json["states"] = Json::array();
  for (std::size_t s = 0; s < r.states().size(); ++s) {
    const auto& state = r.states()[s];
    Json row{{"name", state.name}, {"duration_s", state.duration_s}};
    if (state.sun)
      row["sun"] = {{"direction", {state.sun->direction.x, state.sun->direction.y, state.sun->direction.z}},
                    {"irradiance", state.sun->irradiance}};
    if (state.sky) row["sky"] = {{"model", name_of(state.sky->model)}, {"irradiance", state.sky->irradiance}};
    for (std::size_t b = 0; b < r.bands().size(); ++b) {
      const auto& x = balance[s][b];
      row["balance"][r.bands()[b]] = {{"incident", x.incident}, {"leaves", x.leaves},       {"ground", x.ground},
                                      {"escaped", x.escaped},   {"residual", x.residual()}, {"scattered_scale", x.scattered_scale}};
    }
    json["states"].push_back(row);
  }
  add_devices(r, json);
  if (const auto shares = plant_shares(r))
    for (std::size_t p = 0; p < shares->names.size(); ++p) {
      Json row{{"name", shares->names[p]}};
      for (std::size_t s = 0; s < shares->states; ++s)
        for (std::size_t b = 0; b < shares->bands; ++b) {
          row["leaf"][r.bands()[b]].push_back(shares->leaf[shares->at(s, p, b)]);
          row["other"][r.bands()[b]].push_back(shares->other[shares->at(s, p, b)]);
        }
      json["absorbed_by_plant"].push_back(row);
    }
  json["facets"] = r.facet_count();
  json["organs"] = r.organ_count();
  for (const auto& name : datasets())
    if (r.has(name)) json["datasets"][name] = r.shape(name);
  if (const auto c = r.certificate())
    json["certificate"] = {
        {"organs", c->organs.size()}, {"rmse", c->rmse}, {"rmse_low", c->rmse_low}, {"rmse_high", c->rmse_high}, {"bias", c->bias}};
  const auto convergence = r.convergence();
  if (!convergence.empty()) json["residual"] = convergence.back().residual;
  if (const auto radius = r.spectral_radius(); !radius.empty()) json["spectral_radius"] = radius;
  for (const auto& [name, value] : r.counts()) json["counts"][name] = value;
  for (const auto& [name, seconds] : r.timings()) json["timings_s"][name] = seconds;
  for (const auto& [name, bytes] : r.memory()) json["memory_bytes"][name] = bytes;
  return json;
}

void print_states(const Result& r) {
  for (std::size_t s = 0; s < r.states().size(); ++s) {
    const auto& state = r.states()[s];
    std::string light;
    if (state.sun)
      light += fmt::format("sun from ({:.3f}, {:.3f}, {:.3f}) {:g}", state.sun->direction.x, state.sun->direction.y, state.sun->direction.z,
                           fmt::join(state.sun->irradiance, " / "));
    if (state.sky)
      light += fmt::format("{}sky {} {:g}", light.empty() ? "" : ", ", name_of(state.sky->model), fmt::join(state.sky->irradiance, " / "));
    for (const auto& lamp : r.lamps())
      if (lamp.shines[s]) light += (light.empty() ? "" : ", ") + lamp.name;
    const std::string duration = state.duration_s > 0 ? fmt::format(", {:g} s", state.duration_s) : "";
    fmt::print("{:<11}{}: {}{}\n", s == 0 ? "states" : "", state.name.empty() ? "(no name)" : state.name, light.empty() ? "dark" : light,
               duration);
  }
}

}  // namespace

void print_result_info(const std::string& file, bool json) {
  const Result r(file);
  if (json) {
    fmt::print("{}\n", json_text(json_of(r)));
    return;
  }
  const auto& header = r.header();
  fmt::print("result     {}\nscene      {}\nmethod     {}, {} (Sunfleck {})\n", file,
             header.scene_file.empty() ? "made in memory" : header.scene_file, header.method, header.status, header.software_version);
  for (std::size_t b = 0; b < r.bands().size(); ++b) fmt::print("{:<11}{} in {}\n", b == 0 ? "bands" : "", r.bands()[b], r.band_units()[b]);
  print_states(r);
  print_devices(r);
  fmt::print("facets     {}\norgans     {}\n", r.facet_count() > 0 ? std::to_string(r.facet_count()) : "not kept", r.organ_count());
  for (const auto& name : datasets())
    if (r.has(name)) fmt::print("  {:<20} {}\n", name, shape_text(r.shape(name)));
  if (const auto convergence = r.convergence(); !convergence.empty())
    fmt::print("residual   {:.2e} after {}\n", convergence.back().residual, counted(convergence.size(), "iteration", "iterations"));
  if (const auto radius = r.spectral_radius(); !radius.empty())
    fmt::print("spectral radius of scattering {:.3f}\n", fmt::join(radius, " / "));
  for (const auto& [name, value] : r.counts()) fmt::print("  {:<20} {}\n", name, value);

  Scene scene;  // as much of it as the table shows
  scene.bands = r.bands();
  scene.band_units = r.band_units();
  scene.states = r.states();
  scene.periodic = r.periodic();
  SolveReport report;
  report.method = header.method;
  report.balance = r.balance();
  const auto certificate = r.certificate();
  fmt::print("\n");
  std::fflush(stdout);
  const auto shares = plant_shares(r);
  print_solve_table(scene, {}, report, certificate ? &*certificate : nullptr, shares ? &*shares : nullptr);

  fmt::print("\ntimings\n");
  for (const auto& [name, seconds] : r.timings()) fmt::print("  {:<28}{:>9.3f} s\n", name, seconds);
  fmt::print("memory\n");
  for (const auto& [name, bytes] : r.memory()) fmt::print("  {:<28}{:>11}\n", name, bytes_text(static_cast<double>(bytes)));
}

}  // namespace sunfleck
