#include "cli/error_goal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/radiosity/fineness.hpp>

namespace sunfleck {

namespace {

constexpr double least = 1e-4, most = 0.5;
constexpr double spread_of_curves = 0.18;  // of the error, from one unit of fineness on

double error_value(const std::string& text) {
  char* end = nullptr;
  const double number = text.empty() ? 0.0 : std::strtod(text.c_str(), &end);
  const std::string rest = end ? end : "";
  const bool percent = rest == "%";
  const double value = percent ? number / 100.0 : number;
  if (!end || (!rest.empty() && !percent) || !(value >= least && value <= most))
    throw UsageError(fmt::format("--error: found '{}'; expected per cent, such as 2%, or a fraction, such as 0.02: from {:g} to {:g}{}",
                                 text, least, most,
                                 rest.empty() && number > most && number <= 100 * most ? fmt::format(" (did you mean {}%?)", text) : ""));
  return value;
}

/// Errors at fineness 0, .5, 1, ... 3.
using Curve = std::array<double, 7>;
constexpr Curve of_clustering{1, .54, .35, .28, .235, .20, .18}, of_flat{1, .58, .38, .32, .285, .265, .255},
    of_instantiation{1, .64, .42, .32, .26, .23, .21};

}  // namespace

NamedErrors named_errors(const std::string& text) {
  if (text.find('=') == std::string::npos) return {{"", error_value(text)}};
  NamedErrors named;
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t end = std::min(text.find(',', first), text.size());
    const std::string part = text.substr(first, end - first);
    first = end + 1;
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError(fmt::format("--error: found '{}'; expected BAND=ERROR, such as PAR=2%", part));
    const std::string name = part.substr(0, equals);
    for (const auto& [known, value] : named)
      if (known == name) throw UsageError(fmt::format("--error: found band '{}' twice; expected each band once", name));
    named.emplace_back(name, error_value(part.substr(equals + 1)));
  }
  return named;
}

std::vector<double> error_goal(const NamedErrors& named, const std::vector<std::string>& bands) {
  std::vector<double> goal(bands.size(), 0.0);
  for (const auto& [name, value] : named) {
    if (name.empty()) return std::vector<double>(bands.size(), value);
    const auto band = std::find(bands.begin(), bands.end(), name);
    if (band == bands.end()) {
      const std::string near = nearest_name(name, bands);
      throw UsageError(fmt::format("--error: found band '{}'; expected one of {}{}", name, joined(bands),
                                   near.empty() ? "" : " (did you mean '" + near + "'?)"));
    }
    goal[static_cast<std::size_t>(band - bands.begin())] = value;
  }
  return goal;
}

double error_at(const std::string& method, double fineness) {
  const Curve& curve = method == "flat" ? of_flat : method == "instantiation" ? of_instantiation : of_clustering;
  const double at = 2.0 * std::clamp(fineness, coarsest_fineness, finest_fineness);
  const auto below = std::min(static_cast<std::size_t>(at), curve.size() - 2);
  return curve[below] * std::pow(curve[below + 1] / curve[below], at - static_cast<double>(below));
}

Refinement::Refinement(std::vector<double> goal, std::string method) : goal_(std::move(goal)), method_(std::move(method)) {}

double Refinement::first() const {
  return coarsest_fineness;
}

void Refinement::add(double fineness, const Certificate& certificate) {
  Solve solve{fineness, {}, certificate.square_standard_error};
  for (const double e : certificate.rmse) solve.square.push_back(e * e);
  solves_.push_back(std::move(solve));
}

double Refinement::expected(std::size_t band, double fineness, double cautious) const {
  double weight = 0, sum = 0, least_variance = 0;
  for (const auto& s : solves_) {
    const double g = error_at(method_, fineness) / error_at(method_, s.fineness), square = s.square[band] * g * g;
    const double noise = s.standard_error[band] * g * g,
                 spread = 2.0 * spread_of_curves * std::min(1.0, std::abs(fineness - s.fineness)) * square;
    const double variance = noise * noise + spread * spread + 1e-300;
    if (weight == 0 || variance < least_variance) least_variance = variance;
    weight += 1.0 / variance;
    sum += square / variance;
  }
  return weight > 0 ? std::sqrt(sum / weight + cautious * std::sqrt(least_variance)) : 0.0;
}

bool Refinement::below(double fineness, double cautious) const {
  for (std::size_t b = 0; b < goal_.size(); ++b)
    if (goal_[b] > 0 && expected(b, fineness, cautious) > goal_[b]) return false;
  return true;
}

bool Refinement::last_says(double fineness, double share) const {
  const auto& last = solves_.back();
  const double g = error_at(method_, fineness) / error_at(method_, last.fineness);
  for (std::size_t b = 0; b < goal_.size(); ++b)
    if (goal_[b] > 0 && std::sqrt(last.square[b]) * g > share * goal_[b]) return false;
  return true;
}

bool Refinement::reached() const {
  constexpr double cautions[most_solves + 1] = {0.0, caution, 0.8, 0.3};
  return !solves_.empty() && last_says(solves_.back().fineness, 1.0) && below(solves_.back().fineness, cautions[solves_.size()]);
}

std::optional<double> Refinement::next(double limit) const {
  if (solves_.size() >= most_solves) return std::nullopt;
  constexpr double step = 0.05;
  const double last = solves_.back().fineness;
  if (last >= limit - 0.5 * step) return std::nullopt;
  double fineness = last + step;
  while (fineness < limit && !(below(fineness, caution) && last_says(fineness, 0.93))) fineness += step;
  return std::min(fineness, limit);
}

}  // namespace sunfleck
