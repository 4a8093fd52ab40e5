// Cereals: phytomers that appear one phyllochron apart on a stem, tillers from its lowest axils, inflorescences when old.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <plant/growing.hpp>
#include <plant/organ_meshes.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;

/// A stem, main or tiller, before it is drawn.
struct Stem {
  std::int64_t order = 1;
  std::uint64_t key = 0;
  double born = 0;         ///< age of the plant when its first leaf appears [days]
  double scale = 1;        ///< of its lengths
  long leaves = 1;         ///< final number
  double basal_nodes = 0;  ///< so many lowest nodes stay short
  Vec3 foot{0.0};
  double tilt_rad = 0, heading_rad = 0;
  double azimuth_rad = 0;  ///< of its first leaf
};

class CerealGrower {
 public:
  CerealGrower(const Species& species, const CerealGrowth& growth, double age, std::uint64_t seed)
      : species_(species), g_(growth), age_(age), seed_(seed), build_(species) {}

  Plant run() {
    const auto plant = build_.open(no_parent, "plant", {}, 0, 0, 0);
    Stem stem;
    stem.key = mix(seed_, 1);
    RandomStream random(mix(stem.key, 2));
    stem.leaves = std::max(1L, std::lround(g_.leaves + g_.leaves_spread * spread(random)));
    stem.basal_nodes = g_.basal_nodes;
    stem.heading_rad = 2 * pi * random.next();
    stem.tilt_rad = radians(g_.lean_deg) * random.next();
    stem.azimuth_rad = 2 * pi * random.next();
    stem.foot = {0, 0, clearance_m};
    grow_stem(stem, plant, "stem");
    return build_.finish();
  }

 private:
  /// What a phytomer would look like when finished, by its rank from the bottom (0) to the top (leaves - 1).
  double relative_rank(const Stem& stem, long rank) const {
    return stem.leaves > 1 ? static_cast<double>(rank) / static_cast<double>(stem.leaves - 1) : 1.0;
  }
  double grown(double born) const { return std::clamp((age_ - born) / g_.expansion, 0.12, 1.0); }

  /// Rises from the lowest blade to the longest as a cosine, and falls to the highest.
  double blade_profile(double relative) const {
    const bool below = relative <= g_.longest_rank;
    const double to_end = below ? (g_.longest_rank - relative) / g_.longest_rank : (relative - g_.longest_rank) / (1 - g_.longest_rank);
    const double end = below ? g_.first_blade : g_.last_blade;
    return end + (1 - end) * 0.5 * (1 + std::cos(pi * to_end));
  }

  /// What one sees of a phytomer's stem now [m]. Internodes elongate one after the other, half a phyllochron apart.
  double segment_length(const Stem& stem, long rank) const {
    const double born = stem.born + g_.phyllochron * static_cast<double>(rank), above = static_cast<double>(rank) + 1 - stem.basal_nodes;
    const double tall = std::clamp(above / 2.5, 0.0, 1.0) * (g_.upper_length_m - g_.basal_length_m);  // the first ones are shorter
    const double starts = std::max(born, g_.elongation_start + 0.5 * g_.phyllochron * std::max(0.0, above));
    return stem.scale * (g_.basal_length_m * grown(born) + tall * std::clamp((age_ - starts) / g_.expansion, 0.0, 1.0));
  }

  double radius(const Stem& stem, double relative) const {
    return stem.scale * (g_.base_radius_m + (g_.top_radius_m - g_.base_radius_m) * std::clamp(relative, 0.0, 1.0));
  }

  void grow_stem(const Stem& stem, std::uint32_t parent, const std::string& type) {
    const Mat3 heading = rotation({0, 0, 1}, stem.heading_rad);
    double tilt = stem.tilt_rad;
    const auto direction = [&] { return heading * Vec3{std::sin(tilt), 0, std::cos(tilt)}; };
    Mat3 frame = organ_frame(direction(), {0, 1, 0});
    const long visible = std::min(stem.leaves, static_cast<long>(std::floor((age_ - stem.born) / g_.phyllochron)) + 1);
    std::vector<double> lengths;
    double length = 0;
    for (long k = 0; k < visible; ++k) {
      lengths.push_back(segment_length(stem, k));
      length += lengths.back();
    }
    const auto self = build_.open(parent, type, {frame, stem.foot}, stem.order, stem.order, length);
    Vec3 position = stem.foot;
    double azimuth = stem.azimuth_rad;
    for (long k = 0; k < visible; ++k) {
      if (++nodes_ > node_limit) too_many_nodes(species_, age_);
      const double relative = relative_rank(stem, k), born = stem.born + g_.phyllochron * static_cast<double>(k);
      frame = carried(frame, direction());
      const Vec3 top = position + lengths[static_cast<std::size_t>(k)] * frame[2];
      const auto metamer = build_.open(self, "metamer", {frame, position}, stem.order, stem.order, lengths[static_cast<std::size_t>(k)]);
      const auto internode =
          build_.open(metamer, "internode", {frame, position}, stem.order, stem.order, lengths[static_cast<std::size_t>(k)]);
      const double step = stem.leaves > 1 ? 1.0 / static_cast<double>(stem.leaves - 1) : 0.0;
      build_.internode(internode, "stem", g_.sides, position, top, frame, radius(stem, relative - step), radius(stem, relative));
      RandomStream random(mix(stem.key, 3, static_cast<std::uint64_t>(k)));
      azimuth += radians(g_.divergence_deg + g_.divergence_spread_deg * spread(random));
      const Vec3 side = std::cos(azimuth) * frame[0] + std::sin(azimuth) * frame[1];
      if (age_ - born <= g_.leaf_life) grow_blade(stem, k, born, top, frame[2], side, metamer);
      if (k < g_.tillers && stem.order < g_.highest_order && random.next() < g_.tiller_probability)
        grow_tiller(stem, k, position, side, metamer);
      for (const auto& inflorescence : g_.inflorescences)
        if (inflorescence.rank < 1 && age_ > inflorescence.appears &&
            std::lround(inflorescence.rank * static_cast<double>(stem.leaves - 1)) == k)
          grow_inflorescence(stem, inflorescence, top + radius(stem, relative) * -side, frame, -side, metamer);
      position = top;
      tilt *= 1 - g_.tiller_straightening;
    }
    if (visible == stem.leaves) grow_top(stem, position, frame, self);
  }

  /// The inflorescences at the top of a stem, above a bare piece of it.
  void grow_top(const Stem& stem, const Vec3& from, const Mat3& frame, std::uint32_t self) {
    std::uint32_t metamer = no_parent;
    Vec3 top = from;
    for (const auto& inflorescence : g_.inflorescences) {
      if (inflorescence.rank < 1 || age_ <= inflorescence.appears) continue;
      if (metamer == no_parent) {
        const double share = std::clamp((age_ - inflorescence.appears) / inflorescence.expansion, 0.1, 1.0);
        const double length = std::max(1e-4, g_.peduncle_length_m * stem.scale * share), thick = radius(stem, 1);
        metamer = build_.open(self, "metamer", {frame, from}, stem.order, stem.order, length);
        const auto internode = build_.open(metamer, "internode", {frame, from}, stem.order, stem.order, length);
        top = from + length * frame[2];
        build_.internode(internode, "stem", g_.sides, from, top, frame, thick, 0.8 * thick);
      }
      grow_inflorescence(stem, inflorescence, top, frame, frame[0], metamer);
    }
  }

  void grow_blade(const Stem& stem, long rank, double born, const Vec3& collar, const Vec3& up, const Vec3& side, std::uint32_t metamer) {
    RandomStream random(mix(stem.key, 4, static_cast<std::uint64_t>(rank)));
    const double relative = relative_rank(stem, rank), share = grown(born);
    const double length = g_.blade_length_m * stem.scale * blade_profile(relative) * (1 + 0.06 * spread(random)) * share;
    // Width follows length, but less so; a blade has its full width from the start.
    const double width = g_.blade_width_m * stem.scale * (0.35 + 0.65 * blade_profile(relative)) * std::min(1.0, 0.5 + share);
    double insertion =
        g_.insertion_first_deg + (g_.insertion_last_deg - g_.insertion_first_deg) * relative + g_.insertion_spread_deg * spread(random);
    insertion = std::max(4.0, insertion * (0.25 + 0.75 * share));  // young blades stand upright in the whorl
    double curvature =
        g_.curvature_first_deg + (g_.curvature_last_deg - g_.curvature_first_deg) * relative + g_.curvature_spread_deg * spread(random);
    curvature = std::max(0.0, curvature * share);
    Mat3 frame{1.0};
    Vec3 from = collar;
    std::uint32_t mesh = 0;
    for (int tries = 0; tries < 40; ++tries) {  // a blade that reaches the ground bends less, then stands steeper
      const double angle = radians(insertion);
      frame = organ_frame(glm::normalize(std::cos(angle) * up + std::sin(angle) * side), up);
      from = collar + mantle_gap * radius(stem, relative) * side;
      mesh = blade(curvature, width / length);
      if (build_.lowest(mesh, {length * frame, from}) >= clearance_m) break;
      if (curvature > 10)
        curvature -= 10;
      else
        insertion = std::max(0.0, insertion - 5);
    }
    const auto leaf = build_.open(metamer, "leaf", {frame, from}, stem.order, stem.order, length);
    build_.shape(leaf, mesh, "leaf", {length * frame, from});
  }

  /// Blades share meshes: curvature in steps of 10 degrees, slenderness in steps of 10 %.
  std::uint32_t blade(double curvature_deg, double slenderness) {
    const int bend = static_cast<int>(std::lround(curvature_deg / 10)),
              slender = static_cast<int>(std::lround(std::log(slenderness) / 0.1));
    const auto [entry, fresh] = blades_.try_emplace({bend, slender}, 0u);
    if (fresh)
      entry->second = build_.add_mesh(
          blade_mesh(resample(g_.outline, g_.segments), {std::exp(0.1 * slender), radians(g_.fold_deg), radians(10.0 * bend)}));
    return entry->second;
  }

  void grow_tiller(const Stem& stem, long rank, const Vec3& position, const Vec3& side, std::uint32_t metamer) {
    Stem tiller;
    tiller.born = stem.born + g_.phyllochron * (static_cast<double>(rank) + g_.tiller_delay);
    if (tiller.born >= age_) return;
    tiller.order = stem.order + 1;
    tiller.key = mix(stem.key, 5, static_cast<std::uint64_t>(rank));
    RandomStream random(mix(tiller.key, 2));
    tiller.leaves = std::max(1L, std::lround(g_.tiller_leaves * static_cast<double>(stem.leaves - rank)));
    tiller.basal_nodes = stem.basal_nodes - static_cast<double>(stem.leaves - tiller.leaves);  // as many tall internodes as its stem
    tiller.scale = stem.scale * g_.tiller_scale * (1 + 0.08 * spread(random));
    tiller.tilt_rad = radians(g_.tiller_deg) * (0.7 + 0.3 * random.next());
    tiller.heading_rad = std::atan2(side.y, side.x) + radians(25) * spread(random);
    tiller.azimuth_rad = pi / 2 + radians(30) * spread(random);
    tiller.foot = position + (radius(stem, 0) + radius(tiller, 0)) * Vec3{std::cos(tiller.heading_rad), std::sin(tiller.heading_rad), 0};
    tiller.foot.z = std::max(tiller.foot.z, clearance_m + radius(tiller, 0));
    grow_stem(tiller, metamer, "tiller");
  }

  void grow_inflorescence(const Stem& stem, const Inflorescence& what, const Vec3& from, const Mat3& frame, const Vec3& side,
                          std::uint32_t metamer) {
    const double share = std::clamp((age_ - what.appears) / what.expansion, 0.3, 1.0), length = what.length_m * stem.scale * share;
    const auto [entry, fresh] = spikes_.try_emplace(&what, 0u);
    if (fresh)
      entry->second = build_.add_mesh(
          what.spikelets > 0 ? spike_mesh(what.radius_m / what.length_m, what.spikelets, what.awn_length_m / what.length_m)
                             : spindle_mesh(what.radius_m / what.length_m, what.radius_m < 0.008 ? 4 : 8, what.radius_m < 0.008 ? 3 : 6));
    const double angle = radians(what.insertion_deg);
    const Vec3 along = glm::normalize(std::cos(angle) * frame[2] + std::sin(angle) * side);
    const Mat3 own = organ_frame(along, frame[1]);
    const auto organ = build_.open(metamer, what.type, {own, from}, stem.order, stem.order, length);
    for (std::int64_t i = 0; i < what.spikes; ++i) {
      // The middle spike is straight; the others leave the axis at golden angles, the lower the wider.
      const double place = what.spikes > 1 ? static_cast<double>(i) / static_cast<double>(what.spikes - 1) : 0.0;
      const double out = radians(what.spread_deg) * std::sqrt(place), turn = radians(137.5) * static_cast<double>(i);
      const Vec3 d = own * Vec3{std::sin(out) * std::cos(turn), std::sin(out) * std::sin(turn), std::cos(out)};
      const Vec3 at = from + (what.spikes > 1 ? 0.35 * (1 - place) * length : 0.0) * own[2];
      const double size = length * (i == 0 ? 1.0 : 0.75 - 0.15 * place) * (what.spikes > 1 ? 0.65 : 1.0);
      build_.shape(organ, entry->second, "ear", {size * carried(own, d), at});
    }
  }

  const Species& species_;
  const CerealGrowth& g_;
  double age_;
  std::uint64_t seed_;
  PlantBuilder build_;
  std::size_t nodes_ = 0;
  std::map<std::pair<int, int>, std::uint32_t> blades_;
  std::map<const Inflorescence*, std::uint32_t> spikes_;
};

}  // namespace

Plant grow_cereal(const Species& species, const CerealGrowth& growth, double age, std::uint64_t seed) {
  return CerealGrower(species, growth, age, seed).run();
}

}  // namespace sunfleck
