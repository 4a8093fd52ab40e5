#include "cli/solve_table.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace sunfleck {

namespace {

/// Power of a band: irradiance in W m^-2 gives W; photon flux density in umol m^-2 s^-1 gives umol/s.
std::string power_unit(const std::string& irradiance_unit) {
  return irradiance_unit == "umol m^-2 s^-1" ? "umol/s" : "W";
}

std::string fraction(double part, double whole) {
  return whole > 0.0 ? fmt::format("{:.4f}", part / whole) : std::string("-");
}

void print_balance(const Scene& scene, const SolveReport& report, const PlantShares* shares) {
  std::size_t name_width = 5;
  for (const auto& state : scene.states) name_width = std::max(name_width, state.name.size());
  const bool many = scene.states.size() > 1;
  const auto lead = [&](const std::string& text) { return many ? fmt::format("{:<{}}  ", text, name_width) : std::string(); };
  fmt::print("{}{:<8} {:>12} {:>12} {:>12} {:>7} {:>9} {:>9} {:>9} {:>9}\n", lead("state"), "band", "incident", "leaves", "ground", "",
             "absorbed", "ground", "albedo", "residual");
  for (std::size_t s = 0; s < report.balance.size(); ++s)
    for (std::size_t b = 0; b < report.balance[s].size(); ++b) {
      const Balance& balance = report.balance[s][b];
      fmt::print("{}{:<8} {:>12.5g} {:>12.5g} {:>12.5g} {:>7} {:>9} {:>9} {:>9} {:>9.1e}\n", lead(scene.states[s].name), scene.bands[b],
                 balance.incident, balance.leaves, balance.ground, power_unit(scene.band_units[b]),
                 fraction(balance.leaves - (shares ? shares->other_of_all(s, b) : 0.0), balance.incident),
                 fraction(balance.ground, balance.incident), fraction(balance.escaped, balance.incident),
                 balance.incident > 0.0 ? balance.residual() / balance.incident : 0.0);
    }
}

/// Fractions of the incident light of all states together that each plant absorbs, where there is more than one or not all of it is leaf.
void print_plants(const Scene& scene, const SolveReport& report, const PlantShares& shares) {
  constexpr std::size_t most_lines = 20;
  const auto absorbed = [&](const std::vector<double>& power, std::size_t p, std::size_t b) {
    double part = 0.0, incident = 0.0;
    for (std::size_t s = 0; s < report.balance.size(); ++s) part += power[shares.at(s, p, b)], incident += report.balance[s][b].incident;
    return fraction(part, incident);
  };
  bool any_other = false;
  for (const double w : shares.other) any_other = any_other || w > 0.0;
  if (shares.names.size() < 2 && !any_other) return;
  std::size_t width = 0;
  for (const auto& name : shares.names) width = std::max(width, name.size());
  fmt::print("\nabsorbed by plant, fractions of the incident light{}\n", any_other ? "; (other): does not count as leaf" : "");
  fmt::print("{:<{}}", "plant", width + 8);
  for (const auto& band : scene.bands) fmt::print(" {:>9}", band);
  fmt::print("\n");
  const auto line = [&](std::size_t p, const std::vector<double>& power, const char* kind) {
    fmt::print("{:<{}}", shares.names[p] + kind, width + 8);
    for (std::size_t b = 0; b < scene.band_count(); ++b) fmt::print(" {:>9}", absorbed(power, p, b));
    fmt::print("\n");
  };
  const auto any = [&](const std::vector<double>& power, std::size_t p) {
    for (std::size_t s = 0; s < shares.states; ++s)
      for (std::size_t b = 0; b < shares.bands; ++b)
        if (power[shares.at(s, p, b)] > 0.0) return true;
    return false;
  };
  for (std::size_t p = 0; p < std::min(most_lines, shares.names.size()); ++p) {
    const bool other = any(shares.other, p);
    if (!other || any(shares.leaf, p)) line(p, shares.leaf, "");
    if (other) line(p, shares.other, " (other)");
  }
  if (shares.names.size() > most_lines) fmt::print("... and {} more: /balance/plants of the result\n", shares.names.size() - most_lines);
}

void print_certificate(const Scene& scene, const Certificate& certificate) {
  fmt::print("\nerror of an organ's absorbed light against path tracing of {} organs, % of the mean\n", certificate.organs.size());
  fmt::print("{:<8} {:>8} {:>17} {:>8}\n", "band", "rmse", "95 % interval", "bias");
  for (std::size_t b = 0; b < scene.band_count(); ++b)
    fmt::print("{:<8} {:>8.2f} {:>8.2f} {:>8.2f} {:>+8.2f}\n", scene.bands[b], 100.0 * certificate.rmse[b], 100.0 * certificate.rmse_low[b],
               100.0 * certificate.rmse_high[b], 100.0 * certificate.bias[b]);
}

}  // namespace

void print_solve_table(const Scene& scene, const Depth& depth, const SolveReport& report, const Certificate* certificate,
                       const PlantShares* shares) {
  if (!depth.only.empty()) fmt::print("of what is opened only: what it exchanges with the rest is in the residual\n");
  fmt::print("{}\n", scene.periodic ? "power balance of one cell; absorbed, ground and albedo are fractions of the incident light"
                                    : "power balance; absorbed, ground and albedo are fractions of the incident light");
  fmt::print(
      "leaves are all plants, walls and housings too; absorbed is of what counts as leaf ([optics.*] counts_as): all unless it says so\n");
  print_balance(scene, report, shares);
  if (shares) print_plants(scene, report, *shares);
  if (certificate)
    print_certificate(scene, *certificate);
  else if (report.method != "reference")
    fmt::print("\nnot certified: the error of this result is not known\n");
}

}  // namespace sunfleck
