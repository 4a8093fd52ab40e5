#include <sunfleck/scene/extent.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

constexpr double most_sizes = 4e6;        // single precision has 24 bits: a copy's corners stand a quarter of its size wrong there
constexpr double most_scene_sizes = 1e6;  // of a sensor from the middle
constexpr double most_heights = 1e4;      // cells: a ray crosses as many on its way up, and more where it is low
constexpr double much_covered = 100;      // cells that one plant covers: a note
constexpr double most_covered = 1e5;      // an error

/// What a plant or group holds, in the frame of what it is placed in.
struct Occupied {
  Box box;
  double smallest = std::numeric_limits<double>::infinity();  ///< size of the smallest plant [m]

  void add(const Occupied& other) {
    box.add(other.box);
    smallest = std::min(smallest, other.smallest);
  }
};

Occupied mapped(const Occupied& c, const Affine& map) {
  Occupied out;
  if (c.box.empty()) return out;
  const Vec3 middle = map.point(c.box.centre()), half = 0.5 * c.box.size();
  Vec3 reach{0.0};
  for (int i = 0; i < 3; ++i) reach += glm::abs(map.linear[i]) * half[i];
  out.box = {middle - reach, middle + reach};
  out.smallest = c.smallest * std::cbrt(std::fabs(glm::determinant(map.linear)));
  return out;
}

double largest(const Vec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// Distance of the farthest corner.
double distance(const Box& box, const Vec3& from) {
  return glm::length(glm::max(glm::abs(box.low - from), glm::abs(box.high - from)));
}

class Extents {
 public:
  explicit Extents(const Scene& scene) : scene_(scene), groups_(scene.groups.size()), group_known_(scene.groups.size(), false) {}

  void check() {
    Occupied all;
    each_placement([&](const Occupied& c, const std::string&, std::size_t, std::size_t) { all.add(c); });
    Box everything = all.box;
    if (scene_.ground) everything.add(ground_box(*scene_.ground));
    sensors(everything);
    if (everything.empty()) return;
    const Vec3 middle = everything.centre();
    if (distance(all.box, middle) > most_sizes * all.smallest)  // perhaps: only then every copy is looked at
      each_placement([&](const Occupied& c, const std::string& name, std::size_t entry, std::size_t i) {
        const double away = distance(c.box, middle);
        if (!c.box.empty() && away > most_sizes * c.smallest)
          fail(key_of(name, entry, i),
               fmt::format("a plant of {:.4g} m that stands {:.4g} m from the middle of the scene", c.smallest, away),
               fmt::format("plants at most {:.0f} times their size from it: single precision tells their corners apart no farther",
                           most_sizes));
      });
    if (scene_.periodic) heights(everything, *scene_.periodic);
  }

  /// Calls visit(row of Scene::plants, width, depth, cells covered) for all plants that are placed; not in finite scenes.
  template <class Visit>
  void each_plant(Visit&& visit) {
    if (!scene_.periodic) return;
    const double width = scene_.periodic->width(), depth = scene_.periodic->depth();
    for (std::size_t p = 0; p < scene_.plants.size(); ++p) {
      const Vec3 size = plant(p).box.size();
      const double scale = scale_of_plant(p);
      const double x = scale * size.x / width, y = scale * size.y / depth;
      if (scale > 0) visit(p, scale * size.x, scale * size.y, std::max(1.0, x) * std::max(1.0, y));
    }
  }

  [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected) const {
    throw InputError(location(scene_.file, 0, key), found, expected);
  }

 private:
  static std::string key_of(const std::string& name, std::size_t entry, std::size_t i) {
    return fmt::format("{}[{}].place[{}]", name, entry, i);
  }

  const Occupied& plant(std::size_t p) {
    const auto [at, added] = plants_.try_emplace(scene_.plants[p].plant.get());
    if (added) {
      at->second.box = at->first->bounds();
      if (const double size = largest(at->second.box.size()); size > 0) at->second.smallest = size;
    }
    return at->second;
  }

  const Occupied& group(std::size_t g) {
    if (!group_known_[g]) {
      Occupied all;
      for (const auto& m : scene_.groups[g].members) all.add(mapped(m.is_group ? group(m.index) : plant(m.index), m.placement.map));
      groups_[g] = all;
      group_known_[g] = true;
    }
    return groups_[g];
  }

  template <class Visit>
  void each_placement(Visit&& visit) {
    for (std::size_t p = 0; p < scene_.plants.size(); ++p)
      for (std::size_t i = 0; i < scene_.plants[p].placements.size(); ++i)
        visit(mapped(plant(p), scene_.plants[p].placements[i].map), "plant", p, i);
    for (std::size_t g = 0; g < scene_.groups.size(); ++g)
      for (std::size_t i = 0; i < scene_.groups[g].placements.size(); ++i)
        visit(mapped(group(g), scene_.groups[g].placements[i].map), "group", g, i);
  }

  /// The largest of the scales with which a plant is placed, in groups by what their placements alone do.
  double scale_of_plant(std::size_t p) {
    if (scales_.empty()) {
      scales_.assign(scene_.plants.size(), 0.0);
      std::vector<double> of_group(scene_.groups.size(), 0.0);
      const auto scale = [](const Placement& placement) { return std::cbrt(std::fabs(glm::determinant(placement.map.linear))); };
      for (std::size_t i = 0; i < scales_.size(); ++i)
        for (const auto& placement : scene_.plants[i].placements) scales_[i] = std::max(scales_[i], scale(placement));
      std::vector<std::uint32_t> changed;
      for (std::uint32_t g = 0; g < of_group.size(); ++g) {
        for (const auto& placement : scene_.groups[g].placements) of_group[g] = std::max(of_group[g], scale(placement));
        if (of_group[g] > 0) changed.push_back(g);
      }
      while (!changed.empty()) {
        const auto g = changed.back();
        changed.pop_back();
        for (const auto& m : scene_.groups[g].members) {
          auto& known = m.is_group ? of_group[m.index] : scales_[m.index];
          const double s = of_group[g] * scale(m.placement);
          if (s <= known) continue;
          known = s;
          if (m.is_group) changed.push_back(m.index);
        }
      }
    }
    return scales_[p];
  }

  static Box ground_box(const Ground& ground) {
    Box box;
    if (ground.mesh) {
      for (const auto& t : ground.mesh->triangles)
        for (const auto v : t) box.add(ground.mesh->vertices[v]);
    } else {
      const Vec3 middle{ground.centre[0], ground.centre[1], ground.height}, half{0.5 * ground.size[0], 0.5 * ground.size[1], 0.0};
      box = {middle - half, middle + half};
    }
    return box;
  }

  /// Where rays from them can still be aimed at the scene.
  void sensors(const Box& all) const {
    for (std::size_t i = 0; i < scene_.sensors.size(); ++i) {
      const auto& sensor = scene_.sensors[i];
      const std::string key = fmt::format("sensor[{}]", i);
      if (const auto* grid = std::get_if<SensorGrid>(&sensor.shape)) {
        height(grid->z, all, key + ".grid.z");
        horizontal(grid->size, grid->centre, all, key + ".grid");
      } else if (const auto* profile = std::get_if<SensorProfile>(&sensor.shape)) {
        if (profile->low) height(*profile->low, all, key + ".profile.low");
        if (profile->high) height(*profile->high, all, key + ".profile.high");
        horizontal(profile->size, profile->centre, all, key + ".profile");
      } else {
        for (const auto& v : std::get<Mesh>(sensor.shape).vertices)
          for (int axis = 0; axis < 3; ++axis) near_scene(v[axis], axis, all, key + ".mesh");
      }
    }
  }

  void height(double z, const Box& all, const std::string& key) const { near_scene(z, 2, all, key); }

  void horizontal(const std::optional<std::array<double, 2>>& size, const std::optional<std::array<double, 2>>& centre, const Box& all,
                  const std::string& key) const {
    for (int axis = 0; axis < 2; ++axis) {
      const double c = centre ? (*centre)[axis] : scene_.periodic || all.empty() ? 0.0 : all.centre()[axis];
      if (centre) near_scene(c, axis, all, key + ".center");
      if (size) near_scene(c + 0.5 * (*size)[axis], axis, all, key + ".size");
    }
  }

  void near_scene(double v, int axis, const Box& all, const std::string& key) const {
    double size = all.empty() ? 0.0 : glm::length(all.size()), middle = all.empty() ? 0.0 : all.centre()[axis];
    if (scene_.periodic) size = std::max({size, scene_.periodic->width(), scene_.periodic->depth()});
    if (size > 0 && std::fabs(v - middle) > most_scene_sizes * size)
      fail(key, fmt::format("{:.4g} m, in a scene of {:.4g} m", v, size),
           fmt::format("at most {:.0f} times the scene's size from its middle", most_scene_sizes));
  }

  void heights(const Box& all, const PeriodicCell& cell) const {
    const double least = std::min(cell.width(), cell.depth()), height = all.size().z;
    if (height > most_heights * least)
      fail("domain.periodic", fmt::format("a cell of {:g} m by {:g} m under a scene {:.4g} m high", cell.width(), cell.depth(), height),
           fmt::format("a height of at most {:.0f} cells (is a plant's unit, or where it is placed, wrong?)", most_heights));
  }

  const Scene& scene_;
  std::unordered_map<const Plant*, Occupied> plants_;
  std::vector<Occupied> groups_;
  std::vector<bool> group_known_;
  std::vector<double> scales_;
};

}  // namespace

void check_extent(const Scene& scene) {
  Extents extents(scene);
  extents.each_plant([&](std::size_t p, double x, double y, double covered) {
    if (covered > most_covered)
      extents.fail(fmt::format("plant[{}]", p),
                   fmt::format("a plant of {:.4g} m by {:.4g} m, {:.3g} times the periodic cell of {:g} m by {:g} m", x, y, covered,
                               scene.periodic->width(), scene.periodic->depth()),
                   fmt::format("at most {:.0f} times (is its `unit` right?)", most_covered));
  });
  extents.check();
}

double most_cells_covered(const Scene& scene) {
  double most = 1;
  Extents(scene).each_plant([&](std::size_t, double, double, double covered) { most = std::max(most, covered); });
  return most;
}

std::vector<std::string> notes_on_extent(const Scene& scene) {
  std::vector<std::string> notes;
  Extents(scene).each_plant([&](std::size_t p, double x, double y, double covered) {
    if (covered <= much_covered) return;
    notes.push_back(fmt::format(
        "plant \"{}\" is {:.4g} m by {:.4g} m, and the periodic cell {:g} m by {:g} m: it covers {:.0f} cells, and as many images "
        "of it overlap. Is its `unit` right?",
        scene.plants[p].name, x, y, scene.periodic->width(), scene.periodic->depth(), covered));
  });
  return notes;
}

}  // namespace sunfleck
