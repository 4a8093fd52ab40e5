// Method lattice: direct light by method direct, scattered light by the lattice.
#pragma once

#include <sunfleck/lattice/solve.hpp>
#include <sunfleck/radiosity/solve.hpp>

namespace sunfleck {

/// Direct light by method direct with the settings given; `rough`: by few rays instead, where plants are copied and there are no lamps and
/// no skies with detail (direct_by_rays()). Throws InputError for scenes with sensors.
SolveReport solve_with_lattice(const Scene& scene, const PlacedScene& placed, const FacetScene& facets, const RadiositySettings& direct,
                               bool rough, const LatticeSettings& lattice, IrradianceSink& sink, Progress& progress);

}  // namespace sunfleck
