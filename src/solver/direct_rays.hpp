// Direct light of sun and sky by a few rays from every facet: rough for a facet, good for an organ of many, and quick where facets are
// many.
#pragma once

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/solution.hpp>
#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

struct DirectRaysSettings : SolveSettings {
  double rays_per_organ = 16;  ///< of each kind, where its facets are fewer than that; at least one from every facet
};

/// From points spread over each facet: rays to points of the sun's disc, and rays into the sky, even over its solid angle (R2 sequence
/// over the facets of the scene, so that those of an organ are spread evenly together): E = 2 pi / n sum of L(d) |n . d| on the side that
/// the ray leaves from. Rows as of method direct; lamps and sensors are left out. The balance counts what is not absorbed as escaped.
/// `rays`: of the facets.
SolveReport direct_by_rays(const Scene& scene, const FacetScene& facets, const RayScene& rays, const DirectRaysSettings& settings,
                           IrradianceSink& sink, Progress& progress);

}  // namespace sunfleck
