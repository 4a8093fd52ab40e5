// A sky that is known at directions.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// Every point of the sky has the radiance of the direction that is nearest to it (the first of several): a direction stands for its
/// Voronoi cell.
class SkyTable {
 public:
  static constexpr std::size_t most_directions = 50'000;

  /// Unit vectors at or above the horizon, and their radiances, of which only the ratios count. Throws InputError(where) for others: none,
  /// too many, a direction twice, a radiance that is negative or not finite, or none above zero.
  SkyTable(std::vector<Vec3> directions, std::vector<double> radiances, const std::string& where);

  const std::vector<Vec3>& directions() const { return directions_; }
  const std::vector<double>& radiances() const { return radiances_; }
  std::uint32_t nearest(const Vec3& d) const;
  /// The radiance towards a unit vector above the horizon that lights a horizontal plane with 1 [sr^-1].
  double relative_radiance(const Vec3& d) const { return normalisation_ * radiances_[nearest(d)]; }
  bool operator==(const SkyTable& other) const { return directions_ == other.directions_ && radiances_ == other.radiances_; }

  /// Integral of radiance(d) x cos zenith over the cell of every direction [sr], by points spread evenly over the hemisphere: at least
  /// 400 a direction.
  std::vector<double> cell_integrals(const std::function<double(const Vec3&)>& radiance) const;
  /// How far the point of the hemisphere that is farthest from all directions is from the nearest [rad].
  double widest_gap() const;

 private:
  std::size_t place(const Vec3& d) const;
  void find_candidates();
  template <class Visit>
  void each_point(Visit&& visit) const;

  std::vector<Vec3> directions_;
  std::vector<double> radiances_;
  double normalisation_ = 1.0;
  std::uint32_t rings_ = 0;                        ///< of equal height; twice as many sectors
  std::vector<std::uint32_t> first_, candidates_;  ///< [ring][sector] directions that are the nearest to some point there
};

}  // namespace sunfleck
