// Paths that start on the facets of an original and what they add to its tables.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sunfleck/original/measure.hpp>
#include <sunfleck/visibility/rays.hpp>

#include "original/harmonics.hpp"

namespace sunfleck {

/// In which functions of direction the tables are measured: harmonics up to an order, or values at fixed directions.
struct MeasureBasis {
  std::size_t order = 2;
  std::vector<Vec3> directions;  ///< empty = harmonics
  bool harmonic() const { return directions.empty(); }
  std::size_t size() const { return harmonic() ? harmonic_count(order) : directions.size(); }
};

/// Sums over samples, not yet divided by their number; n = basis.size().
struct PathSums {
  std::vector<double> sigma;        ///< [49] harmonics
  std::vector<double> intercepted;  ///< [n]
  std::vector<double> absorbed;     ///< [bands][n]
  std::vector<double> phase;        ///< [bands][n][n], not symmetric
  std::uint64_t samples = 0, rays = 0;
};

/// The estimator. With V_i(x) the irradiance that one side of a facet receives at x straight from a source of radiance Y_i (a basis
/// function),
///   sigma_i = integral over both sides of V_i dA,
///   S_ij = 1/pi integral over both sides of V_i(x) (reflection and all further bounces from x) V_j(y) dA.
/// A sample is a point x, uniform over the area. Rays with cosine density leave both sides: those that escape estimate V, in two
/// independent sets, so that products of two V are free of bias; one of those that are blocked goes on, and at every further vertex y rays
/// estimate V_j(y) and find the next one. All bands share the paths.
class PathMeasurement {
 public:
  /// `geometry` must outlive it. Throws InputError if there is no facet with an area.
  PathMeasurement(const OriginalGeometry& geometry, MeasureBasis basis);

  const MeasureBasis& basis() const { return basis_; }
  double area() const { return area_; }  ///< one-sided, all facets [m^2]
  PathSums no_sums() const;
  /// Adds samples [first, first + count) of one randomisation. Safe to call in any number of threads with sums of their own.
  void add(PathSums& sums, std::uint32_t first, std::uint32_t count, std::uint64_t seed, const Progress& progress) const;

 private:
  static constexpr std::size_t most_values = 66;
  static constexpr int most_rays = 4;
  using Values = std::array<double, most_values>;
  struct Side;
  struct Sample;
  struct Material {
    std::vector<double> reflectance[2], transmittance;  ///< [bands]; 0 = front
  };

  void gather(std::uint32_t facet, const Vec3& point, const Vec3& normal, double shift_x, double shift_y, int count, bool first, Side& side,
              std::uint64_t& rays) const;
  void fixed(std::uint32_t facet, const Vec3& point, const Vec3& normal, Side& front, Side& back, std::uint64_t& rays) const;
  void one(PathSums& sums, std::uint32_t n, std::uint64_t seed) const;

  const OriginalGeometry* geometry_;
  MeasureBasis basis_;
  FacetScene scene_;
  std::vector<Vec3> normals_;
  std::vector<double> cumulative_;  ///< [n + 1]
  double area_ = 0;
  std::vector<Material> materials_;
  std::unique_ptr<RayScene> rays_;
};

}  // namespace sunfleck
