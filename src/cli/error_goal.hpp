// The error that a user wants, per band, and how fine a solve has to be for it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/result/certificate.hpp>

namespace sunfleck {

/// What the command line says: an error for each band named, or one for all, under an empty name.
using NamedErrors = std::vector<std::pair<std::string, double>>;
/// Reads "1%", "0.01", or bands by name, "PAR=1%,NIR=2%"; each from 0.01 % to 50 %. Throws UsageError with what was found and expected.
NamedErrors named_errors(const std::string& text);

/// Wanted rms errors of an organ's absorbed light per band, fractions of the mean; 0 = of this band nothing is asked. Throws UsageError
/// for a band that the scene does not have.
std::vector<double> error_goal(const NamedErrors& named, const std::vector<std::string>& bands);

/// How the error of a method falls with fineness (radiosity/fineness.hpp), relative to that at 0: measured on coffee, a canopy, wheat and a
/// poplar by tests/bench/error_over_fineness.cpp. Between the entries, at 0, .5, 1, ..., logarithms are interpolated.
double error_at(const std::string& method, double fineness);

/// Finds the fineness for a goal from what certificates say of solves at other ones.
///
/// Each solve at f_k found rmse^2 = q_k with a standard error s_k. It says of a fineness f that rmse^2 is q_k g^2, g = error_at(f) /
/// error_at(f_k), with the variance (s_k g^2)^2 + (2 c min(1, |f - f_k|) q_k g^2)^2: c = .18 is how far scenes differ from the common
/// curve. Solves are weighted by the inverse of their variances; as all are judged by the same traced organs, whose noise they share, the
/// variance of the mean is the least of theirs. What has to be below the goal is that mean and `caution` standard errors more.
class Refinement {
 public:
  Refinement(std::vector<double> goal, std::string method);

  double first() const;

  /// What a solve at `fineness` amounts to, by its certificate.
  void add(double fineness, const Certificate& certificate);

  /// Is the last solve good enough? It is, where its own certificate finds no more than the goal in any band, and the estimate as above is
  /// below it too: the first solve with `caution`, the second, which was chosen with it, with .8 standard errors, the third with .3.
  bool reached() const;
  /// The fineness to go on with, at most `limit`; none where that brings nothing more, or after `most_solves`.
  std::optional<double> next(double limit) const;
  /// Estimate of band b's rms error at a fineness, `cautious` standard errors added to its square.
  double expected(std::size_t band, double fineness, double cautious) const;

  const std::vector<double>& goal() const { return goal_; }
  static constexpr std::size_t most_solves = 3;
  static constexpr double caution = 1.3;

 private:
  /// Is what the last certificate found, carried over to `fineness`, at most a share of the goal?
  bool last_says(double fineness, double share) const;
  struct Solve {
    double fineness;
    std::vector<double> square, standard_error;  ///< [b]
  };
  bool below(double fineness, double cautious) const;

  std::vector<double> goal_;
  std::string method_;
  std::vector<Solve> solves_;
};

}  // namespace sunfleck
