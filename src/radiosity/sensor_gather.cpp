#include <sunfleck/radiosity/sensor_gather.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_for.h>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/light/light_sources.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;
constexpr std::uint32_t randomisations = 8;
constexpr std::uint32_t profile_factor = 16;
constexpr std::uint64_t sensor_stream = 0x73656e736f72ULL;

class Gathering {
 public:
  Gathering(const Scene& scene, const LampLight& lamps, const Surroundings& surroundings, const SensorSettings& settings)
      : scene_(scene),
        lamps_(lamps),
        world_(surroundings),
        settings_(settings),
        sources_(light_sources(scene.states)),
        states_(scene.states.size()),
        bands_(scene.band_count()),
        columns_(states_ * bands_) {}

  std::size_t columns() const { return columns_; }

  /// Mean of one randomisation: sum [2][s * b] front, back.
  void measure(const Patch& patch, bool both, std::uint32_t count, std::uint64_t key, double* sum) const {
    const Vec3 n = patch.normal();
    if (n == Vec3{0.0}) return;
    for (std::size_t side = 0; side < (both ? 2u : 1u); ++side)
      gather(patch, side == 0 ? n : -n, count, mix(key, side), sum + side * columns_);
    for (std::size_t k = 0; k < sources_.suns.size(); ++k) sun(patch, n, k, both, count, mix(key, 2, k), sum);
    if (!lamps_.empty()) lamp(patch, both, count, mix(key, 3), sum);
  }

 private:
  void gather(const Patch& patch, const Vec3& n, std::uint32_t count, std::uint64_t key, double* sum) const {
    if (sources_.skies.empty() && !settings_.scattered) return;
    thread_local std::vector<float> met;
    thread_local std::vector<double> sky;
    met.resize(columns_);
    sky.assign(sources_.skies.size(), 0.0);
    const auto scramble = static_cast<std::uint32_t>(key);
    Vec3 a, b;
    orthonormal_frame(n, a, b);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double u = sobol_owen(i, 2, scramble), azimuth = 2.0 * pi * sobol_owen(i, 3, scramble), r = std::sqrt(u);
      const Vec3 d = r * std::cos(azimuth) * a + r * std::sin(azimuth) * b + std::sqrt(1.0 - u) * n;
      const Vec3 from = patch.point(sobol_owen(i, 0, scramble), sobol_owen(i, 1, scramble)) + world_.clearance() * n;
      if (settings_.scattered) {
        if (world_.radiosity(from, d, met.data())) {
          for (std::size_t c = 0; c < columns_; ++c) sum[c] += double{met[c]} / count;
          continue;
        }
      } else if (world_.blocked(from, d, no_facet, std::numeric_limits<double>::infinity())) {
        continue;
      }
      for (std::size_t k = 0; k < sky.size(); ++k) sky[k] += pi * sources_.skies[k]->relative_radiance(d) / count;
    }
    for (std::size_t s = 0; s < states_; ++s)
      if (const auto k = sources_.sky_of_state[s]; k != LightSources::none)
        for (std::size_t band = 0; band < bands_; ++band) sum[s * bands_ + band] += sky[k] * scene_.states[s].sky->irradiance[band];
  }

  void sun(const Patch& patch, const Vec3& n, std::size_t k, bool both, std::uint32_t count, std::uint64_t key, double* sum) const {
    const Sun& sun = *sources_.suns[k];
    const double cos_radius = std::cos(0.5 * sun.angular_diameter_deg * pi / 180.0);
    Vec3 across, along;
    orthonormal_frame(sun.direction, across, along);
    const auto scramble = static_cast<std::uint32_t>(key);
    double lit[2] = {0.0, 0.0};
    for (std::uint32_t i = 0; i < count; ++i) {
      Vec3 d = sun.direction;
      if (cos_radius < 1.0) {
        const double c = 1.0 - sobol_owen(i, 2, scramble) * (1.0 - cos_radius), r = std::sqrt(std::max(0.0, 1.0 - c * c));
        const double azimuth = 2.0 * pi * sobol_owen(i, 3, scramble);
        d = glm::normalize(r * std::cos(azimuth) * across + r * std::sin(azimuth) * along + c * sun.direction);
      }
      const double cosine = glm::dot(d, n);
      const std::size_t side = cosine > 0.0 ? 0 : 1;
      if (cosine == 0.0 || (side == 1 && !both) || (scene_.periodic && scene_.periodic->above(d) <= 0.0)) continue;
      const Vec3 from =
          patch.point(sobol_owen(i, 0, scramble), sobol_owen(i, 1, scramble)) + (side == 0 ? 1.0 : -1.0) * world_.clearance() * n;
      // The sun's irradiance is on a plane that faces the disc's centre, where its mean cosine is (1 + cos radius) / 2.
      if (!world_.blocked(from, d, no_facet, std::numeric_limits<double>::infinity()))
        lit[side] += std::abs(cosine) * 2.0 / (1.0 + cos_radius) / count;
    }
    for (std::size_t s = 0; s < states_; ++s)
      if (sources_.sun_of_state[s] == k)
        for (std::size_t side = 0; side < (both ? 2u : 1u); ++side)
          for (std::size_t band = 0; band < bands_; ++band)
            sum[side * columns_ + s * bands_ + band] += lit[side] * scene_.states[s].sun->irradiance[band];
  }

  void lamp(const Patch& patch, bool both, std::uint32_t count, std::uint64_t key, double* sum) const {
    thread_local std::vector<double> light;
    light.assign(lamps_.values(), 0.0);
    lamps_.on_patch(patch, no_facet, world_.clearance(), count, key, world_, 1.0, light.data());
    for (std::size_t s = 0; s < states_; ++s)
      if (const auto set = lamps_.lamps().set_of_state[s]; set != Lamps::none)
        for (std::size_t side = 0; side < (both ? 2u : 1u); ++side)
          for (std::size_t band = 0; band < bands_; ++band)
            sum[side * columns_ + s * bands_ + band] += light[(2 * set + side) * bands_ + band];
  }

  const Scene& scene_;
  const LampLight& lamps_;
  const Surroundings& world_;
  const SensorSettings& settings_;
  const LightSources sources_;
  const std::size_t states_, bands_, columns_;
};

}  // namespace

std::uint32_t sensor_samples(const RadiosityDensity& density) {
  return std::bit_ceil(4 * density.sky_directions);
}

std::uint32_t sensor_samples(const SensorEntry& sensor, const SensorSettings& settings) {
  std::uint64_t samples = sensor.samples;
  if (samples == 0) samples = std::uint64_t{settings.samples} * (std::holds_alternative<SensorProfile>(sensor.shape) ? profile_factor : 1);
  return static_cast<std::uint32_t>(std::min<std::uint64_t>((samples + randomisations - 1) / randomisations * randomisations, 1u << 30));
}

std::uint64_t sensor_rays(const Scene& scene, const Box& bounds, const SensorSettings& settings) {
  std::uint64_t rays = 0;
  for (const auto& sensor : place_sensors(scene, bounds))
    rays += std::uint64_t{sensor.cells.size()} * (sensor.entry->both_sides ? 2 : 1) * sensor_samples(*sensor.entry, settings);
  return rays;
}

std::vector<SensorReading> read_sensors(const Scene& scene, const std::vector<PlacedSensor>& sensors, const LampLight& lamps,
                                        const Surroundings& surroundings, const SensorSettings& settings, Progress& progress) {
  const Gathering gathering(scene, lamps, surroundings, settings);
  const std::size_t columns = gathering.columns(), bands = scene.band_count();
  std::vector<SensorReading> readings;
  for (std::size_t sensor = 0; sensor < sensors.size(); ++sensor) {
    const auto& [entry, cells] = sensors[sensor];
    const bool both = entry->both_sides;
    const std::uint32_t count = sensor_samples(*entry, settings) / randomisations;
    auto& reading = readings.emplace_back();
    reading.cells = cells;
    for (auto* values : {&reading.irradiance, &reading.standard_error}) values->assign(columns * cells.size(), 0.0f);
    if (both)
      for (auto* values : {&reading.back, &reading.back_standard_error}) values->assign(columns * cells.size(), 0.0f);
    // in blocks of some 10^5 rays, so that the user is heard
    const std::size_t block = std::clamp<std::size_t>(100000 / (std::size_t{count} * randomisations), 1, 4096);
    std::vector<double> means;  // [cell of the block][randomisation][2][s * b]
    for (std::size_t first = 0; first < cells.size(); first += block) {
      progress.check();
      progress.fraction("sensors", static_cast<double>(first) / static_cast<double>(cells.size()));
      const std::size_t n = std::min(block, cells.size() - first);
      means.assign(n * randomisations * 2 * columns, 0.0);
      tbb::parallel_for(std::size_t{0}, n * randomisations, [&](std::size_t task) {
        const std::uint64_t key = mix(mix(settings.seed, sensor_stream, sensor), first + task / randomisations, task % randomisations);
        if (!progress.cancelled()) gathering.measure(cells[first + task / randomisations], both, count, key, &means[task * 2 * columns]);
      });
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t side = 0; side < (both ? 2u : 1u); ++side)
          for (std::size_t c = 0; c < columns; ++c) {
            double sum = 0.0, square = 0.0;
            const auto mean_of = [&](std::size_t r) { return means[((i * randomisations + r) * 2 + side) * columns + c]; };
            for (std::size_t r = 0; r < randomisations; ++r) sum += mean_of(r);
            const double mean = sum / randomisations;
            for (std::size_t r = 0; r < randomisations; ++r) square += (mean_of(r) - mean) * (mean_of(r) - mean);
            const std::size_t at = (c / bands * cells.size() + first + i) * bands + c % bands;
            (side == 0 ? reading.irradiance : reading.back)[at] = static_cast<float>(mean);
            (side == 0 ? reading.standard_error : reading.back_standard_error)[at] =
                static_cast<float>(std::sqrt(square / (randomisations * (randomisations - 1.0))));
          }
    }
  }
  if (!sensors.empty()) progress.fraction("sensors", 1.0);
  return readings;
}

}  // namespace sunfleck
