// Direct light of lamps on a piece of surface.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/radiosity/surroundings.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Fraction of the hemisphere about the unit vector n, weighted by cosine, that a triangle covers seen from p: Lambert's formula,
/// 1/(2 pi) sum over edges of (angle the edge spans) (n . unit normal of the plane through p and the edge), for the part of the triangle
/// above the horizon of n (Lambert 1760; Baum, Rushmeier & Winget 1989, doi:10.1145/74333.74367).
double view_factor(const Vec3& p, const Vec3& n, const Triangle& triangle);

/// E = U V: U the irradiance without anything in the way, from Lambert's formula for faces (I cos / r^2 for photometric lamps) at
/// points of the patch; V the visible part of it, from one shadow ray per point to a point of a lamp, both drawn in proportion to what
/// they give. Where nothing stands between, no error but that of points on the patch remains; where all is dark, none.
///
/// Of scenes with more than 32 lamp faces each point looks at 32, drawn in proportion to their power. In a periodic scene the lamps repeat
/// with the cell: each point looks at one image of the cell, drawn as the light of an even ceiling of lamps would arrive (images nearer to
/// the horizon than 0.06 degrees give nothing).
///
/// Points come from Owen-scrambled Sobol' sequences keyed by `key` alone: the same bits in any order of work.
class LampLight {
 public:
  /// The scene must have passed check_scene() and outlive this.
  explicit LampLight(const Scene& scene);

  bool empty() const { return lamps_.empty(); }
  const Lamps& lamps() const { return lamps_; }
  std::size_t bands() const { return bands_; }
  /// Values of on_patch(): [set][2][b].
  std::size_t values() const { return lamps_.sets.size() * 2 * bands_; }

  /// Adds share x irradiance on front and back of the patch to out [set][2][b] [W m^-2], from `rays` points. `start`: the facet that the
  /// patch is a piece of, or no_facet; `lift`: how far above either side shadow rays start [m].
  void on_patch(const Patch& patch, std::uint32_t start, double lift, std::uint32_t rays, std::uint64_t key, const Surroundings& scene,
                double share, double* out) const;

 private:
  struct Candidate;
  struct Image {
    Vec3 shift{0.0};
    double chance = 1.0;  ///< 0: none was found
  };
  Image draw_image(const Vec3& p, const Vec3& n, double x, double y) const;
  void candidates(const Vec3& p, const Vec3& n, double pick, double x, double y, double clearance, std::vector<Candidate>& out) const;

  const Lamps lamps_;
  const std::size_t bands_;
  const std::optional<PeriodicCell> cell_;
  std::vector<double> cumulative_;  ///< power of faces, then beams, all bands in equal parts
  std::vector<double> importance_;  ///< [faces, then beams] per view factor, or per intensity
  Vec3 centre_{0.0};                ///< of the lamps' power
};

}  // namespace sunfleck
