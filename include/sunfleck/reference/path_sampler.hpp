// Unbiased samples of the light on facets, by paths from them to sun and sky. Shared by the reference method and the certificate.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <sunfleck/scene/scene.hpp>
#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

/// Where samples start: points uniform over the area of some facets (one facet, or those of an organ). Facets without area must be
/// left out, unless all are: then nothing is sampled.
class SampleTarget {
 public:
  SampleTarget() = default;
  /// `key` chooses the random numbers: two targets with different keys are independent.
  SampleTarget(const RayScene& rays, std::vector<CopyFacet> facets, std::uint64_t key);

  double area() const { return cumulative_.empty() ? 0.0 : cumulative_.back(); }  ///< [m^2]
  std::uint64_t key() const { return key_; }
  /// The facet at the fraction x of the area, and where in [0, 1) x lies within it.
  CopyFacet facet_at(double x, double& within) const;

 private:
  std::vector<CopyFacet> facets_;
  std::vector<double> cumulative_;
  std::uint64_t key_ = 0;
};

/// Means over the samples of one randomisation. s states, b bands.
struct SampleMeans {
  std::vector<double> irradiance;  ///< [s][2][b] front, back, all light [W m^-2]
  std::vector<double> direct;      ///< [s][2][b] straight from sun, sky and lamps [W m^-2]
  std::vector<double> absorbed;    ///< [s][b] per one-sided area [W m^-2]
  std::vector<double> sunlit;      ///< [s][2] [-]
  std::uint64_t rays = 0;
};

/// E on a side at a point is the mean over cosine-weighted directions of pi L; L is the sky's radiance where a ray leaves the scene,
/// and B / pi of the side it meets otherwise, with B = rho E_h + tau E_o of the hit side h and its other side o. Direct sun is
/// added at every point by a shadow ray to a point of the disc (its centre, if the diameter is 0); at a hit the path goes on
/// with the reflected or the transmitted part, chosen in proportion to what all bands together carry, and carries one weight a band.
/// From half of the first weight on, a path is ended at random and the survivors weighted up (Russian roulette).
/// One path serves all bands and all states' skies; shadow rays go to each state's sun, and one to a point of a lamp; lamp faces that a
/// path crosses count too, each of the two weighted by how likely it is to find the light (balance heuristic).
///
/// The first dimensions (point and direction from either side; for the sun, point and place on the disc) are Owen-scrambled Sobol'
/// sequences per target and randomisation, the rest independent; numbers depend on (seed, key of the target, randomisation, sample) alone.
class PathSampler {
 public:
  /// Light of `scene` on the facets of `rays`; both must outlive the sampler.
  PathSampler(const Scene& scene, const RayScene& rays, std::uint64_t seed);
  ~PathSampler();

  std::size_t states() const;
  std::size_t bands() const;
  bool has_sun() const;  ///< in any state

  /// `count` samples, each one point with one path from its front and one from its back, and `sun_points` (at least 1) further
  /// points with shadow rays to the suns; as many rays go to lamps from the first point. Any number of threads may call it.
  void sample(const SampleTarget& target, std::uint32_t randomisation, std::uint32_t count, std::uint32_t sun_points,
              SampleMeans& means) const;

  /// Irradiance on a patch that is no facet, such as a cell of a sensor: adds the mean of `count` samples to sums [2][s][b] front, back
  /// [W m^-2]; the back only if `both`. Rays start `lift` [m] above the side.
  void sample_patch(const Patch& patch, bool both, double lift, std::uint64_t key, std::uint32_t count, double* sums,
                    std::uint64_t& rays) const;

  /// Share of the light that first meets facets or ground which leaves the scene again, per state and band [s][b] [-], from 16
  /// times `count` particles for each state's sun, sky and lamps, sent into the scene: an estimate independent of sample(), for the
  /// balance. 0 where no light comes in.
  struct Escape {
    std::vector<double> share, standard_error;
    std::uint64_t rays = 0;
  };
  Escape escape_share(std::uint32_t count) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace sunfleck
