// Trees: axes of yearly growth units. First the skeleton (which buds grew, and where to), then radii, then structures.
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <plant/growing.hpp>
#include <plant/organ_meshes.hpp>

namespace sunfleck {

namespace {

constexpr std::uint32_t no_axis = 0xffffffffu;

struct Node {
  Vec3 base, top;                ///< of its internode [m]
  Mat3 frame;                    ///< z along the internode
  double azimuth_rad = 0;        ///< of its leaf and bud, about z from x
  std::uint32_t axis = no_axis;  ///< that its bud grew into
  double radius_m = 0;           ///< of its internode at the base
};

struct Unit {
  std::size_t first = 0, count = 0, planned = 0;  ///< nodes; planned once the season ends
  double born = 0;                                ///< age of the plant when it began [years]
};

struct Axis {
  std::int64_t axis_class = 1, order = 1;
  std::uint64_t key = 0;  ///< of its random numbers: depends on its place in the plant only, not on the plant's age
  double born = 0;        ///< age of the plant when it began [years]
  double vigour = 1;
  std::vector<Unit> units;
  std::vector<Node> nodes;
  bool alive = false;  ///< bears a leaf, itself or through its branches
  double base_radius_m = 0;
};

class TreeGrower {
 public:
  TreeGrower(const Species& species, const TreeGrowth& growth, double age, std::uint64_t seed)
      : species_(species), growth_(growth), age_(age), seed_(seed), build_(species) {}

  Plant run() {
    Axis trunk;
    trunk.key = mix(seed_, 1);
    axes_.push_back(trunk);
    RandomStream random(mix(trunk.key, 2));
    const Mat3 upright = rotation({0, 0, 1}, 2 * 3.141592653589793 * random.next());
    extend(0, {0, 0, clearance_m}, upright);
    for (std::uint32_t a = 0; a < axes_.size(); ++a) branch(a);
    find_alive();
    find_radii();
    make_leaf_meshes();
    const auto plant = build_.open(no_parent, "plant", {}, 0, 0, 0);
    emit_axis(0, plant, "trunk");
    return build_.finish();
  }

 private:
  const AxisClass& rules(const Axis& axis) const { return growth_.axes[static_cast<std::size_t>(axis.axis_class - 1)]; }
  bool leafy(const Unit& unit) const { return age_ - unit.born <= growth_.leaf.life_years; }

  /// Grows the nodes of an axis from its birth to now.
  void extend(std::uint32_t a, Vec3 position, Mat3 frame) {
    Axis& axis = axes_[a];
    const AxisClass& r = rules(axis);
    double azimuth = 0, nodes_now = r.nodes * axis.vigour;
    for (int year = 0; axis.born + year < age_; ++year, nodes_now *= 1 - r.decline) {
      RandomStream random(mix(axis.key, 3, static_cast<std::uint64_t>(year)));
      const double season = std::min(1.0, age_ - axis.born - year);
      const auto planned = std::lround(nodes_now * (1 + r.nodes_spread * spread(random)));
      if (planned < 1) break;  // exhausted
      Unit unit{axis.nodes.size(), static_cast<std::size_t>(std::ceil(season * static_cast<double>(planned) - 1e-9)),
                static_cast<std::size_t>(planned), axis.born + year};
      const double step = r.internode_length_m * (0.4 + 0.6 * axis.vigour);
      for (std::size_t i = 0; i < unit.count; ++i) {
        if (++node_count_ > node_limit) too_many_nodes(species_, age_);
        azimuth += radians(r.divergence_deg + 4 * spread(random));
        Vec3 d = frame[2];
        const double wobble = radians(r.wobble_deg) * std::sqrt(random.next()), towards = 2 * 3.141592653589793 * random.next();
        d = glm::normalize(d + std::tan(wobble) * (std::cos(towards) * frame[0] + std::sin(towards) * frame[1]));
        d = turned_to_elevation(d, radians(r.elevation_deg), radians(r.tropism_deg) * step);
        if (a == 0 && axis.nodes.empty()) d = frame[2];     // upright, so that its foot stays above the ground
        if (i == 0 && year > 0 && growth_.relay_deg > 0) {  // the apex died; the bud below it takes over
          Vec3 side = std::cos(azimuth) * frame[0] + std::sin(azimuth) * frame[1];
          side.z = std::max(side.z, 0.0);  // buds below a branch do not take over
          d = glm::normalize(std::cos(radians(growth_.relay_deg)) * d + std::sin(radians(growth_.relay_deg)) * side);
        }
        const double floor = 20 * clearance_m;
        if (position.z + step * d.z < floor && d.z < 0.3) d = glm::normalize(Vec3{d.x, d.y, 0.3});
        frame = carried(frame, d);
        axis.nodes.push_back({position, position + step * d, frame, azimuth, no_axis, 0});
        position += step * d;
      }
      axis.units.push_back(unit);
    }
  }

  /// Turns a direction in its vertical plane towards an angle above the horizontal.
  static Vec3 turned_to_elevation(const Vec3& d, double elevation, double most) {
    const double flat = std::hypot(d.x, d.y);
    if (flat < 1e-9) return d;
    const double now = std::atan2(d.z, flat), next = now + std::clamp(elevation - now, -most, most);
    return {d.x / flat * std::cos(next), d.y / flat * std::cos(next), std::sin(next)};
  }

  /// Lets the buds of the axis' past growth units grow into axes.
  void branch(std::uint32_t a) {
    if (axes_[a].order >= growth_.highest_order) return;
    const AxisClass& r = rules(axes_[a]);
    const double clear_m = a == 0 && !axes_[0].nodes.empty() ? growth_.clear_trunk * axes_[0].nodes.back().top.z : 0;
    for (std::size_t u = 0; u < axes_[a].units.size(); ++u) {
      const Unit unit = axes_[a].units[u];
      const double born = unit.born + 1;  // buds rest for one winter
      if (born >= age_) break;
      for (std::size_t i = 0; i < unit.count; ++i) {
        const std::uint64_t key = mix(axes_[a].key, 4 + u, i);
        RandomStream random(key);
        const double height = static_cast<double>(i + 1) / static_cast<double>(unit.count);
        const bool strong = static_cast<std::int64_t>(unit.count - i) <= r.strong_branches;
        if (!strong && random.next() >= r.weak_probability * std::pow(height, r.acrotony)) continue;
        Axis child;
        child.axis_class = strong ? r.strong_class : r.weak_class;
        child.order = axes_[a].order + 1;
        child.key = mix(key, 5);
        child.born = born;
        child.vigour = r.basal_vigour + (1 - r.basal_vigour) * height;
        const AxisClass& c = rules(child);
        if (age_ - born > c.lifetime_years * (1 + 0.3 * spread(random))) continue;  // shed
        const Node node = axes_[a].nodes[unit.first + i];
        if (node.top.z < clear_m) continue;
        const double angle = std::min(2.4, radians(c.insertion_deg + c.insertion_spread_deg * spread(random) + c.sag_deg * (age_ - born)));
        const Vec3 side = std::cos(node.azimuth_rad) * node.frame[0] + std::sin(node.azimuth_rad) * node.frame[1];
        const Vec3 d = glm::normalize(std::cos(angle) * node.frame[2] + std::sin(angle) * side);
        const auto b = static_cast<std::uint32_t>(axes_.size());
        axes_.push_back(std::move(child));
        axes_[a].nodes[unit.first + i].axis = b;
        extend(b, node.top, organ_frame(d, node.frame[2]));
      }
    }
  }

  /// An axis that bears no leaf any more is dead and shed. Branches come after what bears them.
  void find_alive() {
    for (std::size_t a = axes_.size(); a-- > 0;) {
      Axis& axis = axes_[a];
      for (const auto& unit : axis.units) axis.alive = axis.alive || leafy(unit);
      for (auto& node : axis.nodes) {
        if (node.axis != no_axis && !axes_[node.axis].alive) node.axis = no_axis;
        axis.alive = axis.alive || node.axis != no_axis;
      }
    }
  }

  /// The pipe model, from the tips down.
  void find_radii() {
    const double tip = std::pow(growth_.tip_radius_m, growth_.pipe_exponent);
    for (std::size_t a = axes_.size(); a-- > 0;) {
      double section = tip;
      for (auto node = axes_[a].nodes.rbegin(); node != axes_[a].nodes.rend(); ++node) {
        if (node->axis != no_axis) section += std::pow(axes_[node->axis].base_radius_m, growth_.pipe_exponent);
        section += growth_.pipe_per_node * tip;
        node->radius_m = std::pow(section, 1 / growth_.pipe_exponent);
      }
      axes_[a].base_radius_m = std::pow(section, 1 / growth_.pipe_exponent);
    }
  }

  void make_leaf_meshes() {
    const LeafParameters& l = growth_.leaf;
    blade_ = build_.add_mesh(blade_mesh(l.outline, {l.width_ratio, radians(l.fold_deg), radians(l.curvature_deg), l.petiole_ratio,
                                                    l.petiole_width_ratio, radians(l.hinge_deg)}));
  }

  /// The mesh of a rachis for so many leaflets; its length is 1, its radius in proportion.
  std::uint32_t rachis(std::int64_t leaflets) {
    const auto [entry, fresh] = rachis_.try_emplace(leaflets, 0u);
    if (fresh) {
      const double length = growth_.leaf.rachis_length_m * static_cast<double>(leaflets) / static_cast<double>(growth_.leaf.leaflets_high);
      entry->second = build_.add_mesh(rachis_mesh(radians(growth_.leaf.rachis_curvature_deg), growth_.leaf.rachis_radius_m / length, 3));
    }
    return entry->second;
  }

  void emit_axis(std::uint32_t a, std::uint32_t parent, const std::string& type) {
    const Axis& axis = axes_[a];
    double length = 0;
    for (const auto& node : axis.nodes) length += glm::length(node.top - node.base);
    const auto self = build_.open(parent, type, {axis.nodes[0].frame, axis.nodes[0].base}, axis.order, axis.axis_class, length);
    for (const auto& unit : axis.units) {
      const Node& first = axis.nodes[unit.first];
      double unit_length = 0;
      for (std::size_t i = 0; i < unit.count; ++i)
        unit_length += glm::length(axis.nodes[unit.first + i].top - axis.nodes[unit.first + i].base);
      const auto growth_unit = build_.open(self, "growth_unit", {first.frame, first.base}, axis.order, axis.axis_class, unit_length);
      std::size_t from = unit.first;
      for (std::size_t i = unit.first; i < unit.first + unit.count; ++i) {
        const bool last = i + 1 == unit.first + unit.count;
        if (leafy(unit) || last || axis.nodes[i].axis != no_axis || static_cast<std::int64_t>(i + 1 - from) >= growth_.merge_nodes) {
          emit_metamer(axis, unit, from, i, growth_unit);
          from = i + 1;
        }
      }
    }
  }

  /// Internodes `from` to `to` as one, with the leaf and the branch of the last.
  void emit_metamer(const Axis& axis, const Unit& unit, std::size_t from, std::size_t to, std::uint32_t growth_unit) {
    const Node &first = axis.nodes[from], &last = axis.nodes[to];
    const double radius = first.radius_m;
    const double radius_to = to + 1 < axis.nodes.size() ? axis.nodes[to + 1].radius_m : growth_.tip_radius_m;
    const double length = glm::length(last.top - first.base);
    const auto metamer = build_.open(growth_unit, "metamer", {first.frame, first.base}, axis.order, axis.axis_class, length);
    const auto wood = build_.open(metamer, "internode", {first.frame, first.base}, axis.order, axis.axis_class, length);
    build_.internode(wood, "bark", rules(axis).sides, first.base, last.top, first.frame, radius, std::min(radius, radius_to));
    if (leafy(unit)) emit_leaf(axis, unit, to - unit.first, last, radius_to, metamer);
    if (last.axis != no_axis) emit_axis(last.axis, metamer, "branch");
  }

  void emit_leaf(const Axis& axis, const Unit& unit, std::size_t rank, const Node& node, double radius, std::uint32_t metamer) {
    const LeafParameters& l = growth_.leaf;
    RandomStream random(mix(axis.key, 6 + unit.first, rank));
    const double place = (static_cast<double>(rank) + 0.5) / static_cast<double>(unit.planned);
    // Young leaves near a growing tip are still small; in a finished unit the first and last are a little smaller.
    const double to_tip = static_cast<double>(unit.count - rank);
    const double unfolding = unit.count < unit.planned ? std::min(1.0, 0.2 + 0.2 * to_tip) : 1.0;
    const double profile = 0.65 + 0.35 * std::sqrt(std::max(0.0, 4 * place * (1 - place)));
    const double size = rules(axis).leaf_scale * unfolding * profile * (1 + l.size_spread * spread(random));
    const double angle = radians(l.insertion_deg + l.insertion_spread_deg * spread(random));
    const Vec3 side = std::cos(node.azimuth_rad) * node.frame[0] + std::sin(node.azimuth_rad) * node.frame[1];
    Vec3 along = std::cos(angle) * node.frame[2] + std::sin(angle) * side;
    along = turned_to_elevation(glm::normalize(along), radians(-80), radians(l.droop_deg));
    const Vec3 position = node.top + mantle_gap * radius * side;
    const std::int64_t choices = (l.leaflets_high - l.leaflets_low) / 2 + 1;
    const std::int64_t leaflets =
        l.leaflets_low + 2 * std::min(choices - 1, static_cast<std::int64_t>(random.next() * static_cast<double>(choices)));
    const bool compound = l.leaflets_high > 1;
    const double share = static_cast<double>(leaflets) / static_cast<double>(l.leaflets_high);
    const double length = size * (compound ? l.rachis_length_m * share : l.length_m * (1 + l.petiole_ratio));
    Mat3 frame{1.0};
    for (int tries = 0; tries < 12; ++tries) {  // lifts a leaf that would reach into the ground
      frame = organ_frame(along, glm::normalize((1 - l.uprightness) * node.frame[2] + (l.uprightness + 1e-6) * Vec3{0, 0, 1}));
      const double reach = compound ? position.z - size * (l.length_m + (along.z < 0.5 ? l.rachis_length_m : 0)) - clearance_m
                                    : build_.lowest(blade_, {size * l.length_m * frame, position}) - clearance_m;
      if (reach >= 0) break;
      along = turned_to_elevation(along, radians(90), radians(15));
    }
    const auto leaf = build_.open(metamer, "leaf", {frame, position}, axis.order, axis.axis_class, length);
    if (!compound) {
      build_.shape(leaf, blade_, "leaf", {size * l.length_m * frame, position});
      return;
    }
    const auto stalk = build_.open(leaf, "rachis", {frame, position}, axis.order, axis.axis_class, length);
    build_.shape(stalk, rachis(leaflets), "stem", {length * frame, position});
    const std::int64_t pairs = (leaflets - 1) / 2;
    const double bend = radians(l.rachis_curvature_deg), tilt = radians(l.leaflet_angle_deg), petiole = 0.15;
    for (std::int64_t p = 0; p <= pairs; ++p)
      for (int hand = -1; hand <= 1; hand += 2) {
        const bool terminal = p == pairs;
        if (terminal && hand > 0) continue;
        const double s = terminal ? 1.0 : petiole + (1 - petiole) * (static_cast<double>(p) + 0.5) / (static_cast<double>(pairs) + 0.5);
        const auto point = rachis_point(bend, s);
        const Vec3 tangent = point.tangent, front{0, point.tangent.z, -point.tangent.y};
        const Vec3 out = terminal ? tangent : std::cos(tilt) * tangent + hand * std::sin(tilt) * Vec3{1, 0, 0};
        const Mat3 leaflet_frame = frame * organ_frame(out, front);
        const Vec3 beside = (terminal ? 0.0 : hand * mantle_gap) * l.rachis_radius_m * length / (l.rachis_length_m * share) * Vec3{1, 0, 0};
        const Vec3 at = position + frame * (length * point.position + beside);
        const auto leaflet = build_.open(leaf, "leaflet", {leaflet_frame, at}, axis.order, axis.axis_class, size * l.length_m);
        build_.shape(leaflet, blade_, "leaf", {size * l.length_m * leaflet_frame, at});
      }
  }

  const Species& species_;
  const TreeGrowth& growth_;
  double age_;
  std::uint64_t seed_;
  PlantBuilder build_;
  std::vector<Axis> axes_;
  std::size_t node_count_ = 0;
  std::uint32_t blade_ = 0;
  std::map<std::int64_t, std::uint32_t> rachis_;
};

}  // namespace

Plant grow_tree(const Species& species, const TreeGrowth& growth, double age, std::uint64_t seed) {
  return TreeGrower(species, growth, age, seed).run();
}

}  // namespace sunfleck
