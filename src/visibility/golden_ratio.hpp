// The golden ratio.
#pragma once

namespace sunfleck {

inline constexpr double golden_ratio_fraction = 0.6180339887498949;  ///< its multiples fill the unit interval evenly, however many

}  // namespace sunfleck
