#include <sunfleck/lattice/lattice.hpp>

#include <cmath>

namespace sunfleck {

namespace {

double cosine_between(std::size_t i, std::size_t j) {
  double dot = 0, a = 0, b = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    dot += lattice_step[i][k] * lattice_step[j][k];
    a += lattice_step[i][k] * lattice_step[i][k];
    b += lattice_step[j][k] * lattice_step[j][k];
  }
  return dot / std::sqrt(a * b);
}

}  // namespace

LatticePhase lattice_phase(double g) {
  LatticePhase phase{};
  constexpr double nearly = 1e-9;  // there the function is 0 / 0 in one direction, and nothing in all others
  for (std::size_t j = 0; j < lattice_directions; ++j) {
    double sum = 0;
    for (std::size_t i = 0; i < lattice_directions; ++i) {
      const double cosine = cosine_between(i, j);
      const bool sharp = std::abs(g) > 1.0 - nearly;
      phase[i][j] = sharp ? (std::abs(cosine - std::copysign(1.0, g)) < nearly ? 1.0 : 0.0)
                          : (1.0 - g * g) / std::pow(1.0 - 2.0 * g * cosine + g * g, 1.5);
      sum += lattice_weight(i) * phase[i][j];
    }
    for (std::size_t i = 0; i < lattice_directions; ++i) phase[i][j] /= sum;
  }
  return phase;
}

LatticeCollision lattice_collision(double absorption, double scattering, const LatticePhase& phase) {
  LatticeCollision omega{};
  omega[0][0] = -1.0;
  for (std::size_t j = 0; j < lattice_directions; ++j) {
    omega[0][j + 1] = absorption;
    omega[j + 1][0] = lattice_weight(j);
    for (std::size_t i = 0; i < lattice_directions; ++i) omega[i + 1][j + 1] = scattering * lattice_weight(i) * phase[i][j];
    omega[j + 1][j + 1] -= absorption + scattering;
  }
  return omega;
}

}  // namespace sunfleck
