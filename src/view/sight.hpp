// What the camera's rays meet: repetition, cut plane, and which facets are seen at all.
#pragma once

#include <vector>

#include <sunfleck/view/picture.hpp>
#include <sunfleck/view/placed_rays.hpp>

#include "view/layout.hpp"
#include "view/seen_facets.hpp"

namespace sunfleck {

class Sight {
 public:
  /// `views`: the first tells on which side a cut that faces the eye takes plants away.
  Sight(const DrawnScene& scene, const PlacedRays& rays, const PictureSettings& settings, const std::vector<View>& views);

  PlacedHit hit(const CameraRay& ray) const;
  /// Beyond it nothing is drawn: of scenes that repeat to the horizon [m].
  double far() const { return far_; }
  double haze_distance() const { return haze_; }
  double clear_distance() const { return clear_; }

 private:
  const PlacedRays& rays_;
  PlacedRays::Part part_;
  std::optional<PictureCut> cut_;
  double far_, haze_, clear_;
};

/// Reads values of those facets that are seen: row r of the answer is the facet of row r, `width` numbers each. Throws Error if a source
/// hands over too few.
std::vector<float> read_seen(const SeenFacets& seen, std::size_t facets, std::size_t width, const LightSource::Read& read,
                             Progress& progress, std::size_t block = std::size_t{1} << 17);

}  // namespace sunfleck
