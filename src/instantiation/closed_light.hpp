// Light in copies that are not opened.
#pragma once

#include <sunfleck/scene/solution.hpp>

#include "instantiation/copy_rows.hpp"
#include "instantiation/scene_light.hpp"

namespace sunfleck {

/// SolveReport::structures, and the balance of what `stop_at` names. A closed copy absorbs what its original does in the copy's fields, sun
/// and sky; copies too far away to be solved take the mean of those of the same plant that were.
void absorb_closed(const SceneLight& s, const Light& light, SolveReport& report);

/// What the structures of a copy that others stand in for absorbed when it was opened.
struct OpenedPieces {
  std::uint32_t copy = 0;
  std::vector<double> area;      ///< [pieces] one-sided [m^2]
  std::vector<double> absorbed;  ///< [pieces][columns] W
};

/// From the rows of an opened copy.
OpenedPieces opened_pieces(const SceneLight& s, std::uint32_t copy, const CopyRows& rows);

/// SolveReport::stand_in_rmse, stand_in_bias.
void judge_stand_ins(const SceneLight& s, const Light& light, const std::vector<OpenedPieces>& opened, SolveReport& report);

}  // namespace sunfleck
