// The colour that a camera ray of the viewer sees.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "view/viewer_view.hpp"

namespace sunfleck {

/// Colours of a difference: blue below zero, red above, grey at zero; even in lightness. Moreland 2009, doi:10.1007/978-3-642-10520-3_9
/// (the end colours 59 76 192 and 180 4 38 and the middle 221 of its table, interpolated by us in linear light). t in [0, 1].
Rgb8 difference_color(double t);

/// The scale of a view: the chosen range, or the one its values suggest; of a difference, even about zero.
struct ShownMap {
  std::shared_ptr<const ViewerMap> map, subtracted;  ///< subtracted: of the first result, where a difference is shown
  ValueScale scale;
  bool diverging = false;
  /// NaN where there is nothing.
  float value(std::size_t facet, bool front) const;
};
ShownMap shown_map(const ViewerScenes& scenes, std::size_t result, const ShownQuantity& shown, bool logarithmic,
                   const std::optional<std::array<double, 2>>& range);

class ViewerShader {
 public:
  /// `quick`: light as stored, no rays for shadows.
  ViewerShader(const ViewerScenes& scenes, const ViewerView& view, bool quick);

  /// Display light in [0, 1], linear sRGB; `facet` becomes what is met, or no_facet. From any number of threads.
  Rgb operator()(const CameraRay& ray, std::uint64_t bits, std::uint32_t& facet) const;
  /// The facet that a ray shows: what is cut away or hidden is passed through.
  RayHit first_shown(const CameraRay& ray) const;
  /// True if light and shadows are the final ones; a quick shader, and one made before the background work is done, draws drafts.
  bool fine() const { return fine_; }
  const ShownMap& shown() const { return shown_; }

 private:
  Rgb natural(const RayHit& hit, const Vec3& direction, std::uint64_t bits) const;
  Rgb mapped(const RayHit& hit, const Vec3& direction) const;
  Rgb background(const CameraRay& ray, std::uint64_t bits) const;
  void expose();

  const ViewerScene& scene_;
  ViewerView view_;
  bool colour_, fine_ = true;
  std::vector<std::uint8_t> selected_;
  ShownMap shown_;
  std::vector<Rgb> ramp_, categories_;
  std::shared_ptr<const ViewerLight> light_;
  std::shared_ptr<const NaturalPaint> natural_;
  Exposure exposure_;
  double ground_height_ = 0, pixel_ = 0;  ///< pixel_: size of a pixel, at 1 m in perspective [m]
  bool open_ground_ = false;
  bool choosy_ = false;  ///< some facets are not selected
};

}  // namespace sunfleck
