#include "result/write_devices.hpp"

#include <cmath>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>

#include "result/band_units.hpp"

namespace sunfleck::h5 {

namespace {

class SensorWriter {
 public:
  SensorWriter(OutputFile& file, ArrayWriter& arrays, const Scene& scene) : file_(file), arrays_(arrays), scene_(scene) {}

  void write(hid_t parent, const SensorEntry& entry, const SensorReading& reading) {
    const Id group = make_group(file_, parent, entry.name.c_str());
    write_attribute(file_, group.get(), "kind", kind_of(entry));
    const std::vector<std::size_t> dims{scene_.states.size(), reading.cells.size(), scene_.band_count()};
    const auto values = [&](const char* name, const std::vector<float>& data) {
      if (data.size() != dims[0] * dims[1] * dims[2])
        throw Error(
            fmt::format("{}: sensor \"{}\" has {} values of {}", file_.path(), entry.name, data.size(), dims[0] * dims[1] * dims[2]));
      for (const float v : data)
        if (!std::isfinite(v)) throw Error(fmt::format("{}: sensor \"{}\" has a value that is not finite", file_.path(), entry.name));
      arrays_.write_states(group.get(), name, data.data(), dims, irradiance_unit(scene_));
    };
    values("irradiance", reading.irradiance);
    values("standard_error", reading.standard_error);
    if (entry.both_sides) {
      values("irradiance_back", reading.back);
      values("standard_error_back", reading.back_standard_error);
    }
    std::vector<float> area;
    std::vector<double> centroid, normal, height;
    for (const auto& cell : reading.cells) {
      const Vec3 c = cell.centroid(), n = cell.normal();
      area.push_back(static_cast<float>(cell.area()));
      centroid.insert(centroid.end(), {c.x, c.y, c.z});
      normal.insert(normal.end(), {n.x, n.y, n.z});
      height.push_back(c.z);
    }
    arrays_.write(group.get(), "area", area, "m^2");
    arrays_.write(group.get(), "centroid", centroid.data(), {reading.cells.size(), 3}, "m");
    arrays_.write(group.get(), "normal", normal.data(), {reading.cells.size(), 3}, "1");
    if (std::holds_alternative<SensorProfile>(entry.shape)) arrays_.write(group.get(), "height", height, "m");
    if (const auto* grid = std::get_if<SensorGrid>(&entry.shape))
      arrays_.write(group.get(), "cells", std::vector<std::uint32_t>{grid->cells[0], grid->cells[1]}, "1");
    arrays_.flush();
  }

 private:
  OutputFile& file_;
  ArrayWriter& arrays_;
  const Scene& scene_;
};

}  // namespace

void write_lamps(OutputFile& file, ArrayWriter& arrays, const Scene& scene) {
  if (scene.lamps.empty()) return;
  const Lamps placed = place_lamps(scene);
  const std::size_t lamps = scene.lamps.size(), bands = scene.band_count(), states = scene.states.size();
  std::vector<std::string> names;
  std::vector<std::uint32_t> copies;
  std::vector<double> power(lamps * bands, 0.0);
  std::vector<std::uint8_t> shines;
  for (const auto& lamp : scene.lamps) {
    names.push_back(lamp.name);
    copies.push_back(static_cast<std::uint32_t>(lamp.placements.size()));
  }
  for (const auto& unit : placed.units)
    for (std::size_t b = 0; b < bands; ++b) power[unit.entry * bands + b] += unit.power[b];
  for (std::size_t s = 0; s < states; ++s)
    for (std::size_t l = 0; l < lamps; ++l)
      shines.push_back(placed.set_of_state[s] != Lamps::none && placed.sets[placed.set_of_state[s]][l]);
  const Id group = make_group(file, file.id(), "lamps");
  arrays.write_strings(group.get(), "name", names);
  arrays.write(group.get(), "copies", copies, "1");
  arrays.write(group.get(), "power", power.data(), {lamps, bands}, power_unit(scene));
  arrays.write_states(group.get(), "shines", shines.data(), {states, lamps}, "1");
  arrays.flush();
}

void write_sensors(OutputFile& file, ArrayWriter& arrays, const Scene& scene, const std::vector<SensorReading>& readings) {
  if (scene.sensors.empty()) return;
  if (readings.size() != scene.sensors.size())
    throw Error(fmt::format("{}: only {} of {} sensors have values", file.path(), readings.size(), scene.sensors.size()));
  std::vector<std::string> names;
  for (const auto& sensor : scene.sensors) names.push_back(sensor.name);
  const Id list{H5Gopen2(file.id(), "names", H5P_DEFAULT)};
  file.check(static_cast<bool>(list));
  arrays.write_strings(list.get(), "sensor", names);
  arrays.flush();
  const Id group = make_group(file, file.id(), "sensors");
  SensorWriter writer(file, arrays, scene);
  for (std::size_t i = 0; i < readings.size(); ++i) writer.write(group.get(), scene.sensors[i], readings[i]);
}

}  // namespace sunfleck::h5
