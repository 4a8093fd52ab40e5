#include <sunfleck/scene/build.hpp>

#include <algorithm>
#include <numbers>

namespace sunfleck {

Placement placed(const Stance& stance) {
  constexpr double degree = std::numbers::pi / 180.0;
  Affine map = Affine::scale(stance.scale);
  if (stance.mirror) map = Affine{Mat3{Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, Vec3{0.0}} * map;
  map = Affine::turn(stance.turn_deg * degree) * map;
  if (stance.tilt_deg != 0) {
    // Leaning towards +x takes z to (sin, 0, cos); the azimuth's own turn carries +x there and back.
    const double c = std::cos(stance.tilt_deg * degree), s = std::sin(stance.tilt_deg * degree);
    const Affine lean{Mat3{Vec3{c, 0, -s}, Vec3{0, 1, 0}, Vec3{s, 0, c}}, Vec3{0.0}};
    const double to_azimuth = (90.0 - stance.tilt_azimuth_deg) * degree;
    map = Affine::turn(to_azimuth) * lean * Affine::turn(-to_azimuth) * map;
  }
  map.translation += stance.position;
  return {map};
}

Optics uniform_optics(const std::string& name, const std::vector<double>& reflectance, const std::vector<double>& transmittance) {
  Optics optics;
  optics.name = name;
  optics.reflectance_front.assign(reflectance.begin(), reflectance.end());
  optics.reflectance_back = optics.reflectance_front;
  optics.transmittance.assign(transmittance.begin(), transmittance.end());
  return optics;
}

PlantEntry plant_entry(const std::string& name, Plant plant, std::uint32_t optics, std::vector<Placement> placements) {
  PlantEntry entry;
  entry.name = name;
  entry.shape_optics.assign(plant.shapes.size(), optics);
  entry.plant = std::make_shared<const Plant>(std::move(plant));
  entry.placements = std::move(placements);
  return entry;
}

Ground flat_ground(std::array<double, 2> size, std::array<double, 2> centre, std::array<std::uint32_t, 2> cells,
                   const std::vector<double>& reflectance) {
  Ground ground;
  ground.size = size;
  ground.centre = centre;
  ground.cells = cells;
  ground.optics = uniform_optics("ground", reflectance, std::vector<double>(reflectance.size(), 0.0));
  return ground;
}

std::vector<std::uint32_t> group_cycle(const Scene& scene) {
  enum class Mark : char { unseen, open, done };
  std::vector<Mark> mark(scene.groups.size(), Mark::unseen);
  struct Step {
    std::uint32_t group;
    std::size_t next_member;
  };
  std::vector<Step> path;
  for (std::uint32_t start = 0; start < scene.groups.size(); ++start) {
    if (mark[start] != Mark::unseen) continue;
    mark[start] = Mark::open;
    path.assign(1, {start, 0});
    while (!path.empty()) {
      auto& [group, next] = path.back();
      const auto& members = scene.groups[group].members;
      while (next < members.size() && !members[next].is_group) ++next;
      if (next == members.size()) {
        mark[group] = Mark::done;
        path.pop_back();
        continue;
      }
      const std::uint32_t inner = members[next++].index;
      if (mark[inner] == Mark::open) {
        std::vector<std::uint32_t> cycle;
        auto at = std::find_if(path.begin(), path.end(), [&](const Step& s) { return s.group == inner; });
        for (; at != path.end(); ++at) cycle.push_back(at->group);
        cycle.push_back(inner);
        return cycle;
      }
      if (mark[inner] == Mark::unseen) {
        mark[inner] = Mark::open;
        path.push_back({inner, 0});
      }
    }
  }
  return {};
}

}  // namespace sunfleck
