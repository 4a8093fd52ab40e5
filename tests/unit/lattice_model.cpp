// The D3Q19 lattice against what is known of it: conservation, diffusion, and its steady state against plain steps in time.
#include <catch2/catch.hpp>

#include <complex>
#include <vector>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/lattice/lattice.hpp>

#include "lattice/clip_triangle.hpp"
#include "lattice/medium.hpp"
#include "lattice/steady_state.hpp"

using namespace sunfleck;

namespace {

constexpr std::size_t all_directions = lattice_directions + 1;

/// Light on a periodic grid, at rest and along all directions, taken step by step in time.
class Stepper {
 public:
  Stepper(int nx, int ny, int nz) : n_{nx, ny, nz}, f(all_directions, std::vector<double>(static_cast<std::size_t>(nx * ny * nz), 0.0)) {}

  void step(const LatticeCollision& omega) {
    const std::size_t nodes = f[0].size();
    for (std::size_t i = 0; i < nodes; ++i) {
      std::array<double, all_directions> out{};
      for (std::size_t a = 0; a < all_directions; ++a) {
        out[a] = f[a][i];
        for (std::size_t b = 0; b < all_directions; ++b) out[a] += omega[a][b] * f[b][i];
      }
      for (std::size_t a = 0; a < all_directions; ++a) f[a][i] = out[a];
    }
    std::vector<double> moved(nodes);
    for (std::size_t d = 0; d < lattice_directions; ++d) {
      for (int z = 0; z < n_[2]; ++z)
        for (int y = 0; y < n_[1]; ++y)
          for (int x = 0; x < n_[0]; ++x)
            moved[at(x + lattice_step[d][0], y + lattice_step[d][1], z + lattice_step[d][2])] = f[d + 1][at(x, y, z)];
      f[d + 1] = moved;
    }
  }
  std::size_t at(int x, int y, int z) const {
    const auto wrap = [](int a, int n) { return (a % n + n) % n; };
    return static_cast<std::size_t>((wrap(z, n_[2]) * n_[1] + wrap(y, n_[1])) * n_[0] + wrap(x, n_[0]));
  }
  double sum() const {
    double all = 0;
    for (const auto& g : f)
      for (const double v : g) all += v;
    return all;
  }

 private:
  std::array<int, 3> n_;

 public:
  std::vector<std::vector<double>> f;  ///< at rest first
};

double diffusion(double absorption, double scattering) {
  return (2.0 / (absorption + scattering) - 1.0) / (4.0 * (1.0 + absorption));
}

/// Of a long wave along a direction: its decay in a step, from the largest eigenvalue of collision and streaming.
double diffusion_along(const Vec3& direction, const LatticeCollision& omega) {
  constexpr double k = 1e-3;
  const Vec3 wave = k * glm::normalize(direction);
  std::array<std::complex<double>, all_directions> v{}, next{};
  v.fill(1.0);
  std::complex<double> half = 0;
  for (int i = 0; i < 4000; ++i) {
    for (std::size_t a = 0; a < all_directions; ++a) {
      next[a] = v[a];
      for (std::size_t b = 0; b < all_directions; ++b) next[a] += omega[a][b] * v[b];
      if (a > 0) {
        const auto& c = lattice_step[a - 1];
        next[a] *= std::polar(1.0, -glm::dot(wave, Vec3{c[0], c[1], c[2]}));
      }
    }
    for (std::size_t a = 0; a < all_directions; ++a) next[a] = 0.5 * (next[a] + v[a]);  // waves that change sign at each step die out
    half = next[1] / v[1];
    for (std::size_t a = 0; a < all_directions; ++a) v[a] = next[a] / next[1];
  }
  const std::complex<double> eigenvalue = 2.0 * half - 1.0;
  return -std::log(std::abs(eigenvalue)) / (k * k);
}

/// Leaves over a grid at random.
std::vector<NodeArea> random_leaves(const NodeGrid& grid, double area) {
  RandomStream random(3);
  std::vector<NodeArea> out;
  for (std::uint32_t i = 0; i < grid.nodes(); ++i)
    if (random.next() < 0.6) out.push_back({i, 0, area * random.next()});
  return out;
}

Optics leaf(double rho, double tau) {
  return {"leaf", {static_cast<float>(rho)}, {static_cast<float>(rho)}, {static_cast<float>(tau)}};
}

}  // namespace

TEST_CASE("columns of the collision sum up to nothing: no light is lost or made", "[lattice]") {
  for (const double g : {-1.0, -0.5, 0.0, 0.3, 0.9, 1.0})
    for (const auto& [absorption, scattering] : {std::pair{0.01, 0.99}, {0.109, 0.891}, {0.0, 0.3}, {0.3, 0.5}}) {
      const auto omega = lattice_collision(absorption, scattering, lattice_phase(g));
      for (std::size_t j = 0; j < all_directions; ++j) {
        double sum = 0;
        for (std::size_t i = 0; i < all_directions; ++i) sum += omega[i][j];
        CHECK(std::abs(sum) < 1e-14);
      }
    }
}

TEST_CASE("forward scattering that keeps its way passes through, backward scattering turns back", "[lattice]") {
  const auto on = lattice_phase(1.0), back = lattice_phase(-1.0);
  for (std::size_t j = 0; j < lattice_directions; ++j) {
    CHECK(lattice_weight(j) * on[j][j] == Approx(1.0));
    CHECK(lattice_weight(j ^ 1u) * back[j ^ 1u][j] == Approx(1.0));  // opposites stand side by side
  }
}

TEST_CASE("light without absorption is the same after a thousand steps", "[lattice]") {
  Stepper grid(6, 5, 4);
  RandomStream random(1);
  for (auto& g : grid.f)
    for (auto& v : g) v = random.next();
  const double before = grid.sum();
  const auto omega = lattice_collision(0.0, 0.7, lattice_phase(0.4));
  for (int i = 0; i < 1000; ++i) grid.step(omega);
  CHECK(std::abs(grid.sum() / before - 1.0) < 1e-12);
}

TEST_CASE("long waves diffuse alike along axes and diagonals", "[lattice]") {
  for (const auto& [absorption, scattering] : {std::pair{0.01, 0.99}, {0.109, 0.891}, {0.3, 0.5}}) {
    const auto omega = lattice_collision(absorption, scattering, lattice_phase(0.0));
    for (const Vec3& along : {Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{1, 1, 1}})
      CHECK(diffusion_along(along, omega) == Approx(diffusion(absorption, scattering)).epsilon(1e-6));
  }
}

TEST_CASE("a sine decays as diffusion has it", "[lattice]") {
  constexpr int n = 64;
  constexpr double absorption = 0.109, scattering = 0.891, k = 2 * 3.14159265358979 / n;
  Stepper grid(n, 1, 1);
  for (int x = 0; x < n; ++x) {
    const double rho = 1 + 0.5 * std::sin(k * x);
    grid.f[0][static_cast<std::size_t>(x)] = absorption * rho / (1 + absorption);
    for (std::size_t d = 0; d < lattice_directions; ++d)
      grid.f[d + 1][static_cast<std::size_t>(x)] = lattice_weight(d) * rho / (1 + absorption);
  }
  const auto amplitude = [&] {
    std::complex<double> sum = 0;
    for (int x = 0; x < n; ++x)
      for (const auto& g : grid.f) sum += g[static_cast<std::size_t>(x)] * std::polar(1.0, -k * x);
    return std::abs(sum);
  };
  const auto omega = lattice_collision(absorption, scattering, lattice_phase(0.0));
  for (int i = 0; i < 500; ++i) grid.step(omega);
  const double early = amplitude();
  for (int i = 0; i < 1500; ++i) grid.step(omega);
  CHECK(std::log(early / amplitude()) / (1500 * k * k) == Approx(diffusion(absorption, scattering)).epsilon(1e-3));
}

TEST_CASE("triangles are cut by cells without loss, and where they are", "[lattice]") {
  const NodeGrid grid{{-1, -2, 0}, {5, 7, 3}, Vec3{0.5, 0.4, 0.6}, 0.5};
  RandomStream random(5);
  for (int i = 0; i < 200; ++i) {
    Triangle t;
    for (auto& p : t) p = {-1 + 2.5 * random.next(), -2 + 2.8 * random.next(), 1.8 * random.next()};
    std::vector<CellShare> cells;
    clip_to_cells(grid, t, false, false, cells);
    double sum = 0;
    std::vector<double> share(grid.nodes(), 0.0), sampled(grid.nodes(), 0.0);
    for (const auto& c : cells) sum += c.share, share[c.node] += c.share;
    CHECK(sum == Approx(1.0).epsilon(1e-6));
    if (i >= 5) continue;
    constexpr int points = 40000;
    for (int k = 0; k < points; ++k) {
      const auto [a, b] = r2_point(static_cast<std::uint64_t>(k));
      const double root = std::sqrt(a);
      const Vec3 p = ((1 - root) * t[0] + root * (1 - b) * t[1] + root * b * t[2] - grid.low) / grid.cell;
      sampled[static_cast<std::size_t>((static_cast<int>(p.z) * grid.n[1] + static_cast<int>(p.y)) * grid.n[0] + static_cast<int>(p.x))] +=
          1.0 / points;
    }
    for (std::size_t n = 0; n < grid.nodes(); ++n) CHECK(share[n] == Approx(sampled[n]).margin(0.004));
  }
}

TEST_CASE("what lies beyond the grid has no cell, or goes round a periodic one", "[lattice]") {
  const NodeGrid grid{{0, 0, 0}, {4, 4, 2}, Vec3{1.0}, 1.0};
  const Triangle beyond{Vec3{-2, 0.5, 0.5}, Vec3{2, 0.5, 0.5}, Vec3{0, 0.5, 1.5}};
  const auto sum = [&](bool periodic) {
    std::vector<CellShare> cells;
    clip_to_cells(grid, beyond, periodic, false, cells);
    double all = 0;
    for (const auto& c : cells) all += c.share;
    return all;
  };
  CHECK(sum(false) == Approx(0.5));
  CHECK(sum(true) == Approx(1.0));
}

TEST_CASE("the steady state is where steps in time end", "[lattice]") {
  const NodeGrid grid{{0, 0, 0}, {5, 4, 3}, Vec3{1.0}, 1.0};
  const auto leaves = random_leaves(grid, 1.2);
  for (const auto mapping : {LatticeMapping::matched, LatticeMapping::paper}) {
    auto medium = lattice_medium(grid, true, leaves, {leaf(0.3, 0.15)}, nullptr, {}, mapping, 1.0, false, 1);
    std::vector<LatticeColumn> column(1);
    column[0].source.assign(medium.nodes(), 0.0);
    for (const auto& l : leaves) column[0].source[l.node] += l.area;
    const auto steady = steady_state(medium, column, {1e-12, 5000}, silent(), [](std::uint32_t, double) {});
    // in time, every node with its own coefficients; periodic in x and y, open above and below by two black planes
    std::vector<std::vector<double>> f(lattice_directions, std::vector<double>(medium.nodes(), 0.0));
    const auto phase = mapping == LatticeMapping::paper ? medium.phase[0] : lattice_phase(0.0);
    for (int t = 0; t < 3000; ++t) {
      auto next = std::vector<std::vector<double>>(lattice_directions, std::vector<double>(medium.nodes(), 0.0));
      for (std::int64_t z = 0; z < 3; ++z)
        for (std::int64_t y = 0; y < 4; ++y)
          for (std::int64_t x = 0; x < 5; ++x) {
            const auto i = static_cast<std::size_t>((z * 4 + y) * 5 + x);
            for (std::size_t d = 0; d < lattice_directions; ++d) {
              double in = 0;
              for (std::size_t j = 0; j < lattice_directions; ++j) in += phase[d][j] * f[j][i];
              const auto& c = lattice_step[d];
              if (z + c[2] < 0 || z + c[2] > 2) continue;
              const auto to = static_cast<std::size_t>(((z + c[2]) * 4 + (y + c[1] + 4) % 4) * 5 + (x + c[0] + 5) % 5);
              next[d][to] = medium.passes[i] * f[d][i] + lattice_weight(d) * (medium.scatters[i] * in + column[0].source[i]);
            }
          }
      f.swap(next);
    }
    double absorbed = 0, sent = 0;
    for (std::size_t i = 0; i < medium.nodes(); ++i) {
      double sum = 0;
      for (const auto& g : f) sum += g[i];
      CHECK(steady.columns[0].light[i] == Approx(sum).epsilon(1e-8));
      absorbed += medium.absorbs[i] * steady.columns[0].light[i], sent += column[0].source[i];
    }
    CHECK(absorbed + steady.columns[0].escaped == Approx(sent).epsilon(1e-10));
    CHECK(steady.residual < 1e-10);
  }
}

TEST_CASE("ground is in the system: what it does not take comes back up", "[lattice]") {
  const NodeGrid grid{{0, 0, 0}, {6, 6, 4}, Vec3{1.0}, 1.0};
  const auto leaves = random_leaves(grid, 0.8);
  const auto ground = leaf(0.4, 0.0);
  for (const bool periodic : {true, false}) {
    const std::vector<double> share(grid.plane(), 1.0);
    auto medium = lattice_medium(grid, periodic, leaves, {leaf(0.45, 0.4)}, &ground, share, LatticeMapping::matched, 1.0, false, 1);
    std::vector<LatticeColumn> column(1);
    column[0].source.assign(medium.nodes(), 0.0);
    double sent = 0, absorbed = 0;
    for (const auto& l : leaves) column[0].source[medium.row(l.node)] += l.area, sent += l.area;
    column[0].source[7] = 4.0 * 2.5, sent += 2.5;  // of the ground, four times what it sends
    const auto steady = steady_state(medium, column, {1e-10, 500}, silent(), [](std::uint32_t, double) {});
    for (std::size_t i = 0; i < medium.nodes(); ++i) absorbed += medium.absorbs[i] * steady.columns[0].light[i];
    CHECK(absorbed + steady.columns[0].escaped == Approx(sent).epsilon(1e-8));
    CHECK(steady.columns[0].light[0] > 0.0);
  }
}
