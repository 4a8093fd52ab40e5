// The certificate: some organs of a solved scene checked by path tracing.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/result/certificate.hpp>
#include <sunfleck/result/organ_totals.hpp>
#include <sunfleck/scene/facet_rows.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/solution.hpp>
#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

struct CertificateSettings {
  std::uint64_t seed = 1;      ///< of the solve; the certificate's numbers are independent of those that solve and reference draw from it
  int threads = 0;             ///< 0 = all cores
  std::uint32_t organs = 240;  ///< to check; all, where a scene has no more
  std::uint64_t rays = 0;      ///< to spend, about; 0 = 2 million up to 10^5 facets, then less with their root, 600,000 from 1.1 10^6 on
};

/// An organ to check.
struct ChosenOrgan {
  std::uint64_t organ = 0;  ///< row of /organs
  double share = 0;         ///< of the area of all organs of plants, that it stands for
  double size = 0;          ///< the probability to be drawn was proportional to it
  bool certain = false;     ///< taken for sure
};

/// Draws organs of plants with a probability proportional to their area plus three times the mean area: small organs weigh little but
/// have the largest errors (on a coffee plant organs that make a tenth of the area hold nine tenths of the square error in NIR), and one
/// drawn by its area alone would weigh as much as a large one. One from each of equal stretches in scene order, so that they spread over
/// the scene; organs larger than a stretch are taken for sure; all, if there are no more than settings.organs. Shares of those drawn are
/// area over probability, scaled to the area that they stand for together. Rising rows; holds nothing of the size of the scene.
std::vector<ChosenOrgan> choose_organs(const FacetRows& rows, const CertificateSettings& settings);

/// Path-traced light of one organ: means per area and the variances of these means, [s][b]. Irradiance is front + back.
struct TracedLight {
  std::vector<double> absorbed, absorbed_variance;      ///< [W m^-2], [(W m^-2)^2]
  std::vector<double> irradiance, irradiance_variance;  ///< [W m^-2], [(W m^-2)^2]
  std::uint64_t rays = 0;
};

/// Organs of a scene traced once: any number of solves can be judged by them.
struct TracedOrgans {
  std::vector<ChosenOrgan> chosen;  ///< those that were traced
  std::vector<TracedLight> light;   ///< of each
  std::uint64_t rays = 0;           ///< in all
  std::uint64_t seed = 0;
};

/// Traces the chosen organs (choose_organs) by paths from points uniform over each organ's area.
///
/// Work is counted in rays, not seconds, so that every machine gives the same certificate: a number that depends on the number of
/// facets alone, some per cent more to find out what a path costs, and the tree of rays (1.3 microseconds a facet): below 2 s on one core
/// up to 10^5 facets, and some 4 s with 10^6, where solving takes far longer. Fewer organs are checked (at least 64) where 16 samples of
/// each would cost more. `rays` are of the same scene, written out or by copies; it is built by the caller. Same bits for any number of
/// threads.
TracedOrgans trace_organs(const Scene& scene, const FacetRows& rows, const RayScene& rays, const std::vector<ChosenOrgan>& chosen,
                          const CertificateSettings& settings, Progress& progress);

/// Compares a solve with traced organs, of which `solved` holds all. Estimates, per band, over all states together (x solved, r reference,
/// per area; w area; the Error definition of docs/formats-result.md):
///   rmse^2 = max(0, sum w ((x - r)^2 - var r) / sum w), bias = sum w (x - r) / sum w, over the mean of r,
/// where the mean of r is the mean of x over *all* organs of plants less the bias, which is far less noisy than that of the checked ones.
/// It is taken to be at least a thousandth of the mean of x: where paths find no light and the solve some, the error is large.
/// The interval and the bias's standard error hold both the choice of organs and the noise of the paths (see error_interval.hpp).
/// Where plants absorb less than 1e-6 of the incident light, irradiance (front + back) takes the place of absorbed in the measures.
/// A scene without plant organs yields measures of zero and no organs.
Certificate judge(const TracedOrgans& traced, const OrganTotals& solved, const std::vector<std::vector<Balance>>& balance);

/// Both, for one solve whose light of the chosen organs `solved` holds in the same order.
Certificate certify(const Scene& scene, const FacetRows& rows, const RayScene& rays, const std::vector<ChosenOrgan>& chosen,
                    const OrganTotals& solved, const std::vector<std::vector<Balance>>& balance, const CertificateSettings& settings,
                    Progress& progress);

}  // namespace sunfleck
