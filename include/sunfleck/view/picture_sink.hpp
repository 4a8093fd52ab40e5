// A picture that is made while a scene is solved, without a result file.
#pragma once

#include <cstddef>
#include <vector>

#include <sunfleck/scene/solution.hpp>
#include <sunfleck/view/picture.hpp>

namespace sunfleck {

/// Keeps the light of those facets that the camera sees, as rows come by, and hands all rows on. Memory: what DrawnScene holds, a bit a
/// facet while it looks, and 4 (2 b + 2) bytes for each facet of the runs of facets that are seen (b bands).
class PictureSink final : public IrradianceSink {
 public:
  /// Looks which facets the picture needs. `next` (null = nobody) gets all rows. Scene, placed scene and `next` must outlive it. Throws
  /// UsageError for impossible settings, InputError where there is nothing to draw, Stopped.
  PictureSink(const Scene& scene, const PlacedScene& placed, std::size_t state, const PictureSettings& settings, IrradianceSink* next,
              Progress& progress);

  void rows(const IrradianceRows& rows) override;
  /// The picture in natural colour, after the last row. Throws Error if rows that it needs have not come.
  Picture draw(Progress& progress) const;
  /// Facets whose light is kept.
  std::size_t kept() const { return ranges_.empty() ? 0 : ranges_.back().place + ranges_.back().count; }

 private:
  struct Range {
    std::size_t first, count, place;  ///< facets; where their values begin
  };
  LightSource source() const;
  std::vector<float> part(const std::vector<float>& values, std::size_t width, std::size_t first, std::size_t count) const;

  const Scene& scene_;
  std::size_t state_;
  PictureSettings settings_;
  IrradianceSink* next_;
  DrawnScene drawn_;
  std::vector<Range> ranges_;  ///< rising, apart
  std::vector<float> irradiance_, sunlit_;
  std::size_t arrived_ = 0;  ///< rows
  bool sun_came_ = false;    ///< rows say what the sun reaches: a method may leave it out
};

}  // namespace sunfleck
