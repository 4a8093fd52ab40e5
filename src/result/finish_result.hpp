// The parts of a result file that are known when the solve is over.
#pragma once

#include <sunfleck/result/certificate.hpp>
#include <sunfleck/result/plant_shares.hpp>
#include <sunfleck/scene/placed_scene.hpp>
#include <sunfleck/scene/solution.hpp>

#include "result/height_profile.hpp"
#include "result/row_dataset.hpp"

namespace sunfleck::h5 {

/// /balance, /convergence, /counts, /certificate, /timings, /memory and the status.
void write_report(OutputFile& file, ArrayWriter& arrays, const SolveReport& report, const Certificate* certificate,
                  const PlantShares& shares, const HeightProfile& profile, const std::string& power_unit);

/// /structures: what PlacedScene::closed absorbs. Nothing if there is none.
void write_structures(OutputFile& file, ArrayWriter& arrays, const SolveReport& report, const Scene& scene, const PlacedScene& placed);

}  // namespace sunfleck::h5
