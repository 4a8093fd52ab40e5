// Lamps and sensors for small scenes in memory.
#pragma once

#include <cmath>
#include <numbers>

#include <radiosity_runs.hpp>

namespace lamp_runs {

using namespace radiosity_runs;
using reference_runs::trace;

inline constexpr double pi = std::numbers::pi;

/// A rectangle that looks down.
inline Mesh panel(double x0, double y0, double x1, double y1, double z) {
  return {{{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// A regular polygon of n corners that looks down, about the z axis.
inline Mesh disc(double radius, double z, int n) {
  Mesh mesh{{{0, 0, z}}, {}};
  for (int i = 0; i < n; ++i) mesh.vertices.push_back({radius * std::cos(2 * pi * i / n), radius * std::sin(2 * pi * i / n), z});
  for (int i = 0; i < n; ++i)
    mesh.triangles.push_back({0u, static_cast<std::uint32_t>((i + 1) % n + 1), static_cast<std::uint32_t>(i + 1)});
  return mesh;
}

inline void lamp(Scene& scene, Mesh mesh, double exitance) {
  LampEntry entry;
  entry.name = "lamp";
  entry.mesh = std::move(mesh);
  entry.strength.assign(scene.bands.size(), exitance);
  entry.placements.push_back({});
  scene.lamps.push_back(std::move(entry));
}

inline void grid(Scene& scene, const std::string& name, double z, std::array<std::uint32_t, 2> cells,
                 std::optional<std::array<double, 2>> size = {}, std::optional<std::array<double, 2>> centre = {}) {
  scene.sensors.push_back({name, SensorGrid{z, cells, size, centre}, false, 0});
}

/// Two opposite unit squares at distance 1 (Howell, catalogue C-11): 0.1998.
inline double opposite_squares(double x, double y) {
  const double a = 1 + x * x, b = 1 + y * y;
  return 2 / (pi * x * y) *
         (std::log(std::sqrt(a * b / (a + b - 1))) + x * std::sqrt(b) * std::atan(x / std::sqrt(b)) +
          y * std::sqrt(a) * std::atan(y / std::sqrt(a)) - x * std::atan(x) - y * std::atan(y));
}

}  // namespace lamp_runs
