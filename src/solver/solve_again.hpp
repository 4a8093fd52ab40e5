// Where an error is wanted: what is done and said between one solve and the next.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/audit/certificate.hpp>
#include <sunfleck/audit/solve_difference.hpp>
#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/facet_rows.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/solution.hpp>

#include <sunfleck/solver/method_choice.hpp>
#include "solver/refinement.hpp"

namespace sunfleck {

/// Organs by which solves are compared: many more than a certificate traces, since they cost nothing.
std::vector<ChosenOrgan> organs_to_compare(const FacetRows& rows, const CertificateSettings& checking);

/// Rows of /organs of both, rising.
std::vector<std::uint64_t> rows_of(const std::vector<ChosenOrgan>& a, const std::vector<ChosenOrgan>& b);

/// Judges a solve by its certificate and by its distances to earlier ones; sets the fineness of the next one and returns true where one is
/// needed.
bool refine_further(const Scene& scene, const SolveReport& report, Certificate& certificate, const std::vector<SolveDifference>& to_earlier,
                    Refinement& refinement, MethodChoice& choice, Progress& progress);

/// What is said of a wanted error that no solve has reached.
std::string not_reached_text(const Scene& scene, const Refinement& refinement, const Certificate& certificate);

}  // namespace sunfleck
