// Light that leaves the points that camera rays meet, in natural colour.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sunfleck/view/colour.hpp>
#include <sunfleck/view/picture.hpp>
#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

/// How the sun's beam is drawn where the light has its direction and the sunlit fractions.
enum class Beam : std::uint8_t {
  traced,  ///< a shadow ray into the disc from the very point
  mean     ///< the side's stored sunlit fraction, no ray: quick
};

/// The stored light reduced to the bands that are drawn, the sun's mean share taken out of it where its beam is traced. Scene and
/// rays (which carry the shadows) must outlive it; all queries may run in any number of threads.
class NaturalLight {
 public:
  NaturalLight(const FacetScene& scene, const FacetLight& light, const RayScene& rays);

  /// Light that leaves the point and side that a camera ray meets. `bits`: random, of this ray alone.
  Rgb exitance(const RayHit& hit, std::uint64_t bits, Beam beam = Beam::traced) const;

  /// Ground that nothing but the drawn scene shades: mean diffuse light of the brightest fifth of the ground's cells, and the beam.
  void prepare_open_ground();
  Rgb open_ground(const Vec3& point, std::uint64_t bits, Beam beam = Beam::traced) const;

  bool sunny() const { return !sun_.empty(); }

 private:
  void add_traced_beam(const Vec3& point, const Vec3& normal, std::uint32_t from, std::uint64_t bits, float* irradiance) const;
  void add_mean_beam(const Vec3& normal, const std::array<float, 2>& sunlit, float* irradiance) const;

  const FacetScene& scene_;
  const RayScene& rays_;
  std::size_t b_ = 1;  ///< bands drawn: 3 or 1
  ColourBands bands_;
  std::vector<Optics> optics_;
  std::vector<Surface> surfaces_;
  std::vector<Vec3> normals_;
  std::vector<float> rest_;    ///< [n][3 corners][2][b_] irradiance without the sun's beam where that is traced
  std::vector<float> sunlit_;  ///< [n][2]; empty as sun_ is
  std::vector<float> sun_;     ///< [b_] on a plane that faces it; empty = not traced
  Vec3 sun_direction_{0, 0, 1}, sun_u_{1, 0, 0}, sun_v_{0, 1, 0};
  double sun_radius_ = 0;
  std::array<float, 6> open_{};
  std::uint32_t ground_material_ = 0;
};

/// Sky behind the scene, display light: decoration only.
Rgb sky_behind(const Vec3& direction, bool sunny);

}  // namespace sunfleck
