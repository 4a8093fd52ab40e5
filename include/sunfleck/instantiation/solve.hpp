// Radiosity of a scene whose plants are copies of few originals: memory follows the originals, not the leaves.
#pragma once

#include <sunfleck/core/progress.hpp>
#include <sunfleck/instantiation/operator_store.hpp>
#include <sunfleck/policy/classes.hpp>
#include <sunfleck/scene/placed_scene.hpp>
#include <sunfleck/scene/run_settings.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// How finely an original is sampled by global lines.
struct OperatorDensity {
  std::uint32_t directions = 0;    ///< over the hemisphere [-]
  double lines_per_organ = 0;      ///< mean lines that meet an organ, per direction [-]
  std::uint32_t field_pixels = 0;  ///< K: fields of light that enter and leave have K x K pixels a direction [-]
  std::uint32_t points = 0;        ///< rays per pixel from a copy to what surrounds it [-]
};

struct InstantiationDensity {
  OperatorDensity coarse;          ///< for the iteration
  OperatorDensity fine;            ///< once, for the final gather
  double elements_per_organ = 0;   ///< elements of an organ of the mean size [-]
  std::uint32_t sun_samples = 0;   ///< points of the sun's disc [-]
  double sun_lines_per_organ = 0;  ///< over all sun samples together [-]
  std::uint32_t ground_rays = 0;   ///< per facet of the ground [-]
  double tolerance = 0;            ///< of the outer iteration: last change of the fields, extrapolated, over the fields [-]
  double inner_tolerance = 0;      ///< change of a sweep inside a copy over the radiosities [-]
};
InstantiationDensity instantiation_density(Quality quality);

/// Of the last gather of an original of which `opened` copies are opened: many share what its operator costs, so that for eight and more it
/// has twice the directions, as far as 320, with half the rays a pixel, which are traced from each copy.
OperatorDensity gather_density(const InstantiationDensity& density, std::size_t opened);

struct InstantiationSettings : SolveSettings {
  /// Which structures stand in for others until these are opened, for plants that name a policy and are placed once; null = none.
  const Classification* classes = nullptr;
  InstantiationDensity density = instantiation_density(Quality::standard);
  OperatorStore* store = nullptr;  ///< operators that are kept from solve to solve; null = none are
};

/// Throws InputError where a scene has what this method does not know: lamps, sensors.
void check_instantiable(const Scene& scene);

/// Solves E = E0 + F R E copy by copy. What is inside a copy is its original's line operator, traced once in the original's frame and
/// shared; what differs from copy to copy are small fields, the radiance that enters and leaves per direction and pixel of a coarse
/// grid over the original's silhouette (with one pixel: the phase function of Soler et al. 2003, doi:10.1145/636886.636893). Copies are
/// opened one by one, each once in every outer iteration and once at the end, when rows go to the sink in their order; nothing of a
/// copy but its fields stays in memory. docs/instantiation.md describes the method. Throws Stopped; InputError.
SolveReport solve_instantiation(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings, IrradianceSink& sink,
                                Progress& progress);

}  // namespace sunfleck
