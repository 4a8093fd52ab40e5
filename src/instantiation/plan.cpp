#include <sunfleck/instantiation/plan.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/plant/describe.hpp>
#include <sunfleck/scene/counts.hpp>

#include "instantiation/ground_light.hpp"
#include "instantiation/memory_count.hpp"
#include "instantiation/opening_steps.hpp"
#include "instantiation/operator_size.hpp"
#include "instantiation/outer_iteration.hpp"
#include "instantiation/scene_light.hpp"
#include "instantiation/sun_lines.hpp"

namespace sunfleck {

namespace {

constexpr std::uint64_t small_scene = 2'000'000;  // facets
constexpr std::uint64_t fewest_facets = 20'000;
constexpr std::uint32_t pilot_directions = 16;
constexpr std::uint64_t pilot_stream = 0x6b1d9f3a5c7e2841ULL;

std::uint64_t whole(double x) {
  return static_cast<std::uint64_t>(std::llround(std::max(x, 0.0)));
}

Members pilot_members(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings,
                      const InstantiationDensity& density, Progress& progress) {
  check_instantiable(scene);
  OperatorDensity pilot = density.coarse;
  pilot.directions = std::min(pilot.directions, pilot_directions);
  return make_members(scene, placed, settings.classes, pilot, density.elements_per_organ, settings.seed, progress);
}

InstantiationSharing sharing_of(const Members& members, const PlacedScene& placed) {
  InstantiationSharing out;
  out.originals = members.originals.size();
  out.copies = members.size();
  out.merged_copies = members.merged;
  out.tangled = members.tangled;
  for (const auto& o : members.originals) out.elements += o.elements.size();
  for (const auto& o : members.found.originals) out.unique_facets += o.facets;
  out.pieces = members.approximation.pieces.size();
  out.structures = members.approximation.closed;
  for (std::size_t m = 0; m < members.size(); ++m) out.copies_of_pieces += members.found.members[m].stands_in;
  for (std::size_t c = 0; c < placed.copies.size(); ++c) out.opened_alone += !members.approximation.of_plant[placed.plant_of(c)].empty();
  for (auto* n : {&out.copies, &out.merged_copies, &out.structures, &out.copies_of_pieces, &out.opened_alone})
    *n = whole(static_cast<double>(*n) / placed.share);
  return out;
}

/// Of the whole scene, where `placed` lists a part of it.
std::uint64_t facets_in_all(const PlacedScene& placed) {
  return whole(static_cast<double>(placed.solved_facets()) / placed.share);
}

/// Lines towards the sun that meet the cells of a member.
double sun_meetings(const OriginalLight& original, const Similarity& map, const Vec3& sun, double lines_per_area) {
  const auto& s = original.elements.surface;
  const Vec3 d = map.direction_back(sun);
  const double per_area = lines_per_area * map.scale * map.scale;
  double sum = 0;
  for (std::size_t t = 0; t < s.size(); ++t) {
    if (s.split[t] == 0) continue;
    const double cosine = std::fabs(s.normal[0][t] * d.x + s.normal[1][t] * d.y + s.normal[2][t] * d.z);
    sum += per_area * cosine * double{s.cell_area[t]} * (s.first_cell[t + 1] - s.first_cell[t]);
  }
  return sum;
}

/// Goes through a solve step by step, with sizes in place of the things themselves.
class Planner {
 public:
  Planner(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings, Progress& progress)
      : scene_(scene),
        placed_(placed),
        density_(adapted(settings.density, facets_in_all(placed))),
        seed_(settings.seed),
        tolerance_(settings.tolerance > 0 ? settings.tolerance : density_.tolerance),
        progress_(progress),
        states_(scene.states.size()),
        columns_(states_ * scene.band_count()),
        times_(1 / placed.share),
        lights_(light_sources(scene.states)),
        members_(pilot_members(scene, placed, settings, density_, progress)) {}

  InstantiationPlan run() {
    static_cast<InstantiationSharing&>(plan_) = sharing_of(members_, placed_);
    memory_.hold("plants", held_bytes(scene_));
    originals();
    sun();
    rays();
    iteration();
    opening();
    count("originals", static_cast<double>(plan_.originals));
    count("copies", static_cast<double>(plan_.copies));
    if (plan_.merged_copies > 0) count("merged_copies", static_cast<double>(plan_.merged_copies));
    count("elements", static_cast<double>(plan_.elements));
    count("links", links_);
    count("line_fragments", line_fragments_);
    count("rays", rays_);
    count("sun_fragments", sun_fragments_);
    count("gather_fragments", gather_fragments_);
    count("gather_rays", gather_rays_);
    plan_.links = whole(links_);
    plan_.memory = memory_.rows();
    return std::move(plan_);
  }

 private:
  static constexpr double lane_bytes = sizeof(float);

  void count(const char* name, double n) { plan_.counts.emplace_back(name, whole(n)); }
  void hold(const char* part, double bytes) { memory_.hold(part, whole(bytes)); }
  void pass(const char* part, double bytes) { memory_.pass(part, whole(bytes)); }

  LineOperator::Seen seen() const { return lights_.suns.empty() ? LineOperator::Seen::elements : LineOperator::Seen::cells; }

  /// What an original holds besides its operator.
  static double bare_bytes(const OriginalLight& o) { return static_cast<double>(o.bytes() - (o.coarse ? o.coarse->bytes() : 0)); }

  std::vector<const LineOperator*> ladder(const std::vector<LineOperator>& pilots) const {
    std::vector<const LineOperator*> out;
    for (const auto& p : pilots) out.push_back(&p);
    return out;
  }

  void originals() {
    double held = 0, pieces = 0, made_with = 0;  // operators are made one after the other
    for (const auto& piece : members_.approximation.pieces) pieces += static_cast<double>(held_bytes(*piece.plant));
    auto all = static_cast<double>(members_.bytes());
    all += (times_ - 1) * static_cast<double>(members_.size() * (sizeof(Similarity) + sizeof(SurfaceCopy)));
    for (std::size_t o = 0; o < members_.originals.size(); ++o) {
      const auto& original = members_.originals[o];
      const auto wanted = coarse_density(scene_, members_.found.originals[o], density_.coarse);
      auto half = wanted;
      half.directions = std::max(1u, original.coarse->directions() / 2);
      const LineOperator few(original.elements, original.interior, half, mix(seed_, pilot_stream, o), progress_);
      coarse_.push_back(operator_size({&few, original.coarse.get()}, wanted.directions));
      const auto& size = coarse_.back();
      links_ += size.links;
      line_fragments_ += size.fragments;
      all += size.bytes - static_cast<double>(original.coarse->bytes());
      made_with = std::max(made_with, pieces + held + bare_bytes(original) + size.built_with);
      held += bare_bytes(original) + size.bytes;
    }
    originals_ = all;
    hold("originals", all);
    pass("originals", made_with);
  }

  void sun() {
    if (lights_.suns.empty()) return;
    pitch_ = sun_pitches(members_, density_);
    const auto ground = shading_ground(scene_, members_);
    const double shade = ground ? static_cast<double>(ground->bytes()) : 0.0;
    double cells = 0;
    std::vector<double> of_member(members_.size(), 0.0);
    for (std::size_t m = 0; m < members_.size(); ++m) cells += static_cast<double>(members_.original_of(m).elements.surface.cells());
    cells *= times_;
    for (std::size_t k = 0; k < lights_.suns.size(); ++k) {
      hold("sun", shade + static_cast<double>(k + 1) * cells);
      pass("sun", shade + static_cast<double>(k + 5) * cells);  // two counts a cell
      tbb::parallel_for(std::size_t{0}, members_.size(), [&](std::size_t m) {
        of_member[m] = sun_meetings(members_.original_of(m), members_.maps[m], lights_.suns[k]->direction, lines_of_sun(pitch_[m]));
      });
      for (const double n : of_member) sun_fragments_ += times_ * n;
    }
  }
  double lines_of_sun(double pitch) const { return density_.sun_samples / (pitch * pitch); }

  void rays() {
    const MemberSurroundings around(members_);
    double ends = 0;
    for (std::size_t m = 0; m < members_.size(); ++m) ends += times_ * size_of(m).points;
    const auto ground = empty_ground_view(scene_, members_.copies.ground, lights_, rays_of_ground(members_, density_));
    sides_of_ground_ = static_cast<double>(ground.seen.size());
    rays_ = ends + sides_of_ground_ * ground.rays;
    constexpr double bytes_of_ground_part = 84;  // in the rays' tree
    const double of_ground = bytes_of_ground_part * static_cast<double>(members_.copies.ground.size());
    hold("rays", times_ * std::max(0.0, static_cast<double>(around.bytes()) - of_ground) + of_ground + static_cast<double>(ground.bytes()) +
                     ends * sizeof(RayEnd));
  }
  const OperatorSize& size_of(std::size_t m) const { return coarse_[members_.found.members[m].original]; }

  void iteration() {
    std::vector<std::uint32_t> all(members_.size());
    double fields = 0;
    for (std::uint32_t m = 0; m < all.size(); ++m) {
      all[m] = m;
      fields += times_ * static_cast<double>(size_of(m).fields);
    }
    hold("lanes", static_cast<double>(lanes_at_once(batches_of(members_, columns_, all), [&](const Batch& b) {
           return 2 * 2 * members_.originals[b.original].elements.size() + coarse_[b.original].fields;
         })));
    const double light = sizeof(float) * static_cast<double>(columns_) * (fields + sides_of_ground_);
    // the residual begins at 1 and loses a digit a pass; without scattering it is gone after the second
    const double passes = scatters(scene_) ? 1 + std::ceil(-std::log10(tolerance_)) : 2;
    hold("fields", (1 + std::min(passes, 1.0 + static_cast<double>(most_steps_of(whole(light))))) * light);
    hold("lanes", 0);
    hold("fields", light);
  }

  void opening() {
    const auto order = opening_steps(members_, placed_, states_, scene_.band_count());
    std::uint32_t fine_of = no_parent;
    OperatorSize fine;
    for (const auto& step : order.steps) {
      progress_.check();
      if (step.own != no_parent) {
        open_own(step.own);
        continue;
      }
      const auto& original = members_.originals[step.original];
      rows_of(step.members);
      if (fine_of != step.original) {
        fine_of = no_parent;
        hold("fine", 0);
      }
      const auto density = gather_density(density_, order.opened_of_original[step.original]);
      const auto stream = mix(seed_, pilot_stream + 1, step.original);
      if (step.once) {
        const auto pilots = pilots_of(original, density, 1, seen(), stream, progress_);
        fine = operator_size(ladder(pilots), density.directions, true);
        gather_fragments_ += fine.fragments;
        const auto& e = original.elements;
        const double width = lane_bytes * step.batches.front().width, sides = 2.0 * static_cast<double>(e.size());
        const double cells = seen() == LineOperator::Seen::cells ? 2.0 * static_cast<double>(e.surface.cells()) : 0.0;
        pass("fine", fine.built_with + width * ((LineVisitor::streams + 1) * sides + cells));
      } else if (fine_of == no_parent) {
        fine_of = step.original;
        const auto pilots = pilots_of(original, density, 3, seen(), stream, progress_);
        fine = operator_size(ladder(pilots), density.directions);
        gather_fragments_ += fine.fragments;
        pass("fine", fine.built_with);
        hold("fine", fine.bytes);
      }
      pass_lanes(step.batches, original, fine);
      gather_rays_ += times_ * static_cast<double>(step.members.size()) * fine.points;
      send();
      if (!step.last || !order.forgets) continue;
      originals_ += coarse_[step.original].kept - coarse_[step.original].bytes - bare_bytes(original);
      hold("originals", originals_);
    }
  }

  /// Lanes of batches that are opened, and where their rays end.
  void pass_lanes(const std::vector<Batch>& batches, const OriginalLight& original, const OperatorSize& fine) {
    const auto runs = runs_of_members(batches, 0, batches.size());
    pass("lanes",
         static_cast<double>(ends_at_once(batches, runs)) * fine.points * sizeof(RayEnd) +
             static_cast<double>(lanes_at_once(batches, [&](const Batch&) { return opening_lanes(original, seen(), fine.fields); })));
  }

  void open_own(std::uint32_t copy) {
    const std::uint32_t plant = placed_.plant_of(copy);
    const auto map = *similarity_of(placed_.map_of(copy));
    const auto& density = density_.fine;
    const Original found{{{plant, Affine{}}}, placed_.plant_facets[plant]};
    const auto original =
        original_light(scene_, members_.approximation, found, density_.elements_per_organ, density_.coarse, 0.0, seed_, progress_);
    const auto pilots = pilots_of(original, density, 3, LineOperator::Seen::elements, mix(seed_, pilot_stream + 2, copy), progress_);
    const auto size = operator_size(ladder(pilots), density.directions);
    double pitch = own_sun_pitch(original, map, density_);
    for (std::size_t m = 0; m < members_.size(); ++m)
      if (members_.found.members[m].stands_in && members_.found.members[m].copies.front() == copy) pitch = std::min(pitch, pitch_[m]);
    for (const auto* s : lights_.suns) sun_fragments_ += sun_meetings(original, map, s->direction, lines_of_sun(pitch));
    gather_fragments_ += size.fragments;
    gather_rays_ += size.points;
    const double bare = bare_bytes(original);
    pass("fine", bare + size.built_with);
    hold("fine", bare + size.bytes + static_cast<double>(lights_.suns.size() * original.elements.surface.cells()));
    wait(copy);
    hold("rows", times_ * waiting_bytes_);
    const auto lanes = lanes_at_once(batches_of_original(0, {0}, columns_),
                                     [&](const Batch&) { return opening_lanes(original, LineOperator::Seen::elements, size.fields); });
    pass("lanes", size.points * sizeof(RayEnd) + static_cast<double>(lanes));
    hold("fine", 0);
    send();
  }

  /// Rows of copies that wait until those before them are sent.
  void wait(std::uint32_t copy) {
    if (copy >= placed_.copies.size()) return;
    const double values = static_cast<double>(columns_ + (lights_.suns.empty() ? 0 : states_)) * 2;
    const std::uint64_t facets = placed_.plant_facets[placed_.copies[copy].plant];
    waiting_.emplace(placed_.copies[copy].first_facet, facets);
    waiting_bytes_ += values * sizeof(float) * static_cast<double>(facets);
  }
  void rows_of(const std::vector<std::uint32_t>& members) {
    for (const auto m : members)
      for (const auto c : members_.found.members[m].copies) wait(c);
    hold("rows", times_ * waiting_bytes_);
  }
  void send() {
    const double values = static_cast<double>(columns_ + (lights_.suns.empty() ? 0 : states_)) * 2;
    for (; !waiting_.empty() && waiting_.begin()->first == next_facet_; waiting_.erase(waiting_.begin())) {
      next_facet_ += waiting_.begin()->second;
      waiting_bytes_ -= values * sizeof(float) * static_cast<double>(waiting_.begin()->second);
    }
    hold("rows", times_ * waiting_bytes_);
  }

  const Scene& scene_;
  const PlacedScene& placed_;
  const InstantiationDensity density_;
  const std::uint64_t seed_;
  const double tolerance_;
  Progress& progress_;
  const std::size_t states_, columns_;
  const double times_;  ///< as many copies as those that are laid out
  const LightSources lights_;
  const Members members_;
  std::vector<OperatorSize> coarse_;  ///< [originals]
  MemoryCount memory_;
  std::vector<double> pitch_;  ///< of the sun's lines, member by member
  double originals_ = 0, sides_of_ground_ = 0;
  double links_ = 0, line_fragments_ = 0, rays_ = 0, sun_fragments_ = 0, gather_fragments_ = 0, gather_rays_ = 0;
  std::map<std::uint64_t, std::uint64_t> waiting_;  ///< first row -> rows
  std::uint64_t next_facet_ = 0;
  double waiting_bytes_ = 0;
  InstantiationPlan plan_;
};

}  // namespace

bool repeats(std::uint64_t facets, std::uint64_t unique) {
  return facets >= fewest_facets && facets >= 2 * unique;
}

bool repeats(const Scene& scene) {
  const auto counts = count(scene);
  return repeats(counts.plant_facets, counts.unique_facets);
}

InstantiationDensity adapted(InstantiationDensity density, std::uint64_t facets) {
  if (facets < small_scene) {
    density.coarse.directions *= 2;
    density.coarse.lines_per_organ *= 1.5;
  } else {
    density.fine.lines_per_organ *= 5.0 / 6.0;
    density.fine.field_pixels = std::min(density.fine.field_pixels, 8u);
    density.sun_samples = std::max(2u, density.sun_samples * 3 / 4);
    density.sun_lines_per_organ *= 0.25;
  }
  return density;
}

InstantiationSharing plan_sharing(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings,
                                  Progress& progress) {
  const auto density = adapted(settings.density, facets_in_all(placed));
  return sharing_of(pilot_members(scene, placed, settings, density, progress), placed);
}

InstantiationPlan plan_instantiation(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings,
                                     Progress& progress) {
  std::optional<tbb::global_control> control;
  if (settings.threads > 0) control.emplace(tbb::global_control::max_allowed_parallelism, settings.threads);
  return Planner(scene, placed, settings, progress).run();
}

}  // namespace sunfleck
