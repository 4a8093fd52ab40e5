#include <sunfleck/occlusion/solve.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/scene/facet_rows.hpp>

#include "occlusion/stand.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t chunk = 65536, block = 1024;

void check_occludable(const Scene& scene) {
  if (!scene.sensors.empty())
    throw InputError(location(scene.file, 0, "sensor"), "a sensor with method 'occlusion'",
                     "clustering, flat, direct or reference, which know sensors");
  if (scene.periodic && !scene.periodic->is_level())
    throw InputError(location(scene.file, 0, "domain.slope"), "a slope with method 'occlusion'",
                     "instantiation, clustering, flat, direct or reference, which know slopes");
  if (std::none_of(scene.states.begin(), scene.states.end(), [](const LightState& s) { return s.sky.has_value(); }))
    throw InputError(location(scene.file, 0, "sky"), "no sky with method 'occlusion'",
                     "a sky in one state at least: it finds sky light alone");
}

class OcclusionSolver {
 public:
  OcclusionSolver(const Scene& scene, const PlacedScene& placed, const OcclusionSettings& settings, IrradianceSink& sink,
                  Progress& progress)
      : scene_(scene), rows_(scene, placed), settings_(settings), sink_(sink), progress_(progress), sources_(light_sources(scene.states)) {}

  SolveReport run() {
    check_occludable(scene_);
    report_.method = "occlusion";
    report_.balance.assign(states(), std::vector<Balance>(bands()));
    Stopwatch watch;
    const OccludedSky sky(rows_, sources_.skies, settings_.model);
    add_seconds(report_.timings, "crowns", watch.seconds());
    say(sky);
    report_.counts = {{"shells", sky.shells()}};
    report_.memory = {{"crowns", sky.bytes()}};
    watch = {};
    write(sky);
    add_seconds(report_.timings, "rows", watch.seconds());
    for (auto& state : report_.balance)  // what is not absorbed is not followed
      for (auto& b : state) b.escaped = b.incident - b.leaves - b.ground;
    return std::move(report_);
  }

 private:
  std::size_t states() const { return scene_.states.size(); }
  std::size_t bands() const { return scene_.band_count(); }

  void say(const OccludedSky& sky) {
    progress_.line(sky.is_layer() ? "crowns cover the ground: they are taken as a layer of leaves"
                                  : fmt::format("crowns: {} {}", sky.shells(), sky.shells() == 1 ? "shell" : "shells"));
    const auto has = [&](auto&& test) { return std::any_of(scene_.states.begin(), scene_.states.end(), test); };
    if (has([](const LightState& s) { return s.sun.has_value(); }) || !scene_.lamps.empty())
      progress_.line("note: method occlusion finds sky light alone: sun, lamps and scattered light are left out");
  }

  void write(const OccludedSky& sky) {
    const std::size_t n = rows_.placed().facets;
    std::vector<float> irradiance;
    std::vector<std::vector<Balance>> partial(chunk / block, std::vector<Balance>(states() * bands()));
    for (std::size_t first = 0; first < n; first += chunk) {
      progress_.check();
      progress_.fraction("occlusion", static_cast<double>(first) / static_cast<double>(n));
      const std::size_t count = std::min(chunk, n - first);
      irradiance.assign(states() * count * 2 * bands(), 0.0f);
      const std::size_t blocks = (count + block - 1) / block;
      tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
        std::fill(partial[b].begin(), partial[b].end(), Balance{});
        each_facet(first + b * block, std::min(block, count - b * block), sky,
                   [&](std::size_t row, double area, std::uint32_t material, bool plant, const double* light) {
                     store(row - first, count, area, material, plant, light, sky.skies(), irradiance, partial[b]);
                   });
      });
      for (std::size_t b = 0; b < blocks; ++b)
        for (std::size_t c = 0; c < partial[b].size(); ++c) {
          auto& sums = report_.balance[c / bands()][c % bands()];
          sums.incident += partial[b][c].incident, sums.leaves += partial[b][c].leaves, sums.ground += partial[b][c].ground;
        }
      sink_.rows({first, count, irradiance.data(), nullptr, nullptr});
    }
  }

  /// Calls visit(row, area, material, is of a plant, light on the two sides per sky).
  template <class Visit>
  void each_facet(std::size_t first, std::size_t count, const OccludedSky& sky, const Visit& visit) const {
    std::vector<double> light(2 * sky.skies());
    for (std::size_t row = first; row < first + count;) {
      const CopyFacet at = rows_.at(row);
      const std::size_t end = std::min<std::size_t>(first + count, rows_.first_facet(at.copy) + rows_.facet_count(at.copy));
      const bool ground = rows_.is_ground(at.copy);
      rows_.visit(at.copy, at.facet, at.facet + (end - row),
                  [&](std::uint64_t facet, const Triangle& t, std::uint32_t material, std::uint32_t) {
                    const Vec3 vector = area_vector(t);
                    const double area = glm::length(vector);
                    if (static_cast<float>(area) > 0.0f) {
                      if (ground)
                        sky.on_ground(t, vector / area, light.data());
                      else
                        sky.on_leaf(sky.shell_of(at.copy, facet), (t[0] + t[1] + t[2]) / 3.0, vector / area, light.data());
                      visit(rows_.first_facet(at.copy) + facet, area, material, !ground, light.data());
                    }
                  });
      row = end;
    }
  }

  void store(std::size_t i, std::size_t count, double area, std::uint32_t material, bool plant, const double* light, std::size_t skies,
             std::vector<float>& irradiance, std::vector<Balance>& sums) const {
    const auto& optics = rows_.materials()[material];
    for (std::size_t state = 0; state < states(); ++state) {
      const auto row = sources_.sky_of_state[state];
      if (row == LightSources::none) continue;
      for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t band = 0; band < bands(); ++band) {
          const auto e = static_cast<float>(light[side * skies + row] * scene_.states[state].sky->irradiance[band]);
          irradiance[((state * count + i) * 2 + side) * bands() + band] = e;
          const double kept = 1.0 - (side == 0 ? optics.reflectance_front : optics.reflectance_back)[band] - optics.transmittance[band];
          auto& balance = sums[state * bands() + band];
          balance.incident += area * e;
          (plant ? balance.leaves : balance.ground) += area * kept * e;
        }
    }
  }

  const Scene& scene_;
  const FacetRows rows_;
  const OcclusionSettings& settings_;
  IrradianceSink& sink_;
  Progress& progress_;
  const LightSources sources_;
  SolveReport report_;
};

}  // namespace

const std::vector<std::string>& occlusion_model_names() {
  static const std::vector<std::string> names{"table", "paper"};
  return names;
}

std::optional<OcclusionModel> occlusion_model_from_name(const std::string& name) {
  if (name == "table") return OcclusionModel::table;
  if (name == "paper") return OcclusionModel::paper;
  return std::nullopt;
}

SolveReport solve_occlusion(const Scene& scene, const PlacedScene& placed, const OcclusionSettings& settings, IrradianceSink& sink,
                            Progress& progress) {
  std::optional<tbb::global_control> control;
  if (settings.threads > 0) control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(settings.threads));
  return OcclusionSolver(scene, placed, settings, sink, progress).run();
}

}  // namespace sunfleck
