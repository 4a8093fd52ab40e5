// How fine a solve has to be for a wanted error.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/audit/solve_difference.hpp>
#include <sunfleck/result/certificate.hpp>

namespace sunfleck {

/// How the error of a method falls with fineness (radiosity/fineness.hpp), relative to that at 0: measured on a canopy, coffee, a poplar, a
/// grove and ten poplars by tests/bench/error_over_fineness.cpp (docs/accuracy.md). Between the entries, at 0, .5, 1, ..., logarithms are
/// interpolated.
double error_at(const std::string& method, double fineness);

/// Finds the fineness for a goal from what is known of solves at other ones. In all, g(f) = error_at(f), and c = `spread_of_curves` is how
/// far scenes differ from the common curve over a unit of fineness.
///
/// - The certificate of a solve at f_k found rmse^2 = q_k with a standard error s_k. It says of a fineness f that rmse^2 is
///   q_k (g(f) / g(f_k))^2. Certificates of all solves share the traced organs and their noise.
/// - Two solves at f_j and f_k along other lines differ by D^2 = (q_j + q_k) i. A unit of fineness apart their errors are almost
///   independent, i = independence_of() their method. The closer they are, the more they have wrong alike (elements, fields, links of the
///   same size), down to a sixth in a canopy of 300 leaves at a quarter apart: i falls in proportion to f_k - f_j, and what they say is
///   uncertain by a share of 1 - (f_k - f_j). rmse^2 at f is D^2 / i g(f)^2 / (g(f_j)^2 + g(f_k)^2). That is free of noise, and all there
///   is to go by once errors are below what a certificate can see; what both have wrong alike it does not show, and the certificate does.
///
/// What a source says has the variance of its own, and that of a relative error of 2 c |f - f_k| (at most 2 c) for each step along the
/// curve. Within a kind, sources are weighted by the inverse of their variances, and the variance of their mean is the least of theirs, as
/// they share the organs or the finer solve. The two kinds are independent.
class Refinement {
 public:
  Refinement(std::vector<double> goal, std::string method);

  double first() const;

  /// What a solve at `fineness` amounts to: by its certificate, and by its distances to all the solves before it.
  void add(double fineness, const Certificate& certificate, const std::vector<SolveDifference>& to_earlier);

  /// Is the last solve good enough? It is, where the estimate is below `margin` times the goal in every band: the first solve's by
  /// `caution` standard errors, if its certificate finds no more than the goal either; a later one's by .5, if neither its certificate nor
  /// the differences speak against the goal by 1.64 standard errors.
  bool reached() const;
  /// The fineness to go on with, at most `limit`: where the estimate and `caution` standard errors are below that. None where that
  /// brings nothing more, or after `most_solves`.
  std::optional<double> next(double limit) const;
  /// Estimate of band b's rms error at a fineness, `cautious` standard errors added to its square.
  /// Where the last certificate finds more than the differences by more than 1.64 standard errors of both, the solves have something wrong
  /// alike, and certificates alone count.
  double expected(std::size_t band, double fineness, double cautious) const;
  /// What is found of the last solve: expected(), within the interval of its certificate.
  double found(std::size_t band) const;

  const std::vector<double>& goal() const { return goal_; }
  static constexpr std::size_t most_solves = 3;
  static constexpr double caution = 1.3;
  /// In wheat, whose blades are narrow, NIR errors fall more slowly than the curve, and what two solves have wrong alike is more.
  static constexpr double margin = 0.93;

  /// rmse^2 and the variance of that; no variance: nothing is known.
  struct Found {
    double square = 0, variance = 0;
  };

 private:
  /// rmse^2 found at a fineness, with its standard error, per band.
  struct Solve {
    double fineness;
    std::vector<double> square, standard_error, low, high;  ///< the last two: rmse, ends of the certificate's interval
  };
  struct Pair {
    double coarse, fine;  ///< fineness
    std::vector<double> square, standard_error;
  };
  double square_at(double fineness) const;  ///< of error_at()
  Found certified(std::size_t band, double fineness) const;
  Found by_differences(std::size_t band, double fineness) const;
  bool below(double fineness, double cautious) const;
  /// Is what the last certificate found, less some standard errors, at most a share of the goal, carried over to `fineness`?
  bool last_says(double fineness, double share, double standard_errors) const;
  /// Does the last certificate, or do the differences, speak against the goal by 1.64 standard errors?
  bool contradicted(double fineness) const;

  std::vector<double> goal_;
  std::string method_;
  std::vector<Solve> solves_;
  std::vector<Pair> pairs_;
};

}  // namespace sunfleck
