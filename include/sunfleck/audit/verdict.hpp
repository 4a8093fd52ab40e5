// What a solve aims at, and whether its certificate contradicts that.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/audit/certificate.hpp>

namespace sunfleck {

/// Rms error of an organ's absorbed light, over the mean, that a fineness (radiosity/fineness.hpp: 0 draft, 1 standard, 2 fine) aims at,
/// in a band whose plants scatter the share `albedo` of the light that they meet [-]: 4, 1 and .7 % below an albedo of 1/2, where nearly
/// all light is direct (PAR in green leaves: .15), and 6, 2 and 1.2 % from there on, where it is scattered many times (NIR: .85). Between
/// qualities the weighted geometric mean; beyond fine no less. docs/accuracy.md has what is reached.
double aimed_error(double fineness, double albedo);

/// Per band of a scene: aimed_error() at the mean albedo of its certified organs, (rho_front + rho_back) / 2 + tau, weighted by the area
/// that they stand for.
std::vector<double> aimed_errors(const FacetRows& rows, const std::vector<ChosenOrgan>& chosen, double fineness);

/// An error that no chance explains.
struct Contradiction {
  std::size_t band = 0;
  double found = 0, at_least = 0, aim = 0;  ///< fractions of the mean; `at_least`: what chance leaves of `found`
  bool bias = false;                        ///< of the mean over all organs, else rms
};

/// How many times what was aimed at a certificate may find before it contradicts.
inline constexpr double most_times_the_aim = 3.0;

/// The worst band, against its aim, whose error is beyond most_times_the_aim: the rms error by the lower end of its interval, or the
/// bias by 2.1 standard errors. Nothing where there is none. `aims` [b]; a band of aim 0 is not judged.
std::optional<Contradiction> contradiction(const Certificate& certificate, const std::vector<double>& aims);

}  // namespace sunfleck
