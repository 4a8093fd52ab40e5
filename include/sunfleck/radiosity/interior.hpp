// Which sides of organs face the inside of a hollow body.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/radiosity/elements.hpp>

namespace sunfleck {

/// Sides of organs that face the inside of a hollow body (stems are open tubes): at least 85 % of their lines end on the same side of
/// the same organ (30 % at least) or within a leaf's length, while the other side sees farther. Judged from 16 directions of lines `pitch`
/// apart [m]. [2 * organ + side]; empty if there is none.
std::vector<bool> interior_sides(const Elements& elements, double pitch, std::uint64_t seed, Progress& progress);

/// The same by sides of cells; empty if there is none.
std::vector<std::uint8_t> interior_of_cells(const Elements& elements, const std::vector<bool>& interior);

/// Calls enclose(k) for the hits of a line, n of them from one end to the other, that are enclosed: one of their sides, not being an
/// interior side itself, faces an interior side, as the base of a petiole does in a stem. `hit`: sides of cells that look along the line.
template <class Enclose>
void each_enclosed(const std::vector<std::uint8_t>& interior, const std::uint32_t* hit, std::uint32_t n, Enclose&& enclose) {
  for (std::uint32_t k = 1; k < n; ++k) {
    const bool low = interior[hit[k - 1]] != 0, high = interior[hit[k] ^ 1u] != 0;
    if (low && !high) enclose(k);
    if (high && !low) enclose(k - 1);
  }
}

}  // namespace sunfleck
