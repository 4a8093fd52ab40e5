// What a closed structure does to light: intercepted area, transmittance, bidirectional phase function.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/policy/policy.hpp>

namespace sunfleck {

/// Accuracy of one band of the tables, each relative to the root mean square of what it is about.
struct TableErrors {
  double sampling = 0;  ///< standard error of S as it is stored, over all pairs of directions
  double fit = 0;     ///< what the basis cannot show: rms of measured minus stored S over pairs of 66 directions, sampling noise taken out
  double energy = 0;  ///< before it was enforced: rms of (sum of S over b) - (sigma - absorbed), over that of sigma - absorbed
  double reciprocity = 0;  ///< before it was enforced: rms of S(a,b) - S(b,a), halved
};

/// Tables of an original in its own frame. All directions are unit vectors that point away from it: light that arrives *from* direction a,
/// light that leaves *towards* direction b.
///
/// sigma(a) [m^2]: power it intercepts per irradiance (on a plane facing a). absorbed(a) [m^2]: the part of sigma that it keeps.
/// S(a,b) [m^2 sr^-1]: intensity towards b per irradiance from a, all internal bounces included; light that crosses untouched is not part
/// of it. S(a,b) = S(b,a), integral of S(a,b) over b = sigma(a) - absorbed(a): both hold to rounding between `intercepted`, `absorbed` and
/// `phase` in the basis in which they are stored.
///
/// Coefficients f_i stand for f(w) = sum of f_i Y_i(w) (real spherical harmonics, orthonormal, index l^2 + l + m), or are values at
/// the 66 vertices of an octahedron split twice, linear between them. A truncated series may fall below zero where S is small.
struct OriginalTables {
  TableSettings::Basis basis = TableSettings::Basis::harmonics;
  std::uint32_t order = 2;  ///< of the harmonics
  std::uint32_t bands = 1;
  std::vector<double> sigma;        ///< [49] harmonics to order 6 in either basis: for sigma and transmittance by themselves
  std::vector<double> intercepted;  ///< [n] sigma in the basis of S
  std::vector<double> absorbed;     ///< [bands][n]
  std::vector<double> phase;        ///< [bands][n][n], symmetric
  std::vector<TableErrors> errors;  ///< [bands]
  double sigma_error = 0;           ///< standard error of sigma, relative
  std::vector<Triangle> hull;       ///< convex hull, fronts outwards [m]
  double area_m2 = 0;               ///< one-sided [m^2]
  std::uint64_t facets = 0;
  std::uint64_t samples = 0;  ///< points from which paths were followed
  std::uint64_t rays = 0;
  bool reached = true;  ///< false: the sampling error asked for was not reached within the limit of samples

  std::size_t size() const { return basis == TableSettings::Basis::harmonics ? (order + 1) * (order + 1) : 66; }
  double intercepted_area(const Vec3& w) const;                              ///< [m^2]
  double transmittance(const Vec3& w) const;                                 ///< 1 - sigma(w) / area of the hull seen along w, in [0, 1]
  double absorbed_area(const Vec3& a, std::uint32_t band) const;             ///< [m^2]
  double scattered(const Vec3& a, const Vec3& b, std::uint32_t band) const;  ///< S(a,b) [m^2 sr^-1]
  /// Absorbed and scattered share of intercepted light, means over the sphere [-].
  double albedo(std::uint32_t band) const;
};

/// Area of the projection of a convex hull along w [m^2]: half the sum of |facet . w|.
double projected_area(const std::vector<Triangle>& hull, const Vec3& w);

/// Tables of a copy whose frame is reached by `linear`: turned, mirrored, areas times the square of the scale. Harmonics turn exactly; the
/// 66 directions are read between and so blur a little, and energy and reciprocity are enforced again. Throws Error if `linear` shears or
/// stretches: such a copy needs an original of its own.
OriginalTables transformed(const OriginalTables& tables, const Mat3& linear);

/// Root mean square over all pairs of directions of the difference of two S of the same basis, order and bands, over that of `b`.
double phase_difference(const OriginalTables& a, const OriginalTables& b, std::uint32_t band);

}  // namespace sunfleck
