// Cutting a population into classes along its parameters so that members of a class are alike.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sunfleck {

/// One structure that was measured.
struct Specimen {
  std::vector<double> table;       ///< S per area, all bands, scaled so that the population's mean square is 1
  std::vector<double> parameters;  ///< values of numeric parameters, in the order of their names
};

/// Classes along one parameter: rising bounds, each the lowest value of its class; the first is the lowest of all.
struct Cuts {
  std::size_t parameter = 0;
  std::vector<double> bounds;
};

/// Sum of squared distances from the means of the classes that the cuts make together, over the number of specimens.
double within_classes(const std::vector<Specimen>& all, const std::vector<Cuts>& cuts);

/// Cuts along one parameter, beside those there are: each time the one that lowers within_classes() most, as long as every class along it
/// keeps `least` specimens and each cut takes away `least_gain` of what all are apart, until within_classes() is at most `wanted`.
Cuts cut_along(const std::vector<Specimen>& all, std::size_t parameter, const std::vector<Cuts>& others, double wanted, std::size_t least,
               double least_gain);

/// The best parameter, and a second one if it takes away another fifth. Empty if no cut helps.
std::vector<Cuts> best_cuts(const std::vector<Specimen>& all, std::size_t parameters, double wanted, std::size_t least);

}  // namespace sunfleck
