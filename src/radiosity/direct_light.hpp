// Direct light of sun and sky on every cell, by parallel projection.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/core/timer.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/scene/solution.hpp>

#include <sunfleck/radiosity/elements.hpp>

namespace sunfleck {

/// Where light comes from, and what of it reaches each side of each cell. Side index: 2 * cell + (0 front, 1 back).
struct DirectLight {
  std::vector<std::uint32_t> sky_of_state;  ///< [s] row of `sky`, or none
  std::vector<std::uint32_t> sun_of_state;  ///< [s] row of `sunlit`, or none
  std::vector<std::vector<float>> sky;      ///< per distinct sky model: irradiance over the sky's horizontal irradiance [2 * cells]
  /// [2 * cells] cosine-weighted fraction of the side's hemisphere that is open sky; empty without sky, and where nothing is scattered.
  std::vector<float> sky_seen;
  std::vector<std::vector<float>> sunlit;      ///< per sun: fraction of the side that the sun reaches [2 * cells]
  std::vector<std::vector<float>> sun_cosine;  ///< per sun: cosine between each surface row's front normal and the sun [rows]
  /// Per sun: irradiance over that on a plane that faces the disc's centre [2 * cells]; empty for narrow discs, whose light is
  /// max(0, +-sun_cosine) x sunlit.
  std::vector<std::vector<float>> wide_sun;
  std::uint64_t fragments = 0;
  static constexpr std::uint32_t none = LightSources::none;

  std::size_t bytes() const;
};

/// What lines tell of the skies' light, summed over the lines of each cell, each weighted by the area that it stands for over the mean. All
/// figures of a cell stand together, as lines meet cells in no order.
class SkySums {
 public:
  SkySums() = default;
  SkySums(std::size_t cells, std::size_t skies) : skies_(skies), stride_(skies > 0 ? 3 + 2 * skies : 1), values_(cells * stride_, 0.0f) {}
  bool empty() const { return values_.empty(); }
  std::size_t cells() const { return stride_ > 0 ? values_.size() / stride_ : 0; }
  std::size_t skies() const { return skies_; }
  float& all(std::size_t cell) { return values_[cell * stride_]; }  ///< lines
  float all(std::size_t cell) const { return values_[cell * stride_]; }
  /// Lines on which a side sees the sky; row 1 + k: the same times pi x the radiance of sky k over its horizontal irradiance.
  float& seen(std::size_t cell_side, std::size_t row = 0) { return values_[(cell_side / 2) * stride_ + 1 + 2 * row + cell_side % 2]; }
  float seen(std::size_t cell_side, std::size_t row = 0) const { return values_[(cell_side / 2) * stride_ + 1 + 2 * row + cell_side % 2]; }
  void add(const SkySums& other) {
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += other.values_[i];
  }
  std::size_t bytes() const { return values_.capacity() * sizeof(float); }

 private:
  std::size_t skies_ = 0, stride_ = 0;
  std::vector<float> values_;
};

/// The skies' light on every cell from `sums` over lines; a side of area A meets A / area_of_line of them.
void sky_from_lines(const FacetScene& facets, const Elements& elements, const SkySums& sums, double area_of_line, DirectLight& direct);

/// The sun; the sky as well for method direct, and where all is black. Else the lines of scattered light bring the sky's, see
/// sky_from_lines().
DirectLight direct_light(const Scene& scene, const FacetScene& facets, const Elements& elements, const RadiositySettings& settings,
                         Timings& timings, Progress& progress);

}  // namespace sunfleck
