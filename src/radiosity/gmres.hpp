// Restarted GMRES for many right-hand sides that share the operator.
#pragma once

#include <functional>
#include <vector>

#include <sunfleck/core/progress.hpp>

#include "transport.hpp"

namespace sunfleck {

struct GmresResult {
  bool converged = true;
  std::vector<double> residuals;        ///< after each application of the operator: worst column, relative to `scale`
  std::vector<double> spectral_radius;  ///< [columns] largest |eigenvalue| of K that the Krylov spaces show; 0 where K b = 0
  std::size_t fields = 2;               ///< most fields held at a time, besides b and x
};

/// Solves x - K x = b for all columns at once, each with a Krylov space of its own (Saad & Schultz 1986, doi:10.1137/0907058), in the
/// inner product weighted by `weight` [sides]. x starts from b. Stops when the *true* residual, recomputed at every restart, is at most
/// `tolerance` x scale [columns] in every column, and small enough that an error of residual / (1 - spectral radius) is below a hundredth
/// of x: where hardly any light gets lost, a small residual alone says little. Not converged if single precision ends first.
/// `most_radius` bounds the eigenvalues of K, as far as is known. Columns with b = 0 stay 0. Sums run in an order that does not depend on
/// the number of threads. Throws Stopped.
GmresResult gmres(const std::function<void(const Field& x, Field& kx)>& apply, const Field& b, const std::vector<float>& weight,
                  const std::vector<double>& scale, double tolerance, int most_iterations, Field& x, Progress& progress,
                  double most_radius = 1.0);

/// Weighted norms of a field, one per column.
std::vector<double> norms(const Field& v, const std::vector<float>& weight, std::size_t columns);

}  // namespace sunfleck
