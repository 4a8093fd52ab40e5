#include "scene/check_devices.hpp"

#include <cmath>
#include <set>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include "scene/check_reach.hpp"

namespace sunfleck {

namespace {

[[noreturn]] void fail(const Scene& scene, const std::string& key, const std::string& found, const std::string& expected) {
  throw InputError(location(scene.file, 0, key), found, expected);
}

double mesh_area(const Mesh& mesh) {
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += glm::length(area_vector(mesh.corners(t)));
  return area;
}

void check_near(const Scene& scene, const std::string& key, const std::optional<double>& value) {
  if (value && !(std::abs(*value) <= farthest_coordinate))
    fail(scene, key, fmt::format("{}", *value), fmt::format("a number from {:g} to {:g} m", -farthest_coordinate, farthest_coordinate));
}

void check_extent(const Scene& scene, const std::string& key, const std::optional<std::array<double, 2>>& size,
                  const std::optional<std::array<double, 2>>& centre) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (size && !((*size)[i] > 0 && (*size)[i] <= 2 * farthest_coordinate))
      fail(scene, key + ".size", fmt::format("{}", (*size)[i]),
           fmt::format("a length above zero and up to {:g} m", 2 * farthest_coordinate));
    if (centre) check_near(scene, key + ".center", (*centre)[i]);
  }
}

}  // namespace

void check_lamps(const Scene& scene) {
  for (std::size_t l = 0; l < scene.lamps.size(); ++l) {
    const auto& lamp = scene.lamps[l];
    const std::string key = fmt::format("lamp[{}]", l);
    const std::string strength = key + (lamp.by_power ? ".power" : ".exitance");
    if (lamp.strength.size() != scene.bands.size())
      fail(scene, strength, fmt::format("{} values", lamp.strength.size()), fmt::format("one per band, {}", scene.bands.size()));
    for (std::size_t b = 0; b < lamp.strength.size(); ++b)
      if (!(lamp.strength[b] >= 0) || std::isinf(lamp.strength[b]))
        fail(scene, strength + "." + scene.bands[b], fmt::format("{}", lamp.strength[b]), "a finite number of zero or more");
      else if (lamp.strength[b] > brightest)
        fail(scene, strength + "." + scene.bands[b], fmt::format("{}", lamp.strength[b]), fmt::format("at most {:g}", brightest));
    if (lamp.photometry) {
      if (!lamp.by_power) fail(scene, key + ".exitance", "an exitance of a photometric file", "the power of the lamp");
      if (!(lamp.photometry->per_candela > 0))
        fail(scene, key + ".ies", "a photometry that is not prepared", "prepare_photometry() before");
    } else {
      check_mesh(lamp.mesh, location(scene.file, 0, key + ".mesh"));
      check_reach(scene, key + ".mesh", reach_of(lamp.mesh));
      const double area = mesh_area(lamp.mesh);
      if (!(area > 0) || std::isinf(area)) fail(scene, key + ".mesh", fmt::format("faces of {} m2 in all", area), "an area above zero");
    }
    if (lamp.placements.empty()) fail(scene, key + ".place", "no place", "at least one");
    for (std::size_t i = 0; i < lamp.placements.size(); ++i) {
      const auto& map = lamp.placements[i].map;
      const std::string at = fmt::format("{}.place[{}]", key, i);
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
          if (!std::isfinite(map.linear[c][r]) || !std::isfinite(map.translation[r]))
            fail(scene, at, "a map that is not finite", "finite numbers");
      check_reach(scene, at, reach_of(map, reach_of(lamp.mesh)));
      const double volume = std::abs(glm::determinant(map.linear));
      if (!(volume > 0)) fail(scene, at, "a map that flattens the copy", "one that can be inverted");
      if (!lamp.photometry) continue;
      // intensities belong to directions, which a stretch would mix
      const double scale = std::cbrt(volume);
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r <= c; ++r)
          if (std::abs(glm::dot(map.linear[c], map.linear[r]) / (scale * scale) - (c == r)) > 1e-6)
            fail(scene, at, "a map that stretches a photometric lamp", "turns, mirrors and one scale");
    }
    for (const auto s : lamp.states)
      if (s >= scene.states.size())
        fail(scene, key + ".states", fmt::format("state number {}", s), fmt::format("a number below {}", scene.states.size()));
  }
}

void check_sensors(const Scene& scene) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const auto& sensor = scene.sensors[i];
    const std::string key = fmt::format("sensor[{}]", i);
    if (sensor.name.empty() || sensor.name.find('/') != std::string::npos || sensor.name == "." || sensor.name == "..")
      fail(scene, key + ".name", '"' + sensor.name + '"', "a name without \"/\", under which the result can keep it");
    if (!names.insert(sensor.name).second) fail(scene, key + ".name", '"' + sensor.name + "\" twice", "a name of its own for every sensor");
    if (const auto* grid = std::get_if<SensorGrid>(&sensor.shape)) {
      check_near(scene, key + ".grid.z", grid->z);
      if (grid->cells[0] == 0 || grid->cells[1] == 0) fail(scene, key + ".grid.cells", "0", "at least one cell along x and y");
      if (std::uint64_t{grid->cells[0]} * grid->cells[1] > 10'000'000)
        fail(scene, key + ".grid.cells", fmt::format("{} cells", std::uint64_t{grid->cells[0]} * grid->cells[1]), "at most 10000000");
      check_extent(scene, key + ".grid", grid->size, grid->centre);
    } else if (const auto* profile = std::get_if<SensorProfile>(&sensor.shape)) {
      if (!(profile->step > 0 && profile->step <= farthest_coordinate))
        fail(scene, key + ".profile.step", fmt::format("{}", profile->step),
             fmt::format("a length above zero and up to {:g} m", farthest_coordinate));
      check_near(scene, key + ".profile.low", profile->low);
      check_near(scene, key + ".profile.high", profile->high);
      check_extent(scene, key + ".profile", profile->size, profile->centre);
    } else {
      const auto& mesh = std::get<Mesh>(sensor.shape);
      check_mesh(mesh, location(scene.file, 0, key + ".mesh"));
      check_reach(scene, key + ".mesh", reach_of(mesh));
      if (mesh.triangles.empty()) fail(scene, key + ".mesh", "no face", "at least one triangle");
    }
  }
}

}  // namespace sunfleck
