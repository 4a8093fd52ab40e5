// Light in copies that share an original: against the flat solution, closed forms, and itself.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/instantiation/solve.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/facets.hpp>

#include "support/scenes.hpp"
