// What lines say of light that comes straight from sun, lamps and sky, told apart from how bright these are.
#pragma once

#include <cstdint>
#include <vector>

#include "direct_light.hpp"
#include "near_links.hpp"

namespace sunfleck {

/// What of the skies comes along the lines of a direction, from above and from below, per line of mean area.
struct LineSky {
  float weight = 1.0f;  ///< area that a line stands for, relative to the mean
  std::vector<float> above, below;
};

/// Sunlight as it leaves each side of each cell [W m^-2].
struct SunReflection {
  std::vector<float> exitance;  ///< [2 * cells][columns]; empty without sun
  std::size_t columns = 0;
};

/// What one half of the lines brings of direct light, for the states of a solve.
struct HalfLight {
  SkySums sky;  ///< of the cells
  /// The sun's light after its first reflection, summed over the lines of each side: [sides][columns] [W m^-2 lines]. Taken cell by
  /// cell, where the elements only know a mean: sunlit parts shine more than shaded ones, and are seen more from outside.
  std::vector<float> first_reflection;
  std::vector<float>
      withheld_reflection;  ///< [sides of elements][columns] the same, summed over lines that find a side enclosed; empty if none
  std::vector<double> escaped_reflection;  ///< [columns] the same, summed over the lines on which it leaves the scene

  std::size_t bytes() const;
};

/// The same lines without any light: which cells each side meets, and where cells see out. Light of any states follows from it, up to the
/// order of sums.
struct DirectLines {
  NearLinks met;                    ///< [sides] the sides of cells that a side of a part meets, with numbers of lines
  NearLinks withheld;               ///< [sides of elements] its own cells' sides, on lines that find them enclosed; no rows if none
  std::vector<float> escapes;       ///< [2 * cells] lines on which what a cell's side sends leaves the scene
  NearLinks open;                   ///< [2 * cells] directions on which a cell's side sees out: 2 * direction + (0 up, 1 down)
  std::vector<float> lines;         ///< [cells] all lines, weighted by LineSky::weight; empty where neither skies nor enclosed cells ask
  struct Outside {                  ///< ground far from all: all of it is open
    std::uint32_t cell_side, open;  ///< as in `open`
    float lines;
  };
  std::vector<Outside> outside;

  HalfLight light(const SunReflection& sun, const std::vector<LineSky>& skies, std::size_t sky_count) const;
  std::size_t bytes() const;
};

}  // namespace sunfleck
