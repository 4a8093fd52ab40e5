#include "scene/neighbourhood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <sunfleck/scene/counts.hpp>

namespace sunfleck {

namespace {

constexpr double near_sizes = 2.0;    // plant sizes: a neighbour farther away that is not quite what it seems changes a leaf by .1 %
constexpr double far_heights = 50.0;  // the sky below 1.1 degrees
constexpr double lowest_sun = 0.09;   // 5 degrees: shadows are not followed farther
constexpr std::size_t most_far = 50'000;
constexpr std::size_t most_compared = 4096;  // boxes, each with all others
constexpr std::size_t most_fields = 256;
constexpr double most_ground_cells = 64;          // along an edge
constexpr double far_ground_cells = 16;           // along the reach
constexpr double beside_heights = 1.5;            // of plants: so wide a strip of ground beside them is cut as finely as that under them
constexpr std::uint64_t small_scene = 2'000'000;  // facets

Box moved(const Box& box, const Affine& map) {
  Box out;
  if (box.empty()) return out;
  for (int i = 0; i < 8; ++i)
    out.add(map.point({i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z}));
  return out;
}

/// Distance of two boxes; 0 where they meet.
double distance(const Box& a, const Box& b) {
  const Vec3 gap = glm::max(glm::max(a.low - b.high, b.low - a.high), Vec3{0.0});
  return glm::length(gap);
}

/// Does `box`, moved by some t in [0, reach] along d, meet `other`?
bool sweeps_into(const Box& box, const Vec3& d, double reach, const Box& other) {
  double first = 0, last = reach;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = other.low[axis] - box.high[axis], high = other.high[axis] - box.low[axis];
    if (std::fabs(d[axis]) < 1e-12) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    first = std::max(first, std::min(low / d[axis], high / d[axis]));
    last = std::min(last, std::max(low / d[axis], high / d[axis]));
  }
  return first <= last;
}

class Neighbourhood {
 public:
  Neighbourhood(const Scene& scene, PlacedScene& placed)
      : scene_(scene), placed_(placed), plant_boxes_(scene.plants.size()), group_boxes_(scene.groups.size()) {}

  void run() {
    for (const auto& copy : placed_.copies) open(copy.plant, copy.map);
    for (const auto& c : placed_.closed)
      if (c.solved) each_copy(c.is_group, c.index, c.map, [&](std::uint32_t plant, const Affine& map) { open(plant, map); });
    join_boxes();
    for (const auto& state : scene_.states)
      if (state.sun) {
        Vec3 d = state.sun->direction;
        d.z = std::max(d.z, lowest_sun);
        suns_.push_back(glm::normalize(d));
      }
    const bool all = scene_.periodic.has_value() || count(scene_).plant_facets <= small_scene;
    // a smaller circle where too many copies stand in it
    for (double reach = std::max(near_sizes * size_, far_heights * height_);; reach *= 0.7) {
      placed_.near.clear();
      placed_.far.clear();
      bool complete = true;
      for (std::uint32_t row = 0; row < placed_.closed.size() && complete; ++row) {
        auto& c = placed_.closed[row];
        if (named_.size() <= row) named_.push_back(c.solved);
        c.solved = true;
        complete = add(c.is_group, c.index, c.map, row, all || named_[row], reach);
      }
      if (!complete) continue;
      if (placed_.partial && scene_.ground) lay_ground(*scene_.ground, reach);
      break;
    }
  }

 private:
  const Box& plant_box(std::uint32_t p) {
    if (!plant_boxes_[p]) plant_boxes_[p] = scene_.plants[p].plant->bounds();
    return *plant_boxes_[p];
  }

  const Box& group_box(std::uint32_t g) {
    if (!group_boxes_[g]) {
      Box box;
      for (const auto& m : scene_.groups[g].members) box.add(moved(m.is_group ? group_box(m.index) : plant_box(m.index), m.placement.map));
      group_boxes_[g] = box;
    }
    return *group_boxes_[g];
  }

  template <class Call>
  void each_copy(bool is_group, std::uint32_t index, const Affine& map, Call&& call) {
    if (!is_group) return call(index, map);
    for (const auto& m : scene_.groups[index].members) each_copy(m.is_group, m.index, map * m.placement.map, call);
  }

  void open(std::uint32_t plant, const Affine& map) {
    const Box box = moved(plant_box(plant), map);
    if (box.empty()) return;
    opened_.push_back(box);
    const Vec3 size = box.size();
    size_ = std::max({size_, size.x, size.y});
    height_ = std::max(height_, size.z);
  }

  /// Boxes that stand within a plant's size of each other become one, so that there are few to ask.
  void join_boxes() {
    if (opened_.size() > most_compared) join_in_fields();
    std::vector<Box> joined;
    for (const auto& box : opened_) {
      auto best = joined.end();
      for (auto b = joined.begin(); b != joined.end(); ++b)
        if (distance(*b, box) <= size_) {
          best = b;
          break;
        }
      if (best == joined.end())
        joined.push_back(box);
      else
        best->add(box);
    }
    opened_ = std::move(joined);
  }

  /// Very many: those with their middles in one field of a grid, as fine as leaves few of them.
  void join_in_fields() {
    for (double field = 4 * size_; opened_.size() > most_fields; field *= 2) {
      if (!(field > 0)) return;
      std::map<std::pair<double, double>, Box> fields;
      for (const auto& box : opened_) {
        const Vec3 middle = box.centre() / field;
        fields[{std::floor(middle.x), std::floor(middle.y)}].add(box);
      }
      opened_.clear();
      for (const auto& [place, box] : fields) opened_.push_back(box);
    }
  }

  bool is_near(const Box& box) const {
    for (const auto& o : opened_) {
      if (distance(o, box) <= near_sizes * size_) return true;
      for (const auto& d : suns_)
        if (sweeps_into(o, d, std::max(0.0, box.high.z - o.low.z) / d.z, box)) return true;
    }
    return false;
  }

  /// False if there are too many that are far.
  bool add(bool is_group, std::uint32_t index, const Affine& map, std::uint32_t row, bool near, double reach) {
    if (!near) {
      const Box box = moved(is_group ? group_box(index) : plant_box(index), map);
      double away = std::numeric_limits<double>::infinity();
      for (const auto& o : opened_) away = std::min(away, distance(o, box));
      const bool shades = is_group || away > reach ? is_near(box) : false;
      if (away > reach && !shades) {
        placed_.closed[row].solved = false;
        return true;
      }
      if (!is_group) {
        if (is_near(box)) {
          placed_.near.push_back({index, map, row});
          return true;
        }
        placed_.closed[row].solved = false;
        placed_.far.push_back({index, map, row});
        return placed_.far.size() <= most_far;
      }
    } else if (!is_group) {
      placed_.near.push_back({index, map, row});
      return true;
    }
    for (const auto& m : scene_.groups[index].members)
      if (!add(m.is_group, m.index, map * m.placement.map, row, near, reach)) return false;
    return true;
  }

  void lay_ground(const Ground& ground, double reach) {
    if (ground.mesh) {
      for (std::size_t t = 0; t < ground.mesh->triangles.size(); ++t) placed_.near_ground.push_back(ground.mesh->corners(t));
      return;
    }
    Box box;
    for (const auto& o : opened_) box.add(o);
    for (const auto& c : placed_.near) box.add(moved(plant_box(c.plant), c.map));
    const auto cut = [](double middle, double size, double low, double high) {
      return std::pair{std::max(middle - 0.5 * size, low), std::min(middle + 0.5 * size, high)};
    };
    const auto x = cut(ground.centre[0], ground.size[0], box.low.x - reach, box.high.x + reach),
               y = cut(ground.centre[1], ground.size[1], box.low.y - reach, box.high.y + reach);
    if (box.empty() || !(x.first < x.second) || !(y.first < y.second)) return;  // what is opened stands beside it
    const std::array<double, 4> whole{x.first, y.first, x.second, y.second};
    // beside the outermost plants, too, light varies within about their height
    const double margin = std::min(beside_heights * height_, reach);
    std::array<double, 4> field{std::max(whole[0], box.low.x - margin), std::max(whole[1], box.low.y - margin),
                                std::min(whole[2], box.high.x + margin), std::min(whole[3], box.high.y + margin)};
    if (!(field[0] < field[2]) || !(field[1] < field[3])) field = whole;
    const double cell = std::max(0.25 * size_, std::max(field[2] - field[0], field[3] - field[1]) / most_ground_cells);
    placed_.near_ground = cells_of(field, cell, ground.height);
    const std::array<double, 4> rest[4] = {{whole[0], whole[1], whole[2], field[1]},
                                           {whole[0], field[3], whole[2], whole[3]},
                                           {whole[0], field[1], field[0], field[3]},
                                           {field[2], field[1], whole[2], field[3]}};
    for (const auto& r : rest)
      if (r[0] < r[2] && r[1] < r[3])
        for (const auto& t : cells_of(r, std::max(cell, reach / far_ground_cells), ground.height)) placed_.far_ground.push_back(t);
  }

  static std::vector<Triangle> cells_of(const std::array<double, 4>& field, double cell, double height) {
    const auto count = [&](double length) {
      return static_cast<std::uint32_t>(std::clamp(std::ceil(length / cell), 1.0, most_ground_cells));
    };
    return GroundFacets(field, {count(field[2] - field[0]), count(field[3] - field[1])}, height).written_out();
  }

  const Scene& scene_;
  PlacedScene& placed_;
  std::vector<std::optional<Box>> plant_boxes_, group_boxes_;
  std::vector<Box> opened_;
  std::vector<Vec3> suns_;        ///< unit vectors towards them
  std::vector<bool> named_;       ///< [closed] named by stop_at: solved wherever it stands
  double size_ = 0, height_ = 0;  ///< of the largest plant that is opened [m]
};

}  // namespace

void add_neighbourhood(const Scene& scene, PlacedScene& placed) {
  Neighbourhood(scene, placed).run();
}

PlacedScene with_surroundings(const PlacedScene& placed) {
  PlacedScene out = placed;
  out.near.clear();
  out.far.clear();
  out.near_ground.clear();
  out.far_ground.clear();
  const auto add = [&](const ClosedCopy& c) {
    out.copies.push_back({c.plant, c.map, out.facets, out.organs});
    out.paths.push_back(placed.closed[c.structure].path);
    out.facets += out.plant_facets[c.plant];
    out.organs += out.plant_organs[c.plant];
  };
  if (!placed.partial) {  // the ground's rows come last
    out.facets = placed.first_ground_facet;
    out.organs = placed.first_ground_organ;
  }
  for (const auto& c : placed.near) add(c);
  for (const auto& c : placed.far) add(c);
  out.first_ground_facet = out.facets;
  out.first_ground_organ = out.organs;
  if (placed.partial) {
    std::vector<Triangle> facets = placed.near_ground;
    facets.insert(facets.end(), placed.far_ground.begin(), placed.far_ground.end());
    out.ground = GroundFacets(std::move(facets));
  }
  out.facets += out.ground.size();
  out.organs += out.ground.organs();
  return out;
}

}  // namespace sunfleck
