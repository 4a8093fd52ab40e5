#include <sunfleck/scene/sensor.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

namespace {

/// Where a horizontal sensor lies.
struct Extent {
  double x, y, width, depth;
};

class SensorPlacing {
 public:
  SensorPlacing(const Scene& scene, const Box& bounds) : scene_(scene), bounds_(bounds) {}

  PlacedSensor operator()(const SensorEntry& entry) {
    key_ = "sensor." + entry.name;
    PlacedSensor out{&entry, {}};
    if (const auto* grid = std::get_if<SensorGrid>(&entry.shape)) {
      add_grid(*grid, out.cells);
    } else if (const auto* profile = std::get_if<SensorProfile>(&entry.shape)) {
      add_profile(*profile, out.cells);
    } else {
      const auto& mesh = std::get<Mesh>(entry.shape);
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle c = mesh.corners(t);
        out.cells.push_back({c[0], c[1] - c[0], c[2] - c[0], true});
      }
    }
    return out;
  }

 private:
  [[noreturn]] void fail(const char* what, const std::string& found, const std::string& expected) const {
    throw InputError(location(scene_.file, 0, key_ + "." + what), found, expected);
  }

  Extent extent(const std::optional<std::array<double, 2>>& size, const std::optional<std::array<double, 2>>& centre) const {
    std::array<double, 2> s, c{0.0, 0.0};
    if (scene_.periodic) {
      s = {scene_.periodic->width(), scene_.periodic->depth()};
      c = {0.5 * (scene_.periodic->x_low + scene_.periodic->x_high), 0.5 * (scene_.periodic->y_low + scene_.periodic->y_high)};
    } else if (scene_.ground && !scene_.ground->mesh) {
      s = scene_.ground->size;
      c = scene_.ground->centre;
    } else if (!bounds_.empty()) {
      s = {bounds_.size().x, bounds_.size().y};
      c = {bounds_.centre().x, bounds_.centre().y};
    } else if (!size) {
      fail("size", "nothing, in a scene without plants, ground or periodic cell", "[along x, along y] [m]");
    }
    if (size) s = *size;
    if (centre) c = *centre;
    if (!(s[0] > 0.0 && s[1] > 0.0)) fail("size", fmt::format("[{}, {}]", s[0], s[1]), "lengths above zero [m]");
    return {c[0] - 0.5 * s[0], c[1] - 0.5 * s[1], s[0], s[1]};
  }

  void add_grid(const SensorGrid& grid, std::vector<Patch>& cells) const {
    const auto e = extent(grid.size, grid.centre);
    const auto [columns, rows] = grid.cells;
    const Vec3 u{e.width / columns, 0.0, 0.0}, v{0.0, e.depth / rows, 0.0};
    for (std::uint32_t j = 0; j < rows; ++j)
      for (std::uint32_t i = 0; i < columns; ++i)
        cells.push_back({Vec3{e.x + e.width * i / columns, e.y + e.depth * j / rows, grid.z}, u, v, false});
  }

  void add_profile(const SensorProfile& profile, std::vector<Patch>& cells) const {
    const auto e = extent(profile.size, profile.centre);
    if (bounds_.empty() && !(profile.low && profile.high))
      fail("profile", "no `low` or no `high`, in a scene without plants or ground", "both [m]");
    const double low = profile.low.value_or(bounds_.low.z), high = profile.high.value_or(bounds_.high.z);
    if (!(high >= low)) fail("profile", fmt::format("heights from {} to {}", low, high), "`high` not below `low`");
    // the last height is the first one at or above the top
    const double steps = std::ceil((high - low) / profile.step - 1e-9);
    constexpr double most = 100000;
    if (!(steps < most))
      fail("profile.step", fmt::format("{} m for heights from {} to {}", profile.step, low, high),
           fmt::format("a step that makes at most {} heights", most));
    for (int i = 0; i <= static_cast<int>(steps); ++i)
      cells.push_back({Vec3{e.x, e.y, low + i * profile.step}, Vec3{e.width, 0.0, 0.0}, Vec3{0.0, e.depth, 0.0}, false});
  }

  const Scene& scene_;
  const Box& bounds_;
  std::string key_;
};

}  // namespace

const char* kind_of(const SensorEntry& sensor) {
  constexpr const char* kinds[] = {"grid", "profile", "mesh"};
  return kinds[sensor.shape.index()];
}

Vec3 Patch::point(double x, double y) const {
  if (!triangle) return corner + x * u + y * v;
  const double root = std::sqrt(x);
  return corner + root * (1.0 - y) * u + root * y * v;
}

Vec3 Patch::centroid() const {
  return corner + (triangle ? 1.0 / 3.0 : 0.5) * (u + v);
}

double Patch::area() const {
  return (triangle ? 0.5 : 1.0) * glm::length(glm::cross(u, v));
}

Vec3 Patch::normal() const {
  const Vec3 n = glm::cross(u, v);
  const double length = glm::length(n);
  return length > 0.0 ? n / length : Vec3{0.0};
}

std::vector<PlacedSensor> place_sensors(const Scene& scene, const Box& bounds) {
  SensorPlacing place(scene, bounds);
  std::vector<PlacedSensor> out;
  for (const auto& entry : scene.sensors) out.push_back(place(entry));
  return out;
}

}  // namespace sunfleck
