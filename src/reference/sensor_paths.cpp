#include "sensor_paths.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/reference/path_tracer.hpp>

namespace sunfleck {

std::vector<SensorReading> sensor_readings(const Scene& scene, const Box& bounds, const PathSampler& sampler, std::uint32_t samples,
                                           std::uint64_t& rays, Progress& progress) {
  constexpr std::uint32_t n = reference_randomisations;
  const std::size_t states = sampler.states(), bands = sampler.bands(), values = 2 * states * bands;
  const auto& cell = scene.periodic;
  const Vec3 size = bounds.size();
  const double lift = 4e-6 * std::max({size.x, size.y, size.z, cell ? std::max(cell->width(), cell->depth()) : 0.0});
  std::vector<SensorReading> out;
  const auto sensors = place_sensors(scene, bounds);
  for (std::size_t index = 0; index < sensors.size(); ++index) {
    const auto& [entry, cells] = sensors[index];
    const bool both = entry->both_sides;
    std::uint64_t wanted = entry->samples;
    if (wanted == 0) wanted = std::uint64_t{samples} * (std::holds_alternative<SensorProfile>(entry->shape) ? 16 : 1);
    const auto count = static_cast<std::uint32_t>(std::min<std::uint64_t>((wanted + n - 1) / n, 1u << 26));
    auto& reading = out.emplace_back();
    reading.cells = cells;
    for (auto* v : {&reading.irradiance, &reading.standard_error}) v->assign(states * cells.size() * bands, 0.0f);
    if (both)
      for (auto* v : {&reading.back, &reading.back_standard_error}) v->assign(states * cells.size() * bands, 0.0f);
    const std::size_t block = std::clamp<std::size_t>(32768 / (std::size_t{count} * n), 1, 4096);
    std::vector<double> means;
    std::vector<std::uint64_t> traced;
    for (std::size_t first = 0; first < cells.size(); first += block) {
      progress.check();
      progress.fraction("sensors", static_cast<double>(first) / static_cast<double>(cells.size()));
      const std::size_t some = std::min(block, cells.size() - first);
      means.assign(some * n * values, 0.0);
      traced.assign(some * n, 0);
      tbb::parallel_for(std::size_t{0}, some * n, [&](std::size_t task) {
        if (progress.cancelled()) return;
        sampler.sample_patch(cells[first + task / n], both, lift, mix(mix(index, first + task / n), task % n), count, &means[task * values],
                             traced[task]);
      });
      for (const auto t : traced) rays += t;
      for (std::size_t i = 0; i < some; ++i)
        for (std::size_t side = 0; side < (both ? 2u : 1u); ++side)
          for (std::size_t s = 0; s < states; ++s)
            for (std::size_t b = 0; b < bands; ++b) {
              const auto value = [&](std::size_t r) { return means[(i * n + r) * values + (side * states + s) * bands + b]; };
              double sum = 0.0, square = 0.0;
              for (std::size_t r = 0; r < n; ++r) sum += value(r);
              for (std::size_t r = 0; r < n; ++r) square += (value(r) - sum / n) * (value(r) - sum / n);
              const std::size_t at = (s * cells.size() + first + i) * bands + b;
              (side == 0 ? reading.irradiance : reading.back)[at] = static_cast<float>(sum / n);
              (side == 0 ? reading.standard_error : reading.back_standard_error)[at] =
                  static_cast<float>(std::sqrt(square / (n * (n - 1.0))));
            }
    }
  }
  return out;
}

}  // namespace sunfleck
