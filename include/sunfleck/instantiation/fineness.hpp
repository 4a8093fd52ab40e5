// Densities of the instantiation between and beyond the named qualities.
#pragma once

#include <sunfleck/instantiation/solve.hpp>

namespace sunfleck {

/// As density_at() of radiosity/fineness.hpp: 0 is draft, 1 standard, 2 fine, up to 3; geometric means between, counts rounded.
InstantiationDensity instantiation_density_at(double fineness);

}  // namespace sunfleck
