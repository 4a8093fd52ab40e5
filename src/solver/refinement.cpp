#include "solver/refinement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <sunfleck/core/error.hpp>
#include <sunfleck/radiosity/fineness.hpp>

namespace sunfleck {

namespace {

constexpr double spread_of_curves = 0.15;  // of the error, from one unit of fineness on
constexpr double spread_of_independence = 0.1;
constexpr double beyond_chance = 1.64;  // standard errors

/// (x - y)^2 over (x - r)^2 + (y - r)^2, x at draft, y at standard, r the reference: docs/accuracy.md.
double independence_of(const std::string& method) {
  return method == "instantiation" ? 0.77 : 0.88;
}

double spread(double from, double to) {
  return 2.0 * spread_of_curves * std::min(1.0, std::abs(from - to));
}

/// Errors at fineness 0, .5, 1, ... 3.
using Curve = std::array<double, 7>;
constexpr Curve of_clustering{1, .54, .31, .22, .16, .135, .12}, of_flat{1, .55, .36, .30, .265, .25, .24},
    of_instantiation{1, .64, .45, .37, .33, .29, .27};

/// Sources of one kind: what they say of rmse^2, weighted by the inverse of their variances.
struct Kind {
  double weight = 0, sum = 0, least_variance = 0;

  void add(double square, double standard_error, double relative_variance) {
    const double variance = standard_error * standard_error + relative_variance * square * square + 1e-300;
    if (weight == 0 || variance < least_variance) least_variance = variance;
    weight += 1.0 / variance;
    sum += square / variance;
  }
  Refinement::Found found() const { return weight > 0 ? Refinement::Found{sum / weight, least_variance} : Refinement::Found{}; }
};

}  // namespace

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

void Refinement::add(double fineness, const Certificate& certificate, const std::vector<SolveDifference>& to_earlier) {
  if (to_earlier.size() != solves_.size()) throw Error("refinement: a solve is compared with every one before it");
  for (std::size_t j = 0; j < to_earlier.size(); ++j)
    pairs_.push_back({solves_[j].fineness, fineness, to_earlier[j].square, to_earlier[j].square_standard_error});
  Solve solve{fineness, {}, certificate.square_standard_error, certificate.rmse_low, certificate.rmse_high};
  for (const double e : certificate.rmse) solve.square.push_back(e * e);
  solves_.push_back(std::move(solve));
}

double Refinement::square_at(double fineness) const {
  const double error = error_at(method_, fineness);
  return error * error;
}

Refinement::Found Refinement::certified(std::size_t band, double fineness) const {
  Kind kind;
  for (const auto& s : solves_) {
    const double scale = square_at(fineness) / square_at(s.fineness), along = spread(fineness, s.fineness);
    kind.add(s.square[band] * scale, s.standard_error[band] * scale, along * along);
  }
  return kind.found();
}

Refinement::Found Refinement::by_differences(std::size_t band, double fineness) const {
  Kind kind;
  for (const auto& p : pairs_) {
    const double apart = std::min(1.0, p.fine - p.coarse);
    const double scale = square_at(fineness) / (independence_of(method_) * apart * (square_at(p.coarse) + square_at(p.fine)));
    const double along = spread(fineness, p.fine), between = spread(p.coarse, p.fine), alike = 1.0 - apart;
    kind.add(p.square[band] * scale, p.standard_error[band] * scale,
             along * along + between * between + alike * alike + spread_of_independence * spread_of_independence);
  }
  return kind.found();
}

double Refinement::expected(std::size_t band, double fineness, double cautious) const {
  const Found traced = certified(band, fineness), differences = by_differences(band, fineness);
  const bool wrong_alike =
      differences.variance > 0 && traced.square - differences.square > beyond_chance * std::sqrt(traced.variance + differences.variance);
  double weight = 0, sum = 0;
  for (const auto* kind : {&traced, &differences})
    if (kind->variance > 0 && !(wrong_alike && kind == &differences)) weight += 1.0 / kind->variance, sum += kind->square / kind->variance;
  return weight > 0 ? std::sqrt(sum / weight + cautious / std::sqrt(weight)) : 0.0;
}

double Refinement::found(std::size_t band) const {
  const auto& last = solves_.back();
  const double estimate = expected(band, last.fineness, 0.0);
  if (last.low.empty()) return estimate;
  return std::min(std::max(estimate, last.low[band]), std::max(last.low[band], last.high[band]));
}

bool Refinement::below(double fineness, double cautious) const {
  for (std::size_t b = 0; b < goal_.size(); ++b)
    if (goal_[b] > 0 && expected(b, fineness, cautious) > margin * goal_[b]) return false;
  return true;
}

bool Refinement::last_says(double fineness, double share, double standard_errors) const {
  const auto& last = solves_.back();
  const double scale = square_at(fineness) / square_at(last.fineness);
  for (std::size_t b = 0; b < goal_.size(); ++b)
    if (goal_[b] > 0 && (last.square[b] - standard_errors * last.standard_error[b]) * scale > std::pow(share * goal_[b], 2)) return false;
  return true;
}

bool Refinement::contradicted(double fineness) const {
  if (!last_says(fineness, 1.0, beyond_chance)) return true;
  for (std::size_t b = 0; b < goal_.size(); ++b) {
    const auto [square, variance] = by_differences(b, fineness);
    if (goal_[b] > 0 && square - beyond_chance * std::sqrt(variance) > goal_[b] * goal_[b]) return true;
  }
  return false;
}

bool Refinement::reached() const {
  if (solves_.empty()) return false;
  const double fineness = solves_.back().fineness;
  if (solves_.size() == 1) return last_says(fineness, 1.0, 0.0) && below(fineness, caution);
  return !contradicted(fineness) && below(fineness, 0.5);
}

std::optional<double> Refinement::next(double limit) const {
  if (solves_.size() >= most_solves) return std::nullopt;
  constexpr double step = 0.05;
  const double last = solves_.back().fineness;
  if (last >= limit - 0.5 * step) return std::nullopt;
  double fineness = last + step;
  const bool first = solves_.size() == 1;
  const auto enough = [&](double f) { return below(f, caution) && (first ? last_says(f, margin, 0.0) : !contradicted(f)); };
  while (fineness < limit && !enough(fineness)) fineness += step;
  return std::min(fineness, limit);
}

}  // namespace sunfleck
