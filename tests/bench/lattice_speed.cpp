// Time of the lattice's steady state on a cube of nodes, three bands together: bench_lattice_speed [nodes a side, 128] [residual, 1e-3]
#include <cstdlib>

#include <fmt/format.h>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/core/timer.hpp>

#include "lattice/medium.hpp"
#include "lattice/steady_state.hpp"

using namespace sunfleck;

int main(int argc, char** argv) {
  const std::int64_t n = argc > 1 ? std::max(2, std::atoi(argv[1])) : 128;
  const double residual = argc > 2 ? std::atof(argv[2]) : 1e-3;
  const NodeGrid grid{Vec3{0.0}, {n, n, n}, Vec3{1.0}, 1.0};
  // the paper's table: red, green and blue of leaves; a crown that fills the cube, of optical radius 3
  const Optics leaf{"leaf", {.055f, .125f, .020f}, {.055f, .125f, .020f}, {.070f, .150f, .040f}};
  std::vector<NodeArea> leaves;
  RandomStream random(1);
  const double area = 2.0 * 3.0 / (0.5 * static_cast<double>(n));
  for (std::uint32_t i = 0; i < grid.nodes(); ++i) leaves.push_back({i, 0, 2.0 * area * random.next()});
  const auto medium = lattice_medium(grid, false, leaves, {leaf}, nullptr, {}, LatticeMapping::matched, 1.0, false, 3);
  std::vector<LatticeColumn> columns(3);
  for (std::size_t b = 0; b < 3; ++b) {
    columns[b].band = b;
    columns[b].source.assign(medium.nodes(), 0.0);
    for (const auto& l : leaves) columns[b].source[l.node] = l.area;
  }
  const Stopwatch watch;
  const auto steady = steady_state(medium, columns, {residual, 2000}, silent(), [](std::uint32_t, double) {});
  fmt::print("{} x {} x {} nodes, 3 bands: {} sweeps to {:.1e}, {:.2f} s\n", n, n, n, steady.iterations, steady.residual, watch.seconds());
}
