#include <sunfleck/radiosity/solve.hpp>

namespace sunfleck {

RadiosityDensity density_of(Quality quality) {
  RadiosityDensity d;
  switch (quality) {
    case Quality::draft:
      d = {.directions = 72,
           .lines_per_element = 1.2,
           .elements_per_organ = 1.5,
           .sky_directions = 64,
           .sky_lines_per_organ = 4.0,
           .sun_samples = 4,
           .sun_lines_per_organ = 800.0,
           .link_error = 0.8,
           .tolerance = 1e-5,
           .fewest_hits = 48e3};
      break;
    case Quality::standard:
      d = {.directions = 400,
           .lines_per_element = 0.8,
           .elements_per_organ = 6.0,
           .sky_directions = 160,
           .sky_lines_per_organ = 8.0,
           .sun_samples = 8,
           .sun_lines_per_organ = 3000.0,
           .link_error = 0.5,
           .tolerance = 2e-6,
           .fewest_hits = 160e3,
           .fewest_organs = 100.0};
      break;
    case Quality::fine:
      d = {.directions = 640,
           .lines_per_element = 1.4,
           .elements_per_organ = 12.0,
           .sky_directions = 288,
           .sky_lines_per_organ = 16.0,
           .sun_samples = 12,
           .sun_lines_per_organ = 10000.0,
           .link_error = 0.25,
           .tolerance = 1e-6,
           .fewest_hits = 224e3,
           .fewest_organs = 100.0};
      break;
  }
  return d;
}

}  // namespace sunfleck
