// Light that leaves the points that camera rays meet, in natural colour, of a scene that is not written out.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sunfleck/view/colour.hpp>

#include "view/corner_fans.hpp"
#include "view/sight.hpp"

namespace sunfleck {

/// First every ray of the picture is announced by mark(), then read() fetches the light on what they meet, then exitance() may be asked for
/// the same rays. Scene, rays and light must outlive it; mark() and exitance() may be called in any number of threads.
class NaturalPaint {
 public:
  /// `most_bytes`: of values that are read whole, without asking what is seen.
  NaturalPaint(const DrawnScene& scene, const PlacedRays& rays, const LightSource& light, std::size_t most_bytes);

  /// False where mark() need not be called: all values fit.
  bool wants_marks() const { return !seen_.all(); }

  /// `pixel`: size of a pixel at the hit [m]. Facets smaller than that keep their own value, others are interpolated.
  void mark(const PlacedHit& hit, const Vec3& direction, double pixel);
  void mark_ground();
  void read(Progress& progress);

  /// Light that leaves the point and side that a camera ray meets. `bits`: random, of this ray alone.
  Rgb exitance(const PlacedHit& hit, const Vec3& direction, double pixel, std::uint64_t bits) const;
  /// Ground that nothing but the drawn scene shades: mean diffuse light of the brightest fifth of the ground's cells, and the beam. After
  /// mark_ground() and read().
  Rgb open_ground(const Vec3& point, std::uint64_t bits) const;

  bool sunny() const { return !sun_.empty(); }

 private:
  void prepare_open_ground();
  void add_beam(const Vec3& point, const Vec3& normal, std::size_t from, std::uint64_t bits, float* irradiance) const;
  const CornerFans::Piece* fans(const SurfacePoint& at, double pixel) const;

  const DrawnScene& scene_;
  const PlacedRays& rays_;
  const LightSource& light_;
  CornerFans fans_;
  std::vector<std::size_t> rows_;  ///< bands drawn: three or one
  SeenFacets seen_;
  ColourBands bands_;                              ///< of rows_
  std::vector<Optics> optics_;                     ///< of rows_
  std::vector<std::vector<SurfaceKind>> surface_;  ///< [plants][shapes]
  std::vector<float> rest_;                        ///< [seen][2][rows_] irradiance without the sun's mean share where its beam is traced
  std::vector<float> sun_;                         ///< [rows_] on a plane that faces it; empty = not traced
  Vec3 sun_direction_{0, 0, 1}, sun_u_{1, 0, 0}, sun_v_{0, 1, 0};
  double sun_radius_ = 0;
  bool ground_marked_ = false;
  std::array<float, 6> open_{};
};

/// Sky behind the scene, display light: decoration only.
Rgb sky_behind(const Vec3& direction, bool sunny);

}  // namespace sunfleck
