#include "direct_lines.hpp"

#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>

namespace sunfleck {

namespace {

/// sum[rows][columns] of exitance over the cells' sides in the rows.
std::vector<float> sums_over(const NearLinks& rows, const SunReflection& sun) {
  const std::size_t n = sun.columns;
  std::vector<float> out(rows.rows() * n, 0.0f);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows.rows(), 256),
                    [&](const auto& range) { weighted_sums(rows, sun.exitance.data(), n, out.data(), range.begin(), range.end()); });
  return out;
}

}  // namespace

std::size_t HalfLight::bytes() const {
  return bytes_of(first_reflection) + bytes_of(withheld_reflection) + sky.bytes();
}

std::size_t DirectLines::bytes() const {
  return met.bytes() + withheld.bytes() + open.bytes() + bytes_of(escapes) + bytes_of(lines) + bytes_of(outside);
}

HalfLight DirectLines::light(const SunReflection& sun, const std::vector<LineSky>& skies, std::size_t sky_count) const {
  HalfLight out;
  if (!sun.exitance.empty()) {
    out.first_reflection = sums_over(met, sun);
    if (withheld.rows() > 0) out.withheld_reflection = sums_over(withheld, sun);
    out.escaped_reflection.assign(sun.columns, 0.0);
    for (std::size_t i = 0; i < escapes.size(); ++i)
      if (escapes[i] > 0.0f)
        for (std::size_t c = 0; c < sun.columns; ++c) out.escaped_reflection[c] += escapes[i] * sun.exitance[i * sun.columns + c];
  }
  if (lines.empty()) return out;
  out.sky = SkySums(lines.size(), sky_count);
  for (std::size_t c = 0; c < lines.size(); ++c) out.sky.all(c) = lines[c];
  if (sky_count == 0) return out;
  const auto see = [&](std::size_t cell_side, std::uint32_t direction, float count) {
    const LineSky& sky = skies[direction / 2];
    const auto& radiance = direction % 2 == 0 ? sky.above : sky.below;
    if (radiance.empty()) return;  // nothing shines from below
    out.sky.seen(cell_side) += sky.weight * count;
    for (std::size_t k = 0; k < radiance.size(); ++k) out.sky.seen(cell_side, 1 + k) += radiance[k] * count;
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, open.rows() / 2, 1024), [&](const auto& range) {
    for (std::size_t i = 2 * range.begin(); i < 2 * range.end(); ++i)
      open.for_row(i, [&](std::uint32_t direction, std::uint32_t count) { see(i, direction, static_cast<float>(count)); });
  });
  for (const auto& o : outside) see(o.cell_side, o.open, o.lines);
  return out;
}

}  // namespace sunfleck
