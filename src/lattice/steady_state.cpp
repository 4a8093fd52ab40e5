#include "lattice/steady_state.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "lattice/sweep.hpp"

namespace sunfleck {

namespace {

using NodeValues = std::vector<double>;

std::array<double, 3> unit_step(std::size_t direction) {
  const auto& c = lattice_step[direction];
  const double length = std::sqrt(static_cast<double>(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]));
  return {c[0] / length, c[1] / length, c[2] / length};
}

/// Even scattering; sums up what arrives.
struct EvenLight {
  double weight;
  const double* source;
  double* light;
  double sent(std::size_t node) const { return weight * source[node]; }
  void arrives(std::size_t node, double f) const { light[node] += f; }
  double enters(std::int64_t, std::int64_t, std::int64_t) const { return 0.0; }
};

/// The same, with flux and light from outside.
struct WholeLight {
  double weight;
  const double* source;
  double* light;
  std::array<double*, 3> flux;
  std::array<double, 3> unit;
  std::size_t direction;
  const LatticeInflow* inflow;
  double sent(std::size_t node) const { return weight * source[node]; }
  void arrives(std::size_t node, double f) const {
    light[node] += f;
    for (std::size_t k = 0; k < 3; ++k) flux[k][node] += f * unit[k];
  }
  double enters(std::int64_t x, std::int64_t y, std::int64_t z) const { return *inflow ? (*inflow)(direction, x, y, z) : 0.0; }
};

/// Scattering by direction; keeps what arrives along each.
struct DirectedLight {
  const double* source;
  double* light;
  std::size_t direction;
  const LatticeInflow* inflow;
  double sent(std::size_t node) const { return source[node]; }
  void arrives(std::size_t node, double f) const { light[node] = f; }
  double enters(std::int64_t x, std::int64_t y, std::int64_t z) const { return *inflow ? (*inflow)(direction, x, y, z) : 0.0; }
};

double dot(const NodeValues& a, const NodeValues& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

class EvenScattering {
 public:
  EvenScattering(const LatticeMedium& medium, std::vector<LatticeColumn>& columns, const SteadySettings& settings, const Progress& progress)
      : medium_(medium), columns_(columns), settings_(settings), progress_(progress), n_(medium.nodes()), work_(columns.size()) {
    root_.resize(medium.bands * n_);
    for (std::size_t i = 0; i < root_.size(); ++i) root_[i] = std::sqrt(medium.scatters[i]);
  }

  SteadyState run(const std::function<void(std::uint32_t, double)>& iterated) {
    SteadyState out;
    start();
    double worst = 1.0;
    while (out.iterations < settings_.most_iterations && worst > settings_.tolerance) {
      progress_.check();
      worst = step();
      iterated(++out.iterations, worst);
    }
    finish(out);
    return out;
  }

 private:
  struct Work {
    NodeValues psi, rest, towards, sent;
    std::array<NodeValues, 3> light;  ///< of each group of directions
    double first = 0, square = 0;
    bool done = false;
  };
  const double* root(std::size_t column) const { return root_.data() + columns_[column].band * n_; }

  /// T applied to Work::sent of all columns that are not done, into Work::light.
  void sweep() {
    tbb::parallel_for(std::size_t{0}, work_.size() * lattice_groups.size(), [&](std::size_t task) {
      const std::size_t column = task / lattice_groups.size(), group = task % lattice_groups.size();
      auto& w = work_[column];
      if (w.done) return;
      w.light[group].assign(n_, 0.0);
      for (std::size_t d = 0; d < lattice_directions; ++d)
        if (in_group(d, lattice_groups[group]))
          DirectionSweep<EvenLight>(medium_, columns_[column].band, d, {lattice_weight(d), w.sent.data(), w.light[group].data()}).run();
    });
  }

  void start() {
    tbb::parallel_for(std::size_t{0}, work_.size(), [&](std::size_t c) {
      auto& w = work_[c];
      auto whole = swept(c, columns_[c].source);
      w.psi.assign(n_, 0.0), w.rest.resize(n_);
      for (std::size_t i = 0; i < n_; ++i) w.rest[i] = root(c)[i] * whole.light[i];
      w.towards = w.rest, w.sent.resize(n_);
      w.first = w.square = dot(w.rest, w.rest);
      w.done = !(w.first > 0.0);
    });
  }

  double step() {
    for_active([&](Work& w, const double* root) {
      for (std::size_t i = 0; i < n_; ++i) w.sent[i] = root[i] * w.towards[i];
    });
    sweep();
    for_active([&](Work& w, const double* root) {
      double bend = 0.0;
      for (std::size_t i = 0; i < n_; ++i) {
        w.sent[i] = w.towards[i] - root[i] * (w.light[0][i] + w.light[1][i] + w.light[2][i]);
        bend += w.sent[i] * w.towards[i];
      }
      const double length = bend > 0.0 ? w.square / bend : 0.0;
      double square = 0.0;
      for (std::size_t i = 0; i < n_; ++i) {
        w.psi[i] += length * w.towards[i];
        w.rest[i] -= length * w.sent[i];
        square += w.rest[i] * w.rest[i];
      }
      const double kept = square / w.square;
      w.square = square;
      for (std::size_t i = 0; i < n_; ++i) w.towards[i] = w.rest[i] + kept * w.towards[i];
      w.done = !(bend > 0.0) || square <= settings_.tolerance * settings_.tolerance * w.first;
    });
    double worst = 0.0;
    for (const auto& w : work_)
      if (w.first > 0.0) worst = std::max(worst, std::sqrt(w.square / w.first));
    return worst;
  }

  template <class F>
  void for_active(const F& f) {
    tbb::parallel_for(std::size_t{0}, work_.size(), [&](std::size_t c) {
      if (!work_[c].done) f(work_[c], root(c));
    });
  }

  LatticeLight swept(std::size_t column, const NodeValues& sent) const {
    LatticeLight out;
    out.light.assign(n_, 0.0);
    for (auto& f : out.flux) f.assign(n_, 0.0);
    for (std::size_t d = 0; d < lattice_directions; ++d)
      out.escaped += DirectionSweep<WholeLight>(medium_, columns_[column].band, d,
                                                {lattice_weight(d),
                                                 sent.data(),
                                                 out.light.data(),
                                                 {out.flux[0].data(), out.flux[1].data(), out.flux[2].data()},
                                                 unit_step(d),
                                                 d,
                                                 &columns_[column].inflow})
                         .run();
    return out;
  }

  /// Once more, with all that is sent: light, flux and what escapes; and the residual that is left.
  void finish(SteadyState& out) {
    out.columns.resize(columns_.size());
    std::vector<double> residual(columns_.size(), 0.0);
    tbb::parallel_for(std::size_t{0}, columns_.size(), [&](std::size_t c) {
      auto& w = work_[c];
      for (auto* field : {&w.rest, &w.towards, &w.light[0], &w.light[1], &w.light[2]}) NodeValues().swap(*field);
      for (std::size_t i = 0; i < n_; ++i) w.sent[i] = root(c)[i] * w.psi[i] + columns_[c].source[i];
      out.columns[c] = swept(c, w.sent);
      double square = 0.0;
      for (std::size_t i = 0; i < n_; ++i) {
        const double off = root(c)[i] * out.columns[c].light[i] - w.psi[i];
        square += off * off;
      }
      residual[c] = w.first > 0.0 ? std::sqrt(square / w.first) : 0.0;
      NodeValues().swap(w.sent), NodeValues().swap(w.psi);
    });
    for (const double r : residual) out.residual = std::max(out.residual, r);
  }

  const LatticeMedium& medium_;
  std::vector<LatticeColumn>& columns_;
  const SteadySettings& settings_;
  const Progress& progress_;
  const std::size_t n_;
  std::vector<Work> work_;
  NodeValues root_;
};

/// One column with a phase function, sweep after sweep.
class DirectedScattering {
 public:
  DirectedScattering(const LatticeMedium& medium, const LatticeColumn& column, const SteadySettings& settings, const Progress& progress)
      : medium_(medium), column_(column), settings_(settings), progress_(progress), n_(medium.nodes()), first_(n_ - medium.grid.nodes()) {
    for (std::size_t d = 0; d < lattice_directions; ++d) {
      light_[d].assign(n_, 0.0);
      sent_[d].resize(n_);
      for (std::size_t i = 0; i < n_; ++i) sent_[d][i] = lattice_weight(d) * column.source[i];
    }
  }

  LatticeLight run(std::uint32_t& iterations, double& residual, const std::function<void(std::uint32_t, double)>& iterated) {
    double first = 0.0, escaped = 0.0;
    for (iterations = 0, residual = 1.0; iterations < settings_.most_iterations && residual > settings_.tolerance;) {
      progress_.check();
      escaped = sweep();
      const double change = send();
      if (iterations++ == 0) first = change;
      residual = first > 0.0 ? change / first : 0.0;
      iterated(iterations, residual);
    }
    LatticeLight out;
    out.escaped = escaped;
    out.light.assign(n_, 0.0);
    for (auto& f : out.flux) f.assign(n_, 0.0);
    for (std::size_t d = 0; d < lattice_directions; ++d) {
      const auto unit = unit_step(d);
      for (std::size_t i = 0; i < n_; ++i) {
        out.light[i] += light_[d][i];
        for (std::size_t k = 0; k < 3; ++k) out.flux[k][i] += light_[d][i] * unit[k];
      }
    }
    return out;
  }

 private:
  double sweep() {
    std::array<double, lattice_directions> escaped{};
    tbb::parallel_for(std::size_t{0}, lattice_directions, [&](std::size_t d) {
      std::fill(light_[d].begin(), light_[d].end(), 0.0);
      escaped[d] = DirectionSweep<DirectedLight>(medium_, column_.band, d, {sent_[d].data(), light_[d].data(), d, &column_.inflow}).run();
    });
    double sum = 0.0;
    for (const double e : escaped) sum += e;
    return sum;
  }

  /// What goes out of every node next; returns how much it changed [W].
  double send() {
    const auto& phase = medium_.phase[column_.band];
    const double* scatters = medium_.scatters.data() + column_.band * n_;
    const std::size_t plane = medium_.grid.plane();
    std::vector<double> changes(medium_.planes(), 0.0);
    tbb::parallel_for(std::size_t{0}, medium_.planes(), [&](std::size_t z) {
      for (std::size_t i = z * plane; i < (z + 1) * plane; ++i)
        for (std::size_t d = 0; d < lattice_directions; ++d) {
          double in = 0.0;
          for (std::size_t j = 0; j < lattice_directions; ++j) in += (i < first_ ? 1.0 : phase[d][j]) * light_[j][i];
          const double sends = lattice_weight(d) * (scatters[i] * in + column_.source[i]);
          changes[z] += std::abs(sends - sent_[d][i]);
          sent_[d][i] = sends;
        }
    });
    double change = 0.0;
    for (const double c : changes) change += c;
    return change;
  }

  const LatticeMedium& medium_;
  const LatticeColumn& column_;
  const SteadySettings& settings_;
  const Progress& progress_;
  const std::size_t n_, first_;
  std::array<NodeValues, lattice_directions> light_, sent_;
};

}  // namespace

SteadyState steady_state(const LatticeMedium& medium, std::vector<LatticeColumn>& columns, const SteadySettings& settings,
                         const Progress& progress, const std::function<void(std::uint32_t, double)>& iterated) {
  if (medium.phase.empty()) return EvenScattering(medium, columns, settings, progress).run(iterated);
  SteadyState out;
  for (const auto& column : columns) {
    std::uint32_t iterations = 0;
    double residual = 0;
    out.columns.push_back(DirectedScattering(medium, column, settings, progress).run(iterations, residual, iterated));
    out.iterations = std::max(out.iterations, iterations);
    out.residual = std::max(out.residual, residual);
  }
  return out;
}

}  // namespace sunfleck
