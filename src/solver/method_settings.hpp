// Settings of each method for a choice: one place for solves and for plans.
#pragma once

#include <cstdint>

#include <sunfleck/instantiation/solve.hpp>
#include <sunfleck/lattice/solve.hpp>
#include <sunfleck/occlusion/solve.hpp>
#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/reference/path_tracer.hpp>
#include <sunfleck/solver/method_choice.hpp>

namespace sunfleck {

/// The seed that a run says, or 1.
std::uint64_t seed_of(const RunSettings& run);

/// Policies' classes are left to the caller, who keeps them.
InstantiationSettings instantiation_settings(const MethodChoice& choice, const RunSettings& run);
/// Of clustering, flat and direct, and of the direct light that method lattice takes.
RadiositySettings radiosity_settings(const MethodChoice& choice, const RunSettings& run);
ReferenceSettings reference_settings(const RunSettings& run);
/// Throws UsageError for a mapping that does not exist.
LatticeSettings lattice_settings(const MethodChoice& choice, const RunSettings& run);
/// Throws UsageError for a model that does not exist.
OcclusionSettings occlusion_settings(const RunSettings& run);

}  // namespace sunfleck
