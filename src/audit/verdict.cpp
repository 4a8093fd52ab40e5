#include <sunfleck/audit/verdict.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace sunfleck {

namespace {

constexpr std::array<double, 3> weakly_scattering{0.04, 0.01, 0.007}, strongly_scattering{0.06, 0.02, 0.012};
constexpr double strong_albedo = 0.5;
constexpr double standard_errors = 2.1;  // as the certificate's interval has it (audit/error_interval.hpp)

double albedo_of(const Optics& o, std::size_t band) {
  return 0.5 * (o.reflectance_front[band] + o.reflectance_back[band]) + o.transmittance[band];
}

}  // namespace

double aimed_error(double fineness, double albedo) {
  const auto& aims = albedo < strong_albedo ? weakly_scattering : strongly_scattering;
  const double at = std::clamp(fineness, 0.0, 2.0);
  const auto below = static_cast<std::size_t>(std::min(at, 1.0));
  return aims[below] * std::pow(aims[below + 1] / aims[below], at - static_cast<double>(below));
}

std::vector<double> aimed_errors(const FacetRows& rows, const std::vector<ChosenOrgan>& chosen, double fineness) {
  const std::size_t bands = rows.scene().band_count();
  std::vector<double> albedo(bands, 0.0), aims(bands);
  double shares = 0.0;
  for (const auto& c : chosen) {
    const auto [copy, organ] = rows.organ_at(c.organ);
    const auto facets = rows.organ_facets(copy, organ);
    if (facets.empty()) continue;
    const auto& optics = rows.materials()[rows.material({copy, facets.front()})];
    for (std::size_t b = 0; b < bands; ++b) albedo[b] += c.share * albedo_of(optics, b);
    shares += c.share;
  }
  for (std::size_t b = 0; b < bands; ++b) aims[b] = aimed_error(fineness, shares > 0.0 ? albedo[b] / shares : 0.0);
  return aims;
}

std::optional<Contradiction> contradiction(const Certificate& certificate, const std::vector<double>& aims) {
  std::optional<Contradiction> worst;
  for (std::size_t b = 0; b < aims.size(); ++b) {
    if (!(aims[b] > 0.0)) continue;
    const auto judge = [&](double found, double at_least, bool bias) {
      if (at_least > most_times_the_aim * aims[b] && (!worst || at_least / aims[b] > worst->at_least / worst->aim))
        worst = {b, found, at_least, aims[b], bias};
    };
    judge(certificate.rmse[b], certificate.rmse_low[b], false);
    const double bias = std::abs(certificate.bias[b]);
    if (!certificate.bias_standard_error.empty()) judge(bias, bias - standard_errors * certificate.bias_standard_error[b], true);
  }
  return worst;
}

}  // namespace sunfleck
