#include <sunfleck/solver/preview.hpp>

#include <algorithm>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <sunfleck/occlusion/solve.hpp>
#include <sunfleck/scene/facet_rows.hpp>
#include <sunfleck/visibility/rays.hpp>

#include "solver/prepared_scene.hpp"

namespace sunfleck {

namespace {

constexpr double scattered_share = 0.25;  // a first scattering on each side of leaves that half of the light meets
constexpr std::size_t dark_rows = 65536, facets_a_task = 1024;

/// [b] rho + tau of the plants, the mean over their facets.
std::vector<double> mean_albedo(const Scene& scene) {
  std::vector<double> sum(scene.band_count(), 0.0);
  double facets = 0.0;
  for (const auto& entry : scene.plants)
    for (std::size_t s = 0; s < entry.plant->shapes.size(); ++s) {
      const auto& o = scene.optics[entry.shape_optics[s]];
      const double n = entry.plant->shapes[s].triangle_count;
      for (std::size_t b = 0; b < sum.size(); ++b)
        sum[b] += n * (0.5 * (o.reflectance_front[b] + o.reflectance_back[b]) + o.transmittance[b]);
      facets += n;
    }
  for (auto& albedo : sum) albedo = facets > 0.0 ? albedo / facets : 0.0;
  return sum;
}

/// Adds sun and scattered light to rows of sky light.
class SunAdded final : public IrradianceSink {
 public:
  SunAdded(const Scene& scene, const FacetRows& rows, const RayScene* rays, IrradianceSink& next)
      : scene_(scene), rows_(rows), rays_(rays), next_(next), bands_(scene.band_count()) {
    const auto albedo = mean_albedo(scene);
    for (const auto& state : scene.states)
      for (std::size_t b = 0; b < bands_; ++b) {
        double horizontal = state.sky ? state.sky->irradiance[b] : 0.0;
        if (state.sun) horizontal += state.sun->irradiance[b] * std::max(0.0, state.sun->direction.z);
        scattered_.push_back(scattered_share * albedo[b] * horizontal);
        has_sun_ = has_sun_ || state.sun;
      }
  }

  void rows(const IrradianceRows& sky) override {
    const std::size_t states = scene_.states.size();
    irradiance_.assign(sky.irradiance, sky.irradiance + states * sky.count * 2 * bands_);
    if (has_sun_) sunlit_.assign(states * sky.count * 2, 0.0f);
    tbb::parallel_for(std::size_t{0}, (sky.count + facets_a_task - 1) / facets_a_task, [&](std::size_t b) {
      const std::size_t first = sky.first_facet + b * facets_a_task, end = std::min(sky.first_facet + sky.count, first + facets_a_task);
      for (std::size_t row = first; row < end;) {
        const CopyFacet at = rows_.at(row);
        const std::size_t last = std::min<std::size_t>(end, rows_.first_facet(at.copy) + rows_.facet_count(at.copy));
        rows_.visit(at.copy, at.facet, at.facet + (last - row), [&](std::uint64_t facet, const Triangle& t, std::uint32_t, std::uint32_t) {
          const Vec3 vector = area_vector(t);
          const double area = glm::length(vector);
          if (static_cast<float>(area) > 0.0f)
            add({at.copy, static_cast<std::uint32_t>(facet)}, rows_.first_facet(at.copy) + facet - sky.first_facet, sky.count,
                (t[0] + t[1] + t[2]) / 3.0, vector / area);
        });
        row = last;
      }
    });
    next_.rows({sky.first_facet, sky.count, irradiance_.data(), has_sun_ ? sunlit_.data() : nullptr, nullptr});
  }

 private:
  void add(CopyFacet facet, std::size_t i, std::size_t count, const Vec3& middle, const Vec3& normal) {
    for (std::size_t s = 0; s < scene_.states.size(); ++s) {
      const auto& sun = scene_.states[s].sun;
      const double cosine = sun ? glm::dot(normal, sun->direction) : 0.0;
      const std::size_t lit = cosine > 0.0 ? 0 : 1;
      const bool shines = sun && cosine != 0.0 && !(rays_ && rays_->occluded(middle, sun->direction, facet));
      if (shines) sunlit_[(s * count + i) * 2 + lit] = 1.0f;
      for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t b = 0; b < bands_; ++b) {
          double e = scattered_[s * bands_ + b];
          if (shines && side == lit) e += sun->irradiance[b] * std::abs(cosine);
          irradiance_[((s * count + i) * 2 + side) * bands_ + b] += static_cast<float>(e);
        }
    }
  }

  const Scene& scene_;
  const FacetRows& rows_;
  const RayScene* rays_;
  IrradianceSink& next_;
  const std::size_t bands_;
  bool has_sun_ = false;
  std::vector<double> scattered_;  ///< [s][b] [W m^-2]
  std::vector<float> irradiance_, sunlit_;
};

/// No sky: rows in the dark.
void write_dark(std::size_t facets, std::size_t columns, IrradianceSink& sink, Progress& progress) {
  const std::vector<float> dark(columns * 2 * std::min(dark_rows, facets), 0.0f);
  for (std::size_t first = 0; first < facets; first += dark_rows) {
    progress.check();
    sink.rows({first, std::min(dark_rows, facets - first), dark.data(), nullptr, nullptr});
  }
}

}  // namespace

SolveReport preview_light(const Scene& given, const PlacedScene& placed, const PreviewSettings& settings, IrradianceSink& sink,
                          Progress& progress) {
  std::optional<tbb::global_control> control;
  if (settings.threads > 0) control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(settings.threads));
  const PreparedScene prepared(given);
  const Scene& scene = prepared.scene();
  const FacetRows rows(scene, placed);
  std::optional<RayScene> rays;
  if (settings.trace_sun && placed.facets > 0) rays.emplace(rows);
  SunAdded all(scene, rows, rays ? &*rays : nullptr, sink);
  SolveReport report;
  if (std::any_of(scene.states.begin(), scene.states.end(), [](const LightState& s) { return s.sky.has_value(); })) {
    Scene outdoors = scene;  // sensors have no part in it
    outdoors.sensors.clear(), outdoors.lamps.clear();
    if (outdoors.periodic) outdoors.periodic->slope_x = outdoors.periodic->slope_y = 0;  // its images are drawn where they stand
    report = solve_occlusion(outdoors, placed, {settings, OcclusionModel::table}, all, silent());
  } else {
    report.balance.assign(scene.states.size(), std::vector<Balance>(scene.band_count()));
    write_dark(placed.facets, scene.states.size() * scene.band_count(), all, progress);
  }
  report.method = "preview";
  return report;
}

}  // namespace sunfleck
