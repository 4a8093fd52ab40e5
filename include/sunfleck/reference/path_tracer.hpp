// The reference method: light on every facet by path tracing, with its variance.
#pragma once

#include <cstdint>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/solution.hpp>
#include <sunfleck/scene/facet_rows.hpp>
#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

struct ReferenceSettings : SolveSettings {
  /// Per facet, each one point with a path from its front and one from its back; rounded up to a multiple of the 16 randomisations.
  std::uint32_t samples = 256;
  /// The first so many facets are traced, the others only met by rays; there is no balance then. 0 = all.
  std::uint64_t facets = 0;
};

/// Independent randomisations from which variances come.
inline constexpr std::uint32_t reference_randomisations = 16;

/// Unbiased irradiance of every facet and side under all states (see PathSampler for the estimator), rows in order to the sink, in
/// blocks. The variance is that of the mean of the 16 randomisations; facets are sampled independently of each other, so the variance
/// of an organ's absorbed power is the sum over its facets of area^2 x variance. Facets without area are rows of zeros.
///
/// Balance: incident is the direct light on all facets, leaves and ground what they absorb, all from the paths; escaped is incident
/// times the share found by particles sent from sun and sky (PathSampler::escape_share), so that the residual is a true check: about
/// the noise of both. Same bits for any number of threads. Throws Stopped if the user cancels.
SolveReport trace_reference(const Scene& scene, const FacetScene& facets, const ReferenceSettings& settings, IrradianceSink& sink,
                            Progress& progress);
/// The same without writing copies out: memory of the plants, the ground and some 500 bytes a copy.
SolveReport trace_reference(const Scene& scene, const FacetRows& rows, const ReferenceSettings& settings, IrradianceSink& sink,
                            Progress& progress);

}  // namespace sunfleck
