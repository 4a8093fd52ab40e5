// All crowns of a scene, and how much leaf area lies along rays between them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <sunfleck/occlusion/crown_shells.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Shells in the columns of a flat grid that they touch; in a periodic scene the grid is the cell, and rays go round it.
class ShellGrid {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  ShellGrid(std::vector<CrownShell> shells, const std::optional<PeriodicCell>& periodic);

  const std::vector<CrownShell>& shells() const { return shells_; }
  /// Sum of k times the length of the ray within each shell, but for `own` where the ray starts [-]. Beyond `opaque` it stops counting.
  double optical_depth(const Vec3& origin, const Vec3& direction, std::uint32_t own) const;
  static constexpr double opaque = 12.0;

  std::size_t bytes() const;

 private:
  struct Entry {
    std::uint32_t shell;
    std::int32_t image_x, image_y;  ///< periodic cells that it is moved by
  };
  double in_column(std::size_t column, const Vec3& origin, const Vec3& direction, double from, double to, std::array<std::int64_t, 2> wraps,
                   std::uint32_t own) const;
  void fill();

  std::vector<CrownShell> shells_;
  std::vector<double> extinction_;
  Box box_;  ///< of the grid; z of all shells
  std::array<std::int64_t, 2> cells_{1, 1};
  Vec3 cell_{1.0};  ///< [m]
  bool periodic_ = false;
  std::vector<std::uint32_t> first_;  ///< [columns + 1]
  std::vector<Entry> entries_;
};

}  // namespace sunfleck
