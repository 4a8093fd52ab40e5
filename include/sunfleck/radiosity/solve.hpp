// Radiosity of a whole scene on one level: direct light, links from global lines, iteration, irradiance of every facet.
#pragma once

#include <string>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/radiosity/transport_store.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/run_settings.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

enum class RadiosityMethod {
  clustering,  ///< elements and clusters follow the structures; links at the level that an error estimate allows
  flat,        ///< every facet with every other it sees, no hierarchy
  direct       ///< sun and sky only, no scattering
};

/// Sampling densities; each quality has its own set (radiosity/quality.cpp).
struct RadiosityDensity {
  std::uint32_t directions = 0;      ///< global-line directions over the hemisphere [-]
  double lines_per_element = 0;      ///< mean lines that meet an element, per direction [-]
  double elements_per_organ = 0;     ///< elements of an organ of the mean size [-]
  std::uint32_t sky_directions = 0;  ///< directions for the sky's visibility, method direct alone: else the global lines bring it [-]
  double sky_lines_per_organ = 0;    ///< per direction [-]
  std::uint32_t sun_samples = 0;     ///< fewest points of the sun's disc, each with a grid of its own; more for wide penumbrae [-]
  double sun_lines_per_organ = 0;    ///< over all sun samples together [-]
  double link_error = 0;             ///< threshold of the refinement oracle, relative to the mean irradiance [-]
  double tolerance = 0;              ///< relative true residual of the iteration [-]
  double fewest_hits = 0;            ///< of global lines on plants, over all directions: small scenes get a finer grid [-]
  double fewest_organs = 1.0;        ///< that are reckoned with: few names are no reason for large elements; not by method flat [-]
  double least_unevenness =
      3e-3;  ///< of light within elements, from which on plants are cut by shades, see unevenness(); infinite: not looked for [-]
  bool sends_by_cell = true;  ///< where there are shades, scattered light leaves their cells as those are bright (Elements::emission)
};
RadiosityDensity density_of(Quality quality);

struct RadiositySettings : SolveSettings {
  RadiosityMethod method = RadiosityMethod::clustering;
  RadiosityDensity density = density_of(Quality::standard);
  TransportStore* store = nullptr;  ///< what is kept from solve to solve; null = nothing is
  std::string geometry;             ///< geometry_key() of the scene, with a store
};

/// Solves E = E0 + F R E for the irradiance E of both sides of every facet, all bands and lighting states together
/// (bi-Lambertian: B_f = rho_f E_f + tau E_b, B_b = rho_b E_b + tau E_f), and hands the rows to the sink in facet order.
/// docs/theory.md describes the method. Throws Stopped; InputError if there is nothing to project.
SolveReport solve_radiosity(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings, IrradianceSink& sink,
                            Progress& progress);

}  // namespace sunfleck
