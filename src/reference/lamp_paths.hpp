// Lamps as paths meet them. Shares nothing with the radiosity methods but where the lamps are.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <sunfleck/scene/scene.hpp>
#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

/// Two ways to find the light of lamp faces, weighted against each other by the balance heuristic (Veach & Guibas 1995,
/// doi:10.1145/218380.218498): points drawn on lamps, and the rays of paths that cross a face on their way. Photometric lamps are found by
/// points drawn on their opening alone. In periodic scenes the point is drawn in one of the images, nearer ones more often.
class LampPaths {
 public:
  /// `clearance` [m]: what is nearer to a face's plane lies in it, as a lamp's housing does, and is not lit by it.
  LampPaths(const Scene& scene, double clearance);

  const Lamps& lamps() const { return lamps_; }
  const std::vector<double>& strength(std::uint32_t unit) const {
    return lamps_.units[unit].exitance.empty() ? lamps_.units[unit].power : lamps_.units[unit].exitance;
  }

  /// A point of a lamp seen from p. E on the side that it lights is the mean of factor x strength(unit) over draws that arrive.
  struct Draw {
    std::uint32_t unit = 0;
    bool on_front = true;
    Vec3 direction{0.0};
    double distance = 0;
    double factor = 0;  ///< 0: the lamp does not shine there
  };
  /// x [5] uniform in [0, 1); n the unit normal at p.
  Draw draw(const Vec3& p, const Vec3& n, const double* x) const;

  /// Calls met(unit, part) for every face that a ray from p crosses from its bright side within `range`; directions are drawn about n with
  /// a density of cos / pi, and part x exitance is what this one brings to the mean.
  template <class Met>
  void cross(const Vec3& p, const Vec3& n, const Vec3& d, double range, std::uint64_t& count, Met&& met) const {
    if (lamps_.faces.empty()) return;
    double before = 0.0;
    std::uint32_t start = no_facet;
    Vec3 from = p;
    for (int k = 0; k < 1000; ++k) {
      ++count;
      const RayHit hit = rays_->first_hit(from, d, start, range - before);
      if (!hit) return;
      before += hit.distance;
      start = hit.facet;
      const auto& c = lamps_.faces[start].corners;
      from = c[0] + hit.u * (c[1] - c[0]) + hit.v * (c[2] - c[0]);  // in a periodic scene, on the face as it is given
      if (hit.front && before * std::abs(glm::dot(lamps_.faces[start].normal, d)) > clearance_)
        met(lamps_.faces[hit.facet].unit, crossing_part(p, n, d, hit, before));
    }
  }

 private:
  double crossing_part(const Vec3& p, const Vec3& n, const Vec3& d, const RayHit& hit, double distance) const;
  /// Chance of the image (i, j) of something at `at`, seen from p.
  double image_chance(const Vec3& p, const Vec3& at, double i, double j) const;
  Vec3 nearest_image(const Vec3& p, const Vec3& at) const;  ///< cells along x and y

  const Lamps lamps_;
  const double clearance_;
  const std::optional<PeriodicCell> cell_;
  std::vector<double> cumulative_;  ///< of lamp_shares()
  std::vector<double> images_;      ///< chances of being so many cells from the nearest image, cumulative
  FacetScene faces_;
  std::unique_ptr<RayScene> rays_;
};

}  // namespace sunfleck
