#include <sunfleck/radiosity/plan.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <sunfleck/radiosity/sensor_gather.hpp>
#include <sunfleck/light/wide_sun.hpp>

#include "cluster_tree.hpp"
#include "direct_light.hpp"
#include <sunfleck/radiosity/elements.hpp>
#include "lamp_cells.hpp"
#include "line_links.hpp"
#include "transport.hpp"

namespace sunfleck {

namespace {

/// Area of all cells, seen along a direction, or averaged over all directions [m^2].
double projected_area(const Elements& e, const Vec3* direction) {
  const auto& s = e.surface;
  double sum = 0;
  for (std::size_t t = 0; t < s.size(); ++t) {
    if (s.split[t] == 0) continue;
    double cosine = 0.5;
    if (direction) cosine = std::fabs(glm::dot(Vec3{s.normal[0][t], s.normal[1][t], s.normal[2][t]}, *direction));
    sum += cosine * static_cast<double>(s.cell_area[t]) * (s.first_cell[t + 1] - s.first_cell[t]);
  }
  return sum;
}

std::uint64_t whole(double x) {
  return static_cast<std::uint64_t>(std::llround(x));
}

/// What few directions show of the links.
struct Pilot {
  double fragments = 0, near_pairs = 0, near = 0, far = 0;
  std::uint64_t parts = 0, bytes_of_enclosed = 0;  ///< elements and their enclosed parts; which part is whose
  bool clustered = false;
};

class Planner {
 public:
  Planner(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings, Progress& progress)
      : scene_(scene),
        facets_(facets),
        settings_(settings),
        progress_(progress),
        columns_(scene.states.size() * facets.bands),
        elements_(make_elements(scene, facets, settings)) {}

  RadiosityPlan run() {
    plan_.elements = elements_.size();
    plan_.cells = elements_.surface.cells();
    plan_.memory.emplace_back("elements", elements_.bytes());
    direct();
    devices();
    if (settings_.method != RadiosityMethod::direct && anything_scatters(facets_)) scattering();
    return std::move(plan_);
  }

 private:
  static constexpr std::uint64_t word = sizeof(float);
  static constexpr std::uint64_t bytes_of_ray_facet = 300;  ///< about what Embree's tree and its copy of a triangle take

  void direct() {
    const auto sources = light_sources(scene_.states);
    const auto& density = settings_.density;
    const std::uint64_t sides = 2 * plan_.cells;
    std::uint64_t values = 0;
    skies_ = sources.skies.size();
    if (skies_ > 0) {
      if (settings_.method == RadiosityMethod::direct || !anything_scatters(facets_))
        plan_.sky_fragments =
            whole(projected_area(elements_, nullptr) * density.sky_directions * 2.0 * density.sky_lines_per_organ / elements_.patch_area);
      values += (plan_.sky_fragments > 0 ? skies_ : skies_ + 1) * sides;
    }
    for (const auto* sun : sources.suns) {
      plan_.sun_fragments += whole(projected_area(elements_, &sun->direction) * 2.0 * density.sun_lines_per_organ / elements_.patch_area);
      values += (sun->angular_diameter_deg > widest_narrow_sun_deg ? 2 : 1) * sides + elements_.surface.size();
    }
    sun_ = !sources.suns.empty();
    plan_.memory.emplace_back("direct", values * word);
  }

  /// Lamps and sensors, and the tree of rays that they share.
  void devices() {
    if (scene_.lamps.empty() && scene_.sensors.empty()) return;
    plan_.memory.emplace_back("tree of rays", facets_.size() * bytes_of_ray_facet);
    if (!scene_.lamps.empty()) {
      lamps_ = true;
      plan_.lamp_rays = lamp_rays(elements_, settings_.density);
      plan_.memory.emplace_back("lamps", place_lamps(scene_).sets.size() * 2 * plan_.cells * facets_.bands * word);
    }
    if (!scene_.sensors.empty())
      plan_.sensor_rays = sensor_rays(scene_, facets_.bounds, {sensor_samples(settings_.density), settings_.seed, true});
  }

  Pilot pilot(const ClusterTree* tree, std::uint32_t directions) const {
    RadiositySettings settings = settings_;
    settings.density.fewest_hits *= static_cast<double>(directions) / settings.density.directions;  // as many in each direction
    settings.density.directions = directions;
    const auto links = line_links(elements_, tree, {}, {}, settings, false, progress_);
    Pilot out;
    out.fragments = static_cast<double>(links.fragments);
    out.clustered = links.clustered;
    out.parts = links.whole.size();
    out.bytes_of_enclosed = (links.enclosed_part.size() + links.enclosed.size()) * word;
    for (const auto& half : links.half) {
      out.near += static_cast<double>(half.near.size());
      out.far += static_cast<double>(half.far.links.size());
      for (std::size_t i = 0; i < half.near.rows(); ++i)
        half.near.for_row(i, [&](std::uint32_t, std::uint32_t lines) { out.near_pairs += 0.5 * lines; });
    }
    return out;
  }

  void scattering() {
    std::optional<ClusterTree> tree;
    if (settings_.method == RadiosityMethod::clustering) tree = make_cluster_tree(facets_, elements_);
    // a tenth of the directions, and a quarter of these for how links grow with them: of later directions more find a pair that is known.
    // In a small scene soon most pairs are known; a quarter costs little there.
    const std::uint32_t pairs = settings_.density.directions / (plan_.elements < 5000 ? 8 : 20);
    const std::uint32_t pilot_directions = std::max(16u, 2 * pairs), fewer = pilot_directions / 8 * 2;
    const Pilot few = pilot(tree ? &*tree : nullptr, fewer), more = pilot(tree ? &*tree : nullptr, pilot_directions);
    if (tree && !more.clustered) tree.reset();
    plan_.clusters = tree ? tree->size() : 0;
    const double directions = settings_.density.directions, times = directions / pilot_directions;
    const double exponent =
        few.near > 0 ? std::clamp(std::log(more.near / few.near) / std::log(double(pilot_directions) / fewer), 0.0, 1.0) : 1.0;
    plan_.line_fragments = whole(more.fragments * times);
    const double near = more.near * std::pow(times, exponent), far = more.far * times;
    plan_.links = whole(near + far);

    const std::uint64_t sides = 2 * more.parts, slots = plan_.clusters * channels;
    // of each half: starts of the rows of near links, lines and how many of them are open; far lines of sides and nodes; the sun's first
    // reflection
    const std::uint64_t half =
        4 * sides * word + (tree ? sides * channels + 3 * slots * word : 0) + (sun_ || lamps_ ? sides * columns_ * word : 0);
    plan_.memory.emplace_back("links", 2 * half + whole(near * sizeof(std::uint32_t) + far * sizeof(std::uint32_t)) + more.parts * word +
                                           more.bytes_of_enclosed + (tree ? tree->bytes() : 0));
    // 5 fields of the solver, 1 and a basis of the iteration; how far the basis grows, the optics alone do not tell
    constexpr std::uint64_t fields_of_iteration = 5 + 1 + 6;
    plan_.memory.emplace_back("fields",
                              fields_of_iteration * sides * columns_ * word + (4 * sides + (tree ? 2 * slots * (1 + columns_) : 0)) * word);
    // a pair of sides waits in 8 bytes; all that a batch of directions meets is kept in full
    constexpr double bytes_of_pair = 8.0, bytes_of_meeting = 32.0;
    const double in_batch = std::min(directions, line_batch(plan_.elements, settings_.density)) / directions;
    plan_.memory.emplace_back("lines",
                              whole(more.near_pairs * times * bytes_of_pair + more.fragments * times * in_batch * bytes_of_meeting) +
                                  (sun_ || lamps_ ? 2 * plan_.cells * columns_ * word : 0) +
                                  (skies_ > 0 ? 2 * (3 + 2 * skies_) * plan_.cells * word : 0));
  }

  const Scene& scene_;
  const FacetScene& facets_;
  const RadiositySettings& settings_;
  Progress& progress_;
  const std::size_t columns_;
  const Elements elements_;
  bool sun_ = false, lamps_ = false;
  std::size_t skies_ = 0;
  RadiosityPlan plan_;
};

}  // namespace

RadiosityPlan plan_radiosity(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings, Progress& progress) {
  return Planner(scene, facets, settings, progress).run();
}

}  // namespace sunfleck
