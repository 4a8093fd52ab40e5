#include "gmres.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <tbb/parallel_for.h>

namespace sunfleck {

namespace {

constexpr std::size_t block_sides = 4096;
constexpr std::size_t basis_bytes = std::size_t{256} << 20;  ///< a cycle grows until its basis fills this
constexpr double most_error = 0.01;                          ///< of a solution, as residual and spectral radius tell
constexpr int shortest_cycle = 8, longest_cycle = 40;

/// Weighted dot products of two fields, one per column. Blocks are summed in order.
std::vector<double> dot(const Field& a, const Field& b, const std::vector<float>& weight, std::size_t columns) {
  const std::size_t sides = weight.size(), blocks = (sides + block_sides - 1) / block_sides;
  std::vector<double> partial(blocks * columns, 0.0), sum(columns, 0.0);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t k) {
    double* out = partial.data() + k * columns;
    for (std::size_t i = k * block_sides, end = std::min(sides, i + block_sides); i < end; ++i)
      for (std::size_t c = 0; c < columns; ++c)
        out[c] += static_cast<double>(weight[i]) * static_cast<double>(a[i * columns + c]) * static_cast<double>(b[i * columns + c]);
  });
  for (std::size_t k = 0; k < blocks; ++k)
    for (std::size_t c = 0; c < columns; ++c) sum[c] += partial[k * columns + c];
  return sum;
}

/// y += factor[c] * x, per column.
void add_scaled(Field& y, const std::vector<double>& factor, const Field& x, std::size_t columns) {
  std::vector<float> f(factor.begin(), factor.end());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, y.size() / columns, block_sides), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      for (std::size_t c = 0; c < columns; ++c) y[i * columns + c] += f[c] * x[i * columns + c];
  });
}

void multiply(Field& y, const std::vector<double>& factor, std::size_t columns) {
  for (std::size_t i = 0; i < y.size(); i += columns)
    for (std::size_t c = 0; c < columns; ++c) y[i + c] *= static_cast<float>(factor[c]);
}

/// Largest |eigenvalue| of K = 1 - M in the space spanned, from the columns of M's Hessenberg matrix.
double largest_eigenvalue(const std::vector<std::vector<double>>& hessenberg) {
  auto n = static_cast<Eigen::Index>(hessenberg.size());
  if (n == 0) return 0.0;
  Eigen::MatrixXd k = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i <= std::min(j + 1, n - 1); ++i) k(i, j) -= hessenberg[j][i];
  return Eigen::EigenSolver<Eigen::MatrixXd>(k, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

std::vector<double> norms(const Field& v, const std::vector<float>& weight, std::size_t columns) {
  auto n = dot(v, v, weight, columns);
  for (auto& value : n) value = std::sqrt(value);
  return n;
}

GmresResult gmres(const std::function<void(const Field& x, Field& kx)>& apply, const Field& b, const std::vector<float>& weight,
                  const std::vector<double>& scale, double tolerance, int most_iterations, Field& x, Progress& progress,
                  double most_radius) {
  GmresResult result;
  const std::size_t columns = scale.size();
  const auto norm = [&](const Field& v) { return norms(v, weight, columns); };
  const auto worst = [&](const std::vector<double>& residual) {
    double w = 0;
    for (std::size_t c = 0; c < columns; ++c)
      if (scale[c] > 0) w = std::max(w, residual[c] / scale[c]);
    return w;
  };
  x = b;  // exact where nothing is scattered
  result.spectral_radius.assign(columns, 0.0);
  std::vector<double> target(columns);
  for (std::size_t c = 0; c < columns; ++c) target[c] = tolerance * scale[c];
  const auto met = [&](const std::vector<double>& length, double part) {
    for (std::size_t c = 0; c < columns; ++c)
      if (scale[c] > 0 && length[c] > part * target[c]) return false;
    return true;
  };
  double last_true = 0;
  const int longest = std::clamp(static_cast<int>(basis_bytes / (b.size() * sizeof(float) + 1)), shortest_cycle, longest_cycle);
  for (int iteration = 0;;) {
    progress.check();
    Field r(b.size());
    apply(x, r);
    ++iteration;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, b.size(), 8192), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) r[i] = b[i] - x[i] + r[i];
    });
    auto beta = norm(r);
    const double residual = worst(beta);
    result.residuals.push_back(residual);
    if (iteration > 1) {
      const auto length = norm(x);
      for (std::size_t c = 0; c < columns; ++c)
        target[c] = std::min(target[c], most_error * std::max(0.0, 1.0 - result.spectral_radius[c]) * length[c]);
    }
    // before the first Krylov space nothing is known of the spectrum but its bound: light that comes in at a crack is small, and stays
    std::vector<double> enough = target;
    if (iteration == 1) {
      const auto length = norm(x);
      for (std::size_t c = 0; c < columns; ++c) enough[c] = std::min(target[c], most_error * std::max(0.0, 1.0 - most_radius) * length[c]);
    }
    bool done = true;
    for (std::size_t c = 0; c < columns; ++c) done = done && (scale[c] <= 0 || beta[c] <= enough[c]);
    if (done) return result;
    // single precision cannot go below its own rounding: stop when a whole cycle gains nothing
    if (iteration >= most_iterations || (last_true > 0 && residual > 0.9 * last_true)) {
      result.converged = false;
      return result;
    }
    last_true = residual;
    // a column that is there stands still, so that it does not depend on the company it is solved in
    for (std::size_t c = 0; c < columns; ++c)
      if (beta[c] <= enough[c]) beta[c] = 0.0;
    const int cycle = std::max(1, std::min(longest, most_iterations - iteration));
    std::vector<Field> v;
    v.push_back(std::move(r));
    std::vector<double> inverse(columns);
    for (std::size_t c = 0; c < columns; ++c) inverse[c] = beta[c] > 0 ? 1.0 / beta[c] : 0.0;
    multiply(v[0], inverse, columns);
    // Hessenberg matrices, rotated to triangles as they grow
    std::vector<std::vector<std::vector<double>>> h(columns), hessenberg(columns);
    std::vector<std::vector<double>> g(columns), cosine(columns), sine(columns);
    for (std::size_t c = 0; c < columns; ++c) g[c] = {beta[c]};
    int steps = 0;
    std::vector<int> steps_of(columns, 0);
    for (; steps < cycle;) {
      Field w(b.size());
      apply(v[steps], w);
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, b.size(), 8192), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) w[i] = v[steps][i] - w[i];
      });
      ++iteration;
      std::vector<std::vector<double>> column_h(columns);
      for (int j = 0; j <= steps; ++j) {
        auto d = dot(w, v[j], weight, columns);
        for (std::size_t c = 0; c < columns; ++c) column_h[c].push_back(d[c]);
        for (auto& value : d) value = -value;
        add_scaled(w, d, v[j], columns);
      }
      const auto length = norm(w);
      std::vector<double> estimate(columns);
      for (std::size_t c = 0; c < columns; ++c) {
        auto& column = column_h[c];
        inverse[c] = length[c] > 1e-30 ? 1.0 / length[c] : 0.0;
        const double below = length[c];
        if (steps_of[c] == steps && beta[c] > 0) {
          hessenberg[c].push_back(column);
          hessenberg[c].back().push_back(below);
        }
        for (int j = 0; j < steps; ++j) {
          const double a = column[j], z = column[j + 1];
          column[j] = cosine[c][j] * a + sine[c][j] * z;
          column[j + 1] = -sine[c][j] * a + cosine[c][j] * z;
        }
        const double hypotenuse = std::hypot(column[steps], below);
        const double cs = hypotenuse > 0 ? column[steps] / hypotenuse : 1.0, sn = hypotenuse > 0 ? below / hypotenuse : 0.0;
        cosine[c].push_back(cs);
        sine[c].push_back(sn);
        column[steps] = hypotenuse;
        g[c].push_back(-sn * g[c][steps]);
        g[c][steps] *= cs;
        h[c].push_back(std::move(column));
        const bool active = (steps == 0 && beta[c] > 0) || std::fabs(g[c][steps_of[c]]) > 0.5 * target[c];
        if (active && steps_of[c] == steps) steps_of[c] = steps + 1;
        estimate[c] = std::fabs(g[c][steps_of[c]]);
      }
      ++steps;
      result.residuals.push_back(worst(estimate));
      progress.check();
      if (met(estimate, 0.5) || steps == cycle) break;
      multiply(w, inverse, columns);
      v.push_back(std::move(w));
    }
    result.fields = std::max(result.fields, v.size() + 1);  // with the next direction
    for (std::size_t c = 0; c < columns; ++c)
      result.spectral_radius[c] = std::max(result.spectral_radius[c], largest_eigenvalue(hessenberg[c]));
    std::vector<std::vector<double>> y(columns, std::vector<double>(steps, 0.0));
    for (std::size_t c = 0; c < columns; ++c)
      for (int i = steps_of[c]; i-- > 0;) {
        double value = g[c][i];
        for (int j = i + 1; j < steps_of[c]; ++j) value -= h[c][j][i] * y[c][j];
        y[c][i] = h[c][i][i] != 0.0 ? value / h[c][i][i] : 0.0;
      }
    for (int j = 0; j < steps; ++j) {
      std::vector<double> factor(columns);
      for (std::size_t c = 0; c < columns; ++c) factor[c] = y[c][j];
      add_scaled(x, factor, v[j], columns);
    }
  }
}

}  // namespace sunfleck
