// Physics at the door, for scenes from files and from memory alike.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/extent.hpp>
#include <sunfleck/scene/slope.hpp>

#include "scene/check_devices.hpp"
#include "scene/check_reach.hpp"

namespace sunfleck {

namespace {

class Check {
 public:
  explicit Check(const Scene& scene) : scene_(scene) {}

  void run() const {
    bands();
    names();
    light();
    for (const auto& optics : scene_.optics) optical(optics, "optics." + optics.name);
    if (scene_.periodic) cell(*scene_.periodic);
    if (scene_.ground) ground(*scene_.ground);
    plants();
    groups();
    group_depth();
    check_reach(scene_);
    check_lamps(scene_);
    check_sensors(scene_);
    check_extent(scene_);
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected) const {
    throw InputError(location(scene_.file, 0, key), found, expected);
  }

  void bands() const {
    if (scene_.bands.empty()) fail("bands", "none", "at least one band");
    std::set<std::string> seen;
    for (const auto& band : scene_.bands)
      if (band.empty() || !seen.insert(band).second) fail("bands", '"' + band + (band.empty() ? "\"" : "\" twice"), "names, each once");
    if (!scene_.band_units.empty() && scene_.band_units.size() != scene_.bands.size())
      fail("band_units", fmt::format("{} units", scene_.band_units.size()), fmt::format("one per band, {}", scene_.bands.size()));
  }

  void zero_or_more(double value, double most, const std::string& unit, const std::string& key) const {
    if (!(value >= 0) || std::isinf(value)) fail(key, fmt::format("{}", value), "a finite number of zero or more" + unit);
    if (value > most) fail(key, fmt::format("{}", value), fmt::format("at most {:g}{}", most, unit));
  }

  void irradiance(const std::vector<double>& values, const std::string& key) const {
    if (values.size() != scene_.bands.size())
      fail(key, fmt::format("{} values", values.size()), fmt::format("one per band, {}", scene_.bands.size()));
    for (std::size_t b = 0; b < values.size(); ++b) zero_or_more(values[b], brightest, "", key + "." + scene_.bands[b]);
  }

  void light() const {
    if (scene_.states.empty()) fail("states", "none", "at least one lighting state");
    for (std::size_t s = 0; s < scene_.states.size(); ++s) {
      const auto& state = scene_.states[s];
      const std::string key = fmt::format("state[{}]", s);
      zero_or_more(state.duration_s, longest_duration_s, " seconds", key + ".duration_s");
      if (state.sun) {
        const auto& sun = *state.sun;
        if (!(std::abs(glm::length(sun.direction) - 1.0) < 1e-6))
          fail(key + ".sun.direction", fmt::format("a vector of length {}", glm::length(sun.direction)), "a unit vector");
        if (!(sun.direction.z > 0)) fail(key + ".sun.direction", "a sun at or below the horizon", "no sun, or one above the horizon");
        if (!(sun.angular_diameter_deg >= 0 && sun.angular_diameter_deg <= 90))
          fail(key + ".sun.angular_diameter_deg", fmt::format("{}", sun.angular_diameter_deg), "0 to 90 degrees");
        irradiance(sun.irradiance, key + ".sun.irradiance");
      }
      if (!state.sky) continue;
      irradiance(state.sky->irradiance, key + ".sky.irradiance");
      if (state.sky->model == SkyModel::file && !state.sky->table)
        fail(key + ".sky", "a sky of directions without any", "a table of directions and radiances");
      if (state.sky->model == SkyModel::image && !state.sky->image)
        fail(key + ".sky", "a sky of a picture without any", "a picture of the sky");
      const std::string name = name_of(state.sky->model);
      if (state.sky->needs_sun() && !state.sky->sun)
        fail(key + ".sky", "a " + name + " sky without a sun", "the direction of the sun, about which it is built");
      if (!is_prepared(*state.sky))
        fail(key + ".sky", "a " + name + " sky that is not prepared", "a call of prepare_sky(), which solve() makes");
    }
  }

  void optical(const Optics& optics, const std::string& key) const {
    const auto values = [&](const std::vector<float>& v, const char* name) {
      if (v.size() != scene_.bands.size())
        fail(key + "." + name, fmt::format("{} values", v.size()), fmt::format("one per band, {}", scene_.bands.size()));
      for (std::size_t b = 0; b < v.size(); ++b)
        if (!(v[b] >= 0 && v[b] <= 1)) fail(key + "." + name + "." + scene_.bands[b], fmt::format("{}", v[b]), "a number from 0 to 1");
    };
    values(optics.reflectance_front, "reflectance_front");
    values(optics.reflectance_back, "reflectance_back");
    values(optics.transmittance, "transmittance");
    for (std::size_t b = 0; b < scene_.bands.size(); ++b)
      for (const auto* rho : {&optics.reflectance_front, &optics.reflectance_back})
        if ((*rho)[b] + optics.transmittance[b] > 1.0f + rounding)
          fail(key + "." + scene_.bands[b],
               fmt::format("reflectance {} + transmittance {} = {:.6g}", (*rho)[b], optics.transmittance[b],
                           (*rho)[b] + optics.transmittance[b]),
               "a sum of at most 1");
  }

  void cell(const PeriodicCell& cell) const {
    for (const double v : {cell.x_low, cell.y_low, cell.x_high, cell.y_high}) near(v, "domain.periodic");
    if (!(cell.width() > 0 && cell.depth() > 0))
      fail("domain.periodic", fmt::format("a cell of {} by {} m", cell.width(), cell.depth()), "lengths above zero");
    if (!(std::hypot(cell.slope_x, cell.slope_y) <= steepest_slope))
      fail("domain.slope", fmt::format("[{}, {}]", cell.slope_x, cell.slope_y), fmt::format("a slope of at most {:g}", steepest_slope));
    if (!cell.is_level() && !scene_.lamps.empty())
      fail("domain.slope", "lamps over a slope without end", "sun and sky alone: their images on slopes are not followed");
  }

  void ground(const Ground& ground) const {
    optical(ground.optics, "ground.optics");
    for (const float tau : ground.optics.transmittance)
      if (tau != 0) fail("ground.optics.transmittance", fmt::format("{}", tau), "0: ground lets nothing through");
    if (ground.mesh) {
      check_mesh(*ground.mesh, location(scene_.file, 0, "ground.mesh"));
      for (const auto& p : ground.mesh->vertices)
        for (int axis = 0; axis < 3; ++axis) near(p[axis], "ground.mesh");
      if (ground.mesh->triangles.empty()) fail("ground.mesh", "no face", "at least one triangle");
    } else {
      for (const double v : {ground.size[0], ground.size[1]})
        if (!(v > 0 && v <= 2 * farthest_coordinate))
          fail("ground.size", fmt::format("{}", v), fmt::format("a length above zero and up to {:g} m", 2 * farthest_coordinate));
      for (const double v : {ground.centre[0], ground.centre[1]}) near(v, "ground.center");
      near(ground.height, "ground.height");
      if (ground.cells[0] == 0 || ground.cells[1] == 0) fail("ground.cells", "0", "at least one cell along x and y");
    }
    if (scene_.periodic) check_ground_fills(ground, *scene_.periodic, location(scene_.file, 0, "ground"));
  }

  void near(double v, const std::string& key) const {
    if (!(std::abs(v) <= farthest_coordinate))
      fail(key, fmt::format("{}", v), fmt::format("coordinates from {:g} to {:g} m", -farthest_coordinate, farthest_coordinate));
  }

  /// What names of the scene must be, so that every output holds them on one line.
  void name(const std::string& name, const std::string& key) const {
    if (!is_utf8(name)) fail(key, '"' + as_utf8(name) + "\", in bytes that are no UTF-8", "UTF-8");
    if (has_control_character(name)) fail(key, '"' + clean_name(name) + "\" with a control character", "a name on one line of text");
  }

  void names() const {
    for (const auto& band : scene_.bands) name(band, "bands");
    for (std::size_t s = 0; s < scene_.states.size(); ++s) name(scene_.states[s].name, fmt::format("state[{}].name", s));
    for (const auto& optics : scene_.optics) name(optics.name, "optics");
    for (std::size_t l = 0; l < scene_.lamps.size(); ++l) name(scene_.lamps[l].name, fmt::format("lamp[{}].name", l));
    for (std::size_t i = 0; i < scene_.sensors.size(); ++i) name(scene_.sensors[i].name, fmt::format("sensor[{}].name", i));
    const auto own = [&](const std::string& given, const std::string& key) {
      name(given, key);
      if (scene_.ground && given == "ground") fail(key, "\"ground\"", "another name: results call the scene's ground so");
    };
    for (std::size_t p = 0; p < scene_.plants.size(); ++p) own(scene_.plants[p].name, fmt::format("plant[{}].name", p));
    for (std::size_t g = 0; g < scene_.groups.size(); ++g) own(scene_.groups[g].name, fmt::format("group[{}].name", g));
  }

  void names_of(const Plant& plant, const std::string& key) const {
    for (const auto* list : {&plant.types, &plant.attribute_names, &plant.materials})
      for (const auto& text : *list) name(text, key);
    for (const auto& structure : plant.structures) {
      name(structure.name, key);
      for (const auto& [attribute, value] : structure.attributes)
        if (const auto* text = std::get_if<std::string>(&value)) name(*text, key);
    }
    if (!scene_.ground) return;
    for (const auto& shape : plant.shapes)
      if (plant.types[plant.structures[shape.structure].type] == "ground")
        fail(key, fmt::format("an organ of type \"ground\"{}", plant.file.empty() ? "" : " in " + plant.file),
             "another type: results call the scene's ground so");
  }

  void placement(const Placement& placement, const std::string& key) const {
    const auto& map = placement.map;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        if (!std::isfinite(map.linear[c][r]) || !std::isfinite(map.translation[r])) fail(key, "a map that is not finite", "finite numbers");
    if (glm::determinant(map.linear) == 0) fail(key, "a map that flattens the copy", "one that can be inverted");
  }

  void plants() const {
    std::set<const Plant*> checked;
    for (std::size_t p = 0; p < scene_.plants.size(); ++p) {
      const auto& entry = scene_.plants[p];
      const std::string key = fmt::format("plant[{}]", p);
      if (!entry.plant) fail(key, "no plant", "a plant");
      if (checked.insert(entry.plant.get()).second) check_plant(*entry.plant), names_of(*entry.plant, key);
      if (entry.shape_optics.size() != entry.plant->shapes.size())
        fail(key + ".shape_optics", fmt::format("{} rows", entry.shape_optics.size()),
             fmt::format("one per shape, {}", entry.plant->shapes.size()));
      for (const auto row : entry.shape_optics)
        if (row >= scene_.optics.size())
          fail(key + ".shape_optics", fmt::format("row {}", row), fmt::format("a row of the scene's {} optics", scene_.optics.size()));
      for (std::size_t i = 0; i < entry.placements.size(); ++i) placement(entry.placements[i], fmt::format("{}.place[{}]", key, i));
    }
  }

  void groups() const {
    for (std::size_t g = 0; g < scene_.groups.size(); ++g) {
      const auto& group = scene_.groups[g];
      const std::string key = fmt::format("group[{}]", g);
      if (group.members.empty()) fail(key, "no member", "at least one plant or group");
      for (std::size_t i = 0; i < group.members.size(); ++i) {
        const auto& member = group.members[i];
        const std::size_t rows = member.is_group ? scene_.groups.size() : scene_.plants.size();
        const std::string member_key = fmt::format("{}.place[{}]", key, i);
        if (member.index >= rows)
          fail(member_key, fmt::format("{} number {}", member.is_group ? "group" : "plant", member.index),
               fmt::format("a number below {}", rows));
        placement(member.placement, member_key);
      }
      for (std::size_t i = 0; i < group.placements.size(); ++i)
        placement(group.placements[i], fmt::format("{} in the world, copy {}", key, i));
    }
    const auto cycle = group_cycle(scene_);
    if (cycle.empty()) return;
    std::string text;
    for (const auto g : cycle) text += (text.empty() ? "\"" : " -> \"") + scene_.groups[g].name + '"';
    fail(fmt::format("group[{}]", cycle.front()), "a group that holds itself: " + text, "groups without a circle");
  }

  /// Groups are walked by recursion: a chain of very many would overflow the stack.
  void group_depth() const {
    constexpr int deepest = 1000;
    std::vector<int> height(scene_.groups.size(), 1);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> inside;  // group, and a group that it holds
    for (std::uint32_t g = 0; g < scene_.groups.size(); ++g)
      for (const auto& member : scene_.groups[g].members)
        if (member.is_group) inside.emplace_back(g, member.index);
    std::sort(inside.begin(), inside.end());
    inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [outer, inner] : inside)
        if (height[outer] <= height[inner]) {
          height[outer] = height[inner] + 1;
          changed = true;
          if (height[outer] > deepest)
            fail(fmt::format("group[{}]", outer), fmt::format("more than {} groups inside each other", deepest), "fewer levels");
        }
    }
  }

  static constexpr float rounding = 1e-6f;  ///< of values such as 0.45 + 0.55 in single precision
  const Scene& scene_;
};

}  // namespace

void check_ground_fills(const Ground& ground, const PeriodicCell& cell, const std::string& where) {
  Box box;
  if (ground.mesh) {
    for (const auto& t : ground.mesh->triangles)
      for (const auto i : t) box.add(ground.mesh->vertices[i]);
  } else {
    const Vec3 centre{ground.centre[0], ground.centre[1], ground.height}, half{0.5 * ground.size[0], 0.5 * ground.size[1], 0.0};
    box.add(centre - half);
    box.add(centre + half);
  }
  // Meshes may come in single precision and in other units: 1e-5 of the cell is their rounding, not a gap.
  const double near = 1e-5 * std::max(cell.width(), cell.depth());
  if (std::abs(box.low.x - cell.x_low) <= near && std::abs(box.high.x - cell.x_high) <= near && std::abs(box.low.y - cell.y_low) <= near &&
      std::abs(box.high.y - cell.y_high) <= near)
    return;
  throw InputError(where, fmt::format("ground from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g})", box.low.x, box.low.y, box.high.x, box.high.y),
                   fmt::format("ground that fills the periodic cell, ({:.6g}, {:.6g}) to ({:.6g}, {:.6g})", cell.x_low, cell.y_low,
                               cell.x_high, cell.y_high));
}

void check_scene(const Scene& scene) {
  Check(scene).run();
}

}  // namespace sunfleck
