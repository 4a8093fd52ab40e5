#include <sunfleck/lattice/solve.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/free_memory.hpp>
#include <sunfleck/core/text_units.hpp>
#include <sunfleck/scene/placed_scene.hpp>

#include "lattice/clumping.hpp"
#include "lattice/own_lattice.hpp"
#include "lattice/stand_grid.hpp"

namespace sunfleck {

namespace {

constexpr std::uint64_t words_a_column = 12;                     // source, conjugate gradients, groups of directions, light and flux
constexpr std::uint64_t words_a_directed_column = 42;            // light and what is sent along 18 directions
constexpr std::uint64_t bytes_at_once = std::uint64_t{1} << 30;  // of columns that are worked on together
constexpr double widest_apart = 1.0;  // boxes of plants over the box of the stand, up to which they count as standing apart
constexpr double fewest_cells = 2.0;  // of the stand's lattice along a plant's longest side, from which one of its own is finer
constexpr std::size_t chunk = 16384;  // facets
constexpr std::uint64_t most_nodes_in_all = 0xffffffff;

void check_scene_for_lattice(const Scene& scene, const LatticeSettings& settings) {
  if (!scene.sensors.empty())
    throw InputError(location(scene.file, 0, "sensor"), "a sensor with method 'lattice'",
                     "clustering, flat, direct or reference, which know sensors");
  if (scene.periodic && !scene.periodic->is_level())
    throw InputError(location(scene.file, 0, "domain.slope"), "a slope with method 'lattice'",
                     "instantiation, clustering, flat, direct or reference, which know slopes");
  if (settings.nodes < LatticeSettings::fewest_nodes || settings.nodes > LatticeSettings::most_nodes)
    throw UsageError(fmt::format("lattice nodes: found {}; expected {} to {} along the longest side", settings.nodes,
                                 LatticeSettings::fewest_nodes, LatticeSettings::most_nodes));
}

std::uint64_t nodes_of(const NodeGrid& grid, bool flat_ground) {
  return grid.nodes() + (flat_ground ? grid.plane() : 0);
}

std::uint64_t words_of(LatticeMapping mapping) {
  return mapping == LatticeMapping::paper ? words_a_directed_column : words_a_column;
}

/// Columns that are worked on together.
std::uint64_t columns_at_once(std::uint64_t nodes, std::size_t columns, LatticeMapping mapping) {
  return std::clamp<std::uint64_t>(bytes_at_once / std::max<std::uint64_t>(nodes * words_of(mapping) * sizeof(double), 1), 1, columns);
}

std::uint64_t bytes_of(const NodeGrid& grid, const Scene& scene, const LatticeSettings& settings) {
  const std::uint64_t nodes = nodes_of(grid, has_flat_ground(scene)), bands = scene.band_count();
  return nodes * sizeof(double) *
         (4 * bands + words_of(settings.mapping) * columns_at_once(nodes, scene.states.size() * bands, settings.mapping));
}

class LatticeSolver {
 public:
  LatticeSolver(const Scene& scene, const FacetScene& facets, const DirectFacets& direct, const LatticeSettings& settings,
                IrradianceSink& sink, Progress& progress)
      : scene_(scene),
        facets_(facets),
        direct_(direct),
        settings_(settings),
        sink_(sink),
        progress_(progress),
        flat_(has_flat_ground(scene)),
        leaf_facets_(flat_ ? facets.plant_facets : facets.size()) {
    steady_.tolerance = settings.tolerance > 0.0 ? settings.tolerance : steady_.tolerance;
  }

  SolveReport run() {
    report_.method = "lattice";
    report_.balance = direct_.balance;
    Stopwatch watch;
    const auto timed = [&](const char* phase) {
      add_seconds(report_.timings, phase, watch.seconds());
      watch = {};
    };
    const NodeGrid grid = stand_grid(scene_, facets_, settings_.nodes);
    sides_ = open_sides(facets_);
    cells_ = FacetCells(grid, scene_.periodic.has_value(), facets_.size(), leaf_facets_, [&](std::size_t f) { return facets_.corners[f]; });
    make_medium(grid);
    make_own();
    report_.counts = {{"nodes", medium_.nodes()}, {"own_lattices", own_.size()}};
    progress_.line(fmt::format("lattice: {} x {} x {} nodes, {:.3g} m apart{}", grid.n[0], grid.n[1], grid.n[2], grid.spacing,
                               finer_.empty() ? ""
                                              : fmt::format("; {} for {}", counted(own_.size(), "finer one", "finer ones"),
                                                            counted(finer_.size(), "plant", "plants"))));
    timed("leaf area");
    scattered_.assign(columns() * facets_.size() * 2, 0.0f);
    const auto together = static_cast<std::size_t>(columns_at_once(medium_.nodes(), columns(), settings_.mapping));
    for (std::size_t first = 0; first < columns(); first += together) scatter(first, std::min(together, columns() - first));
    timed("scattering");
    report_.memory = {
        {"lattice", bytes_of(grid, scene_, settings_)}, {"cells", cells_.bytes()}, {"light", scattered_.capacity() * sizeof(float)}};
    write();
    timed("rows");
    return std::move(report_);
  }

 private:
  std::size_t bands() const { return scene_.band_count(); }
  std::size_t states() const { return scene_.states.size(); }
  std::size_t columns() const { return states() * bands(); }
  const Optics& optics(std::size_t facet) const { return facets_.materials[facets_.optics[facet]]; }
  double direct(std::size_t column, std::size_t facet, std::size_t side) const {
    return direct_.light.on(facet, static_cast<int>(side), column % bands(), column / bands());
  }
  float& scattered(std::size_t column, std::size_t facet, std::size_t side) {
    return scattered_[(column * facets_.size() + facet) * 2 + side];
  }

  void make_medium(const NodeGrid& grid) {
    std::vector<NodeArea> leaves;
    for (std::size_t f = 0; f < leaf_facets_; ++f)
      for (const auto& cell : cells_.of(f))
        if (facets_.area[f] > 0.0f) leaves.push_back({cell.node, facets_.optics[f], leaf_area_of(facets_.area[f], sides_[f]) * cell.share});
    std::vector<double> share(flat_ ? grid.plane() : 0, 0.0);
    for (std::size_t f = leaf_facets_; f < facets_.size(); ++f)
      for (const auto& cell : cells_.of(f)) share[cell.node] += facets_.area[f] * cell.share / (grid.cell.x * grid.cell.y);
    for (auto& s : share) s = std::min(s, 1.0);
    const auto medium = [&](double density, bool black) {
      return lattice_medium(grid, scene_.periodic.has_value(), leaves, facets_.materials, flat_ ? &scene_.ground->optics : nullptr, share,
                            settings_.mapping, density, black, black ? 1 : bands());
    };
    if (settings_.mapping == LatticeMapping::matched && !leaves.empty()) {
      const double wanted = recollision(facets_, leaf_facets_, sides_, *direct_.rays);
      density_ = matching_density(wanted, [&](double density) { return recollision(medium(density, true), leaves, progress_); });
      progress_.line(
          fmt::format("lattice: leaves meet {:.1f} % of each other's light, as {:.2f} times their area would", 100.0 * wanted, density_));
    }
    medium_ = medium(density_, false);
  }

  /// Finer lattices where plants stand apart: there one of the stand has few nodes in each.
  void make_own() {
    if (facets_.copies.size() < 2) return;
    std::vector<Box> boxes(facets_.copies.size());
    Box all;
    std::vector<std::size_t> first(facets_.copies.size(), facets_.size());
    for (std::size_t s = 0; s < facets_.shapes.size(); ++s) {
      const auto& shape = facets_.shapes[s];
      const std::size_t end = s + 1 < facets_.shapes.size() ? facets_.shapes[s + 1].first_facet : facets_.plant_facets;
      first[shape.copy] = std::min<std::size_t>(first[shape.copy], shape.first_facet);
      for (std::size_t f = shape.first_facet; f < end; ++f)
        for (const auto& p : facets_.corners[f]) boxes[shape.copy].add(p);
    }
    double filled = 0.0;
    for (const auto& box : boxes) {
      if (box.empty()) continue;
      all.add(box);
      filled += box.size().x * box.size().y * box.size().z;
    }
    const Vec3 size = all.size();
    if (filled > widest_apart * size.x * size.y * size.z) return;
    std::vector<std::size_t> own_of(scene_.plants.size(), scene_.plants.size());
    for (std::size_t c = 0; c < boxes.size(); ++c) {
      if (boxes[c].empty()) continue;
      const Vec3 extent = boxes[c].size();
      if (std::max({extent.x, extent.y, extent.z}) < fewest_cells * medium_.grid.spacing) continue;
      const auto plant = facets_.copy_plant[c];
      if (own_of[plant] == scene_.plants.size()) {
        own_of[plant] = own_.size();
        const std::size_t n = scene_.plants[plant].plant->facet_count();
        const auto from = sides_.begin() + static_cast<std::ptrdiff_t>(first[c]);
        own_.emplace_back(plant_facets(scene_.plants[plant]), std::vector<OpenSides>(from, from + static_cast<std::ptrdiff_t>(n)),
                          facets_.materials, settings_.own_nodes, settings_.mapping, density_, bands());
        own_facets_.push_back(n);
      }
      finer_.push_back({c, own_of[plant], first[c]});
    }
  }

  void scatter(std::size_t first, std::size_t count) {
    std::vector<LatticeColumn> column(count);
    std::vector<double> beside(count, 0.0);  // what ground beyond the lattice sends on
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { beside[i] = fill(first + i, column[i]); });
    Stopwatch watch;
    auto steady = steady_state(medium_, column, steady_, progress_, [&](std::uint32_t iteration, double residual) {
      report_.convergence.push_back({0, iteration, residual, 0, watch.seconds()});
      progress_.fraction("lattice", std::clamp(std::log(residual) / std::log(steady_.tolerance), 0.0, 1.0));
    });
    progress_.line(fmt::format("lattice: {} sweeps, residual {:.1e}", steady.iterations, steady.residual));
    if (!(steady.residual <= 10.0 * steady_.tolerance)) report_.status = SolveStatus::not_converged;
    if (!report_.convergence.empty()) report_.convergence.back().residual = steady.residual;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { light_facets(first + i, steady.columns[i]); });
    for (std::size_t i = 0; i < count; ++i) refine(first + i, steady.columns[i]);
    for (std::size_t i = 0; i < count; ++i) balance(first + i, steady.columns[i], beside[i]);
  }

  /// What facets send on of their direct light.
  double fill(std::size_t column, LatticeColumn& out) const {
    const std::size_t band = column % bands();
    double beside = 0.0;
    out.band = band;
    out.source.assign(medium_.nodes(), 0.0);
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      const bool low = f >= leaf_facets_;
      const double power = facets_.area[f] * (low ? optics(f).reflectance_front[band] * direct(column, f, 0)
                                                  : sent_on(optics(f), band, direct(column, f, 0), direct(column, f, 1)));
      if (!(power > 0.0)) continue;
      double inside = 0.0;
      for (const auto& cell : cells_.of(f)) {
        out.source[low ? cell.node : medium_.row(cell.node)] += (low ? 4.0 : 1.0) * cell.share * power;
        inside += cell.share;
      }
      beside += power * std::max(0.0, 1.0 - inside);
    }
    return beside;
  }

  void light_facets(std::size_t column, const LatticeLight& light) {
    const std::size_t band = column % bands();
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      if (!(facets_.area[f] > 0.0f)) continue;
      if (f >= leaf_facets_) {
        scattered(column, f, 0) = static_cast<float>(on_ground(medium_, light, cells_.of(f)));
        continue;
      }
      const Vec3 vector = area_vector(facets_.corners[f]);
      const auto sides = on_leaf(medium_, light, band, cells_.of(f), vector / glm::length(vector), sides_[f]);
      scattered(column, f, 0) = static_cast<float>(sides.front);
      scattered(column, f, 1) = static_cast<float>(sides.back);
    }
  }

  /// The light of plants with lattices of their own: its pattern from there, its sum from the stand's.
  void refine(std::size_t column, const LatticeLight& light) {
    const StandLight stand(medium_, light);
    const std::size_t band = column % bands();
    tbb::parallel_for(std::size_t{0}, finer_.size(), [&](std::size_t i) {
      const auto& copy = finer_[i];
      const std::size_t n = own_facets_[copy.own];
      std::vector<double> sends(n);
      for (std::size_t f = 0; f < n; ++f) {
        const std::size_t at = copy.first_facet + f;
        sends[f] = facets_.area[at] * sent_on(optics(at), band, direct(column, at, 0), direct(column, at, 1));
      }
      const auto own = own_[copy.own].light(facets_.copies[copy.copy], band, sends, stand, steady_, progress_);
      double whole = 0.0, fine = 0.0;
      for (std::size_t f = 0; f < n; ++f) {
        const std::size_t at = copy.first_facet + f;
        whole += facets_.area[at] * (scattered(column, at, 0) + scattered(column, at, 1));
        fine += facets_.area[at] * (own[2 * f] + own[2 * f + 1]);
      }
      const double scale = fine > 0.0 ? whole / fine : 0.0;
      for (std::size_t f = 0; f < n; ++f)
        for (std::size_t side = 0; side < 2; ++side)
          scattered(column, copy.first_facet + f, side) = static_cast<float>(scale * own[2 * f + side]);
    });
  }

  void balance(std::size_t column, const LatticeLight& light, double beside) {
    const std::size_t band = column % bands(), n = medium_.nodes(), ground_nodes = n - medium_.grid.nodes();
    auto& sums = report_.balance[column / bands()][band];
    double by_nodes = 0.0, by_facets = 0.0, ground = 0.0, mesh_ground = 0.0, below = 0.0;
    const double* absorbs = medium_.absorbs.data() + band * n;
    const double* scatters = medium_.scatters.data() + band * n;
    for (std::size_t i = ground_nodes; i < n; ++i) by_nodes += absorbs[i] * light.light[i];
    for (std::size_t i = 0; i < ground_nodes; ++i) {
      ground += absorbs[i] * light.light[i];
      below += (1.0 - absorbs[i] - scatters[i] / 4.0) * light.light[i];  // past the edge of the ground
    }
    for (std::size_t f = 0; f < leaf_facets_; ++f) {
      const double kept = facets_.area[f] * kept_of(optics(f), band, scattered(column, f, 0), scattered(column, f, 1));
      by_facets += kept;
      if (f >= facets_.plant_facets) mesh_ground += kept;
    }
    const double scale = by_facets > 0.0 ? by_nodes / by_facets : 1.0;
    for (std::size_t f = 0; f < leaf_facets_; ++f)
      for (std::size_t side = 0; side < 2; ++side) scattered(column, f, side) *= static_cast<float>(scale);
    sums.scattered_scale = scale;
    sums.leaves += scale * (by_facets - mesh_ground);
    sums.ground += ground + scale * mesh_ground;
    sums.escaped = light.escaped + below + beside;
  }

  void write() {
    const std::size_t n = facets_.size(), sides = 2 * bands();
    const bool has_sun =
        std::any_of(scene_.states.begin(), scene_.states.end(), [](const LightState& state) { return state.sun.has_value(); });
    std::vector<float> irradiance, sunlit;
    for (std::size_t first = 0; first < n; first += chunk) {
      progress_.check();
      const std::size_t count = std::min(chunk, n - first);
      irradiance.resize(states() * count * sides);
      if (has_sun) sunlit.resize(states() * count * 2);
      for (std::size_t s = 0; s < states(); ++s) {
        for (std::size_t i = 0; i < count; ++i)
          for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t b = 0; b < bands(); ++b)
              irradiance[((s * count + i) * 2 + side) * bands() + b] =
                  static_cast<float>(direct(s * bands() + b, first + i, side)) + scattered(s * bands() + b, first + i, side);
        if (has_sun)
          std::copy_n(direct_.light.sunlit.begin() + static_cast<std::ptrdiff_t>((s * n + first) * 2), count * 2,
                      sunlit.begin() + static_cast<std::ptrdiff_t>(s * count * 2));
      }
      sink_.rows({first, count, irradiance.data(), has_sun ? sunlit.data() : nullptr, nullptr});
    }
  }

  /// A copy of a plant with a lattice of its own.
  struct Finer {
    std::size_t copy, own, first_facet;
  };

  const Scene& scene_;
  const FacetScene& facets_;
  const DirectFacets& direct_;
  const LatticeSettings& settings_;
  IrradianceSink& sink_;
  Progress& progress_;
  const bool flat_;
  const std::size_t leaf_facets_;  ///< those from here on are of flat ground
  SteadySettings steady_;
  std::vector<OpenSides> sides_;
  double density_ = 1;
  FacetCells cells_;
  LatticeMedium medium_;
  std::vector<OwnLattice> own_;
  std::vector<std::size_t> own_facets_;
  std::vector<Finer> finer_;
  std::vector<float> scattered_;  ///< [columns][facets][2] [W m^-2]
  SolveReport report_;
};

}  // namespace

const std::vector<std::string>& lattice_mapping_names() {
  static const std::vector<std::string> names{"matched", "paper"};
  return names;
}

std::optional<LatticeMapping> lattice_mapping_from_name(const std::string& name) {
  if (name == "matched") return LatticeMapping::matched;
  if (name == "paper") return LatticeMapping::paper;
  return std::nullopt;
}

std::uint64_t lattice_bytes(const Scene& scene, const FacetScene& facets, const LatticeSettings& settings) {
  return bytes_of(stand_grid(scene, facets, settings.nodes), scene, settings);
}

void check_lattice(const Scene& scene, const FacetScene& facets, const LatticeSettings& settings) {
  check_scene_for_lattice(scene, settings);
  const NodeGrid grid = stand_grid(scene, facets, settings.nodes);
  const std::uint64_t bytes = bytes_of(grid, scene, settings);
  const auto free = free_memory();
  if (bytes > free.bytes || nodes_of(grid, has_flat_ground(scene)) > most_nodes_in_all)
    throw OutOfMemory(fmt::format("a lattice of {} x {} x {} nodes takes {}, {} {} are free; fewer nodes along the longest side than {}",
                                  grid.n[0], grid.n[1], grid.n[2], bytes_text(static_cast<double>(bytes)),
                                  bytes_text(static_cast<double>(free.bytes)), free.limit, settings.nodes));
}

SolveReport solve_lattice(const Scene& scene, const FacetScene& facets, const DirectFacets& direct, const LatticeSettings& settings,
                          IrradianceSink& sink, Progress& progress) {
  std::optional<tbb::global_control> control;
  if (settings.threads > 0) control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(settings.threads));
  return LatticeSolver(scene, facets, direct, settings, sink, progress).run();
}

}  // namespace sunfleck
