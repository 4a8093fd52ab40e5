#include <sunfleck/radiosity/solve.hpp>

namespace sunfleck {

RadiosityDensity density_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {24, 1.2, 1.0, 64, 4.0, 2, 60.0, 0.1, 1e-5};
    case Quality::fine:
      return {160, 2.0, 4.0, 512, 8.0, 8, 1200.0, 0.02, 1e-6};
    default:
      return {64, 1.2, 2.0, 192, 4.0, 4, 300.0, 0.05, 2e-6};
  }
}

}  // namespace sunfleck
