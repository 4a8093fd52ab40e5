// Applications of the operator, residual, spectral radius and balance over leaf and soil albedo, as the table of
// docs/stiffness-and-extremes.md: build/tests/bin/bench_stiffness
#include <fmt/format.h>

#include "stiff_scenes.hpp"

using namespace stiff_scenes;

int main() {
  fmt::print("| scene | leaf albedo | soil albedo | method | applications | residual | spectral radius | balance residual | status |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (const auto space : {Space::open, Space::periodic, Space::closed})
    for (const double w : {0.0, 0.5, 0.9, 0.99, 0.999, 1 - 1e-6, 1.0})
      for (const double soil : {0.0, 0.2, 1.0})
        for (const auto method : both_methods) {
          const auto run = solve_stiff(scene_of(space, w, soil), method);
          const auto& r = run.report;
          const auto& b = r.balance[0][0];
          fmt::print("| {} | {} | {} | {} | {} | {:.1e} | {:.4f} | {:.1e} | {} |\n", name_of(space),
                     w == 1 - 1e-6 ? "1 - 1e-6" : fmt::format("{}", w), soil, radiosity_runs::name_of(method), r.convergence.size(),
                     r.convergence.back().residual, r.spectral_radius.empty() ? 0.0 : r.spectral_radius[0], b.residual() / b.incident,
                     r.status == SolveStatus::converged ? "converged" : "not_converged");
        }
}
