#include <sunfleck/radiosity/solve.hpp>

#include <optional>

#include <tbb/global_control.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/radiosity/sensor_gather.hpp>
#include <sunfleck/scene/content.hpp>
#include <sunfleck/visibility/endless_light.hpp>

#include "light_rows.hpp"
#include "line_links.hpp"
#include "lit_elements.hpp"
#include "scattering.hpp"

namespace sunfleck {

namespace {

void put_density(ContentKey& key, const RadiosityDensity& d) {
  key.put(d.directions), key.put(d.lines_per_element), key.put(d.elements_per_organ), key.put(d.sky_directions);
  key.put(d.sky_lines_per_organ), key.put(d.sun_samples), key.put(d.sun_lines_per_organ), key.put(d.link_error), key.put(d.tolerance);
  key.put(d.fewest_hits), key.put(d.fewest_organs), key.put(d.least_unevenness), key.put(d.sends_by_cell);
}

class RadiositySolver {
 public:
  RadiositySolver(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings, IrradianceSink& sink, Progress& progress)
      : scene_(scene), facets_(facets), settings_(settings), sink_(sink), progress_(progress), lit_(scene, facets), lamps_(scene) {}

  SolveReport run() {
    if (facets_.zero_area_facets == facets_.size() && scene_.sensors.empty())
      throw InputError(location(scene_.file), "no facet with an area", "at least one that light can meet");
    report_.method = settings_.method == RadiosityMethod::direct ? "direct"
                     : settings_.method == RadiosityMethod::flat ? "flat"
                                                                 : "clustering";
    const bool scatter = settings_.method != RadiosityMethod::direct && anything_scatters(facets_);
    report_.balance.assign(lit_.states, std::vector<Balance>(lit_.bands));
    if (!scene_.lamps.empty() || !scene_.sensors.empty()) trace_rays();
    if (facets_.bounds.empty()) {  // sensors in an empty scene
      write_nothing();
      sensors();
      return std::move(report_);
    }
    Stopwatch watch;
    if (scatter) look_up_transport();
    if (kept_.found)
      lit_.elements = kept_.found->elements;
    else
      lit_.elements = make_elements(scene_, facets_, settings_);
    release_pages(lit_.elements);
    timed("elements", watch);
    kept_.seconds = watch.seconds();
    report_.counts.emplace_back("elements", lit_.elements.size());
    report_.counts.emplace_back("cells", lit_.elements.surface.cells());
    report_.memory.emplace_back("elements", lit_.elements.bytes());
    lit_.direct = direct_light(scene_, facets_, lit_.elements, settings_, report_.timings, progress_);
    report_.counts.emplace_back("direct_fragments", lit_.direct.fragments);
    if (!lamps_.empty() && scatter) check_lamplight_ends(scene_, *rays_);
    if (!lamps_.empty()) lamps();
    if (scatter)
      scattered_ = solve_scattering(lit_, settings_, kept_, report_, progress_);
    else {
      report_.memory.emplace_back("direct", lit_.direct.bytes());
      if (settings_.method != RadiosityMethod::direct) report_.convergence.push_back({0, 0, 0.0, 0, 0.0});  // all is black: E = E0
    }
    watch = {};
    row_of_facet_.resize(facets_.size());
    for (std::size_t t = lit_.elements.order.size(); t-- > 0;) row_of_facet_[lit_.elements.order[t]] = static_cast<std::uint32_t>(t);
    write_light_rows(lit_, scattered_, row_of_facet_, sink_, report_.balance, progress_);
    if (settings_.method == RadiosityMethod::direct)  // what is not absorbed is not followed: it counts as scattered out of the scene
      for (auto& state : report_.balance)
        for (auto& b : state) b.escaped = b.incident - b.leaves - b.ground;
    timed("rows", watch);
    if (!scene_.sensors.empty()) sensors();
    return std::move(report_);
  }

 private:
  void timed(const char* phase, const Stopwatch& watch) { add_seconds(report_.timings, phase, watch.seconds()); }

  void look_up_transport() {
    kept_.store = settings_.store;
    if (!kept_.store) return;
    ContentKey key("transport");
    key.put(settings_.geometry), key.put(settings_.method), key.put(settings_.seed);
    put_density(key, settings_.density);
    kept_.key = key.hex();
    kept_.found = kept_.store->entries().find(kept_.key);
  }

  /// The tree of rays that lamps and sensors need, and nothing else does.
  void trace_rays() {
    const Stopwatch watch;
    rays_.emplace(facets_);
    world_.emplace(facets_, *rays_, [this](std::uint32_t facet, bool front, double u, double v, float* values) {
      radiosity_at(facet, front, u, v, values);
    });
    report_.memory.emplace_back("tree of rays", rays_->bytes());
    timed("tree of rays", watch);
  }

  void lamps() {
    const Stopwatch watch;
    lit_.lamp = lamp_irradiance(lamps_, facets_, lit_.elements, settings_, *world_, progress_);
    report_.counts.emplace_back("lamp_rays", lit_.lamp.rays);
    report_.memory.emplace_back("lamps", lit_.lamp.bytes());
    timed("lamps", watch);
  }

  void sensors() {
    const Stopwatch watch;
    const SensorSettings settings{sensor_samples(settings_.density), settings_.seed,
                                  settings_.method != RadiosityMethod::direct && !facets_.bounds.empty()};
    report_.counts.emplace_back("sensor_rays", sensor_rays(scene_, facets_.bounds, settings));
    report_.sensors = read_sensors(scene_, place_sensors(scene_, facets_.bounds), lamps_, *world_, settings, progress_);
    timed("sensors", watch);
  }

  /// Radiosity of a side at a point of a facet, all columns.
  void radiosity_at(std::uint32_t facet, bool front, double u, double v, float* values) const {
    const auto [t, cell] = lit_.elements.place_of(row_of_facet_[facet], u, v);
    const auto& m = lit_.optics_of_row(t);
    for (std::size_t column = 0; column < lit_.columns(); ++column) {
      const std::size_t state = column / lit_.bands, band = column % lit_.bands;
      float light[2];
      for (std::size_t side = 0; side < 2; ++side)
        light[side] = lit_.sky(2 * cell + side, state, band) + lit_.sun(t, 2 * cell + side, state, band) +
                      lit_.lamps(2 * cell + side, state, band) + scattered_.on(lit_, cell, side, column);
      const float here = front ? light[0] : light[1], other = front ? light[1] : light[0];
      values[column] = (front ? m.reflectance_front : m.reflectance_back)[band] * here + m.transmittance[band] * other;
    }
  }

  /// Rows of facets without area.
  void write_nothing() {
    const std::vector<float> zeros(lit_.columns() * facets_.size() * 2, 0.0f);
    if (facets_.size() > 0) sink_.rows({0, facets_.size(), zeros.data(), nullptr, nullptr});
  }

  const Scene& scene_;
  const FacetScene& facets_;
  const RadiositySettings& settings_;
  IrradianceSink& sink_;
  Progress& progress_;
  LitElements lit_;
  KeptTransport kept_;
  ScatteredLight scattered_;
  const LampLight lamps_;
  std::optional<RayScene> rays_;
  std::optional<FacetSurroundings> world_;
  std::vector<std::uint32_t> row_of_facet_;
  SolveReport report_;
};

}  // namespace

SolveReport solve_radiosity(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings, IrradianceSink& sink,
                            Progress& progress) {
  std::optional<tbb::global_control> control;
  if (settings.threads > 0) control.emplace(tbb::global_control::max_allowed_parallelism, settings.threads);
  return RadiositySolver(scene, facets, settings, sink, progress).run();
}

}  // namespace sunfleck
