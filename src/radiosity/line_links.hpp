// Links between element sides, counted from global lines.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>

#include "elements.hpp"

namespace sunfleck {

/// Form factors as counts: F_ij = count_ij / lines_i (Sbert 1993; Szirmay-Kalos & Purgathofer 1998). Rows are element sides,
/// 2 * element + (0 front, 1 back); count is symmetric; lines_i = sum_j count_ij + open_up_i + open_down_i.
struct LineLinks {
  std::vector<std::uint32_t> start;   ///< [sides + 1]
  std::vector<std::uint32_t> column;  ///< [links] rising within a row
  std::vector<float> count;           ///< [links]
  std::vector<float> lines;           ///< [sides]
  std::vector<float> open_up;         ///< [sides] lines that leave the scene towards the sky
  std::vector<float> open_down;       ///< [sides] lines that leave it below the horizon
  std::uint64_t fragments = 0;

  std::size_t sides() const { return lines.size(); }
  std::size_t bytes() const;
};

LineLinks line_links(const Elements& elements, const RadiositySettings& settings, Progress& progress);

}  // namespace sunfleck
