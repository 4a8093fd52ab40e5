#include "instantiation/outer_iteration.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include <sunfleck/core/memory.hpp>

namespace sunfleck {

namespace {

constexpr std::uint32_t most_passes = 100;

double relative(const std::vector<double>& squared, const std::vector<double>& scale) {
  double worst = 0;
  for (std::size_t c = 0; c < scale.size(); ++c)
    if (scale[c] > 0) worst = std::max(worst, std::sqrt(squared[c] / scale[c]));
  return worst;
}

/// Least |r - sum_k c_k (d_k - d_{k+1})|^2 over c, from the scalar products of d_0 = r, d_1, ..., d_n.
double least_residual(const Eigen::MatrixXd& gram, Eigen::VectorXd& c) {
  const auto n = gram.rows() - 1;
  Eigen::MatrixXd normal(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    right(i) = gram(0, i) - gram(0, i + 1);
    for (Eigen::Index j = 0; j < n; ++j) normal(i, j) = gram(i, j) - gram(i + 1, j) - gram(i, j + 1) + gram(i + 1, j + 1);
  }
  c = normal.completeOrthogonalDecomposition().solve(right);
  return std::max(0.0, gram(0, 0) - 2.0 * c.dot(right) + c.dot(normal * c));
}

void add(const Light& step, Light& total, const std::vector<Eigen::VectorXd>& weights, std::size_t k) {
  const std::size_t columns = weights.size();
  std::vector<float> w(columns);
  for (std::size_t c = 0; c < columns; ++c)
    w[c] = static_cast<std::size_t>(weights[c].size()) > k ? static_cast<float>(weights[c](k)) : 0.0f;
  for (std::size_t i = 0; i < total.fields.size(); ++i) total.fields[i] += w[i % columns] * step.fields[i];
  for (std::size_t i = 0; i < total.ground.size(); ++i) total.ground[i] += w[i % columns] * step.ground[i];
}

}  // namespace

OuterReport iterate(const SceneLight& s, const OuterIteration& iteration) {
  OuterReport report;
  Light& total = report.light;
  const double tolerance = iteration.tolerance;
  const std::size_t columns = s.columns;
  total = s.no_light();
  const std::size_t bytes = bytes_of(total.fields) + bytes_of(total.ground);
  const auto most_steps = most_steps_of(bytes);
  std::vector<double> scale;  // |b| per column
  std::size_t kept = 0;
  bool done = false;
  for (std::uint32_t passes = 0; !done && passes < most_passes;) {
    std::vector<Light> step(1, s.no_light());
    iteration.pass(passes == 0 ? nullptr : &total, true, step[0]);
    for (std::size_t i = 0; i < total.fields.size(); ++i) step[0].fields[i] -= total.fields[i];
    for (std::size_t i = 0; i < total.ground.size(); ++i) step[0].ground[i] -= total.ground[i];
    ++passes;
    const auto first = s.product(step[0], step[0]);
    if (scale.empty()) scale = first;
    done = relative(first, scale) <= tolerance;
    iteration.say(passes, relative(first, scale));
    std::vector<Eigen::MatrixXd> gram(columns, Eigen::MatrixXd::Zero(most_steps + 1, most_steps + 1));  // d_i . d_j
    for (std::size_t c = 0; c < columns; ++c) gram[c](0, 0) = first[c];
    std::vector<Eigen::VectorXd> weights(columns);
    while (!done && step.size() <= most_steps && passes < most_passes) {
      step.push_back(s.no_light());
      iteration.pass(&step[step.size() - 2], false, step.back());
      ++passes;
      const auto n = static_cast<Eigen::Index>(step.size()) - 1;
      for (Eigen::Index i = 0; i <= n; ++i) {
        const auto dot = s.product(step[i], step.back());
        for (std::size_t c = 0; c < columns; ++c) gram[c](i, n) = gram[c](n, i) = dot[c];
      }
      double residual = 0;
      for (std::size_t c = 0; c < columns; ++c) {
        const double left = least_residual(gram[c].topLeftCorner(n + 1, n + 1), weights[c]);
        if (scale[c] > 0) residual = std::max(residual, std::sqrt(left / scale[c]));
      }
      iteration.say(passes, residual);
      done = residual <= tolerance;
    }
    kept = std::max(kept, step.size());
    for (std::size_t k = 0; k + 1 < step.size(); ++k) add(step[k], total, weights, k);
    if (step.size() == 1 && done) {  // the residual itself is the last correction
      for (auto& w : weights) w = Eigen::VectorXd::Ones(1);
      add(step[0], total, weights, 0);
    }
  }
  report.converged = done;
  report.bytes = (kept + 1) * bytes;
  return report;
}

}  // namespace sunfleck
