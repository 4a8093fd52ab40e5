// A low, dense stand as a layer of leaves, even in the horizontal.
#pragma once

#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/light/sky.hpp>

namespace sunfleck {

/// Leaf area over height.
class LeafProfile {
 public:
  LeafProfile(double low, double high, double ground_area);
  /// One-sided area at a height [m^2], [m].
  void add(double height, double area);
  void finish();
  /// k times the leaf area above a height, per ground area [-]: what light from the zenith meets.
  double above(double height) const;
  double whole() const { return above_.front(); }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  static constexpr std::size_t layers = 128;
  double low_, high_, ground_area_;
  std::vector<double> above_;  ///< [layers + 1] at the lower end of each layer, and 0
};

/// Irradiance in a layer under a sky, the mean over all azimuths:
///     E(tau, n) = integral of L(d) max(0, n . d) exp(-tau / cos zenith) over the sky,  tau: LeafProfile::above().
class LayerLight {
 public:
  LayerLight(const Sky& sky, double whole);
  /// On a side whose normal has the z given, over the sky's horizontal irradiance [-].
  double on(double normal_z, double above) const;

 private:
  static constexpr std::size_t depths = 48, tilts = 48;
  double from_above(double normal_z, double depth) const;
  bool round_;                 ///< light from below, too
  double whole_, deepest_;     ///< [-]
  std::vector<float> values_;  ///< [depths + 1][tilts + 1], even in the root of the depth
};

}  // namespace sunfleck
