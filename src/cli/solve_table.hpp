// What a solve prints on standard output: the balance of every state and band, and the certified error.
#pragma once

#include <sunfleck/result/certificate.hpp>
#include <sunfleck/result/plant_shares.hpp>
#include <sunfleck/scene/run_settings.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// `certificate` and `shares` may be null.
void print_solve_table(const Scene& scene, const Depth& depth, const SolveReport& report, const Certificate* certificate,
                       const PlantShares* shares);

}  // namespace sunfleck
