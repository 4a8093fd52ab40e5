// How far a result is from a reference: the one definition of error, used wherever an error is reported.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <sunfleck/result/result_reader.hpp>

namespace sunfleck {

/// Error of one band. Over organs (or facets) of plants with an area above zero, x and r their absorbed power per area in result and
/// reference, w their areas, var the variance of the mean that a file of the reference method stores (of r, and of x if it has one):
///   mean = sum w r / sum w
///   bias = (sum w (x - r) / sum w) / mean
///   rmse = sqrt(max(0, sum w (x - r)^2 / sum w - sum w var / sum w)) / mean
///   maximum = max |x - r| / mean, noise included
///   noise = sqrt(sum w var / sum w) / mean
/// Where the plants of the reference absorb less than 1e-6 of the incident light (albedo 1), irradiance, front plus back, takes the place
/// of absorbed, and no noise is known. All zero where the reference has no light at all in the band.
struct BandError {
  double mean = 0;     ///< [W m^-2, or the band's unit]
  double bias = 0;     ///< [-]
  double rmse = 0;     ///< [-]
  double maximum = 0;  ///< [-]
  double noise = 0;    ///< [-]
  bool irradiance = false;
  std::size_t count = 0;  ///< organs or facets compared, of all states counted
};

/// Errors per state, and over all states together (sums over states in each formula above). b bands, s states.
struct ErrorTable {
  std::vector<BandError> overall;              ///< [b]
  std::vector<std::vector<BandError>> states;  ///< [s][b]
  bool empty() const { return overall.empty(); }
};

struct Comparison {
  ErrorTable organs;
  ErrorTable facets;               ///< empty where one of the files keeps organs only
  std::vector<std::string> notes;  ///< what else than the solution differs: light, optics, names (scene_match.hpp)
};

/// Throws InputError naming what differs if the files are not of the same scene: what match_scenes() of scene_match.hpp finds; without
/// `places`, facets may lie and face elsewhere.
Comparison compare(const Result& result, const Result& reference, bool places = true);

}  // namespace sunfleck
