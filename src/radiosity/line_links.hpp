// Links between element sides, counted from global lines.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>

#include "elements.hpp"

namespace sunfleck {

/// Form factors as counts: F_ij = count_ij / lines_i (Sbert 1993; Szirmay-Kalos & Purgathofer 1998). Rows are sides, 2 * part +
/// (0 front, 1 back); count is symmetric; lines_i = sum_j count_ij + open_up_i + open_down_i.
///
/// Parts are the elements, followed by the *enclosed parts* of those elements that stick in another organ, as the base of a petiole
/// does in a stem: where a line meets an element between two hits of one other organ, the hit belongs to the enclosed part. An element
/// that kept it would shine inside the organ that hides it; stems of a real plant then absorbed 20 % too much.
struct LineLinks {
  std::vector<std::uint32_t> start;    ///< [sides + 1]
  std::vector<std::uint32_t> column;   ///< [links] rising within a row
  std::vector<float> count;            ///< [links]
  std::vector<float> lines;            ///< [sides]
  std::vector<float> open_up;          ///< [sides] lines that leave the scene towards the sky
  std::vector<float> open_down;        ///< [sides] lines that leave it below the horizon
  std::vector<std::uint32_t> whole;    ///< [parts] the element that a part belongs to; part i < elements belongs to element i
  std::vector<std::uint32_t> enclosed_part;  ///< [elements] its enclosed part, or none; empty where no element has one
  std::vector<float> enclosed;         ///< [cells] fraction of a cell that is enclosed; empty where no element has an enclosed part
  std::uint64_t fragments = 0;
  static constexpr std::uint32_t none = 0xffffffffu;

  std::size_t sides() const { return lines.size(); }
  std::size_t bytes() const;
};

LineLinks line_links(const Elements& elements, const RadiositySettings& settings, Progress& progress);

}  // namespace sunfleck
