#include "scattering.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>

#include "conserve.hpp"
#include "gmres.hpp"
#include "part_sources.hpp"

namespace sunfleck {

namespace {

constexpr int most_iterations = 400;

double largest_albedo(const FacetScene& facets) {
  double largest = 0;
  for (const auto& m : facets.materials)
    for (std::size_t b = 0; b < facets.bands; ++b) largest = std::max({largest, albedo(m, 0, b), albedo(m, 1, b)});
  return largest;
}

/// What enclosed parts withhold of the sun's first reflection, spread over the rest of their elements as exitance; empty if nothing.
Field returned_reflection(const LineLinks& links, const std::array<HalfLight, 2>& along, std::size_t columns) {
  const auto &a = along[0].withheld_reflection, &b = along[1].withheld_reflection;
  if (a.empty() && b.empty()) return {};
  Field exitance(links.sides() * columns, 0.0f);
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const float lines = links.half[0].lines[i / columns] + links.half[1].lines[i / columns];
    if (lines > 0.0f) exitance[i] = ((a.empty() ? 0.0f : a[i]) + (b.empty() ? 0.0f : b[i])) / lines;
  }
  return exitance;
}

/// The exchange of light between parts along the two halves of the lines.
class Exchange {
 public:
  Exchange(const LitElements& lit, const LineLinks& links, const std::array<HalfLight, 2>& along, const ClusterTree* tree,
           const ScatteredLight& light, PartSources sources)
      : columns_(lit.columns()),
        along_(along),
        light_(light),
        sources_(std::move(sources)),
        reflection_(lit.facets, materials(lit, links), lit.states) {
    const std::size_t sides = links.sides();
    const bool sky_known = !lit.direct.sky_seen.empty();
    bool sky_below = false;
    for (const auto& state : lit.scene.states) sky_below = sky_below || (state.sky && state.sky->reaches_below_horizon());
    for (std::size_t h = 0; h < 2; ++h) {
      const auto& half = links.half[h];
      std::vector<float> sky_lines(sides, 0.0f);
      escape_[h].assign(sides, 0.0f);
      for (std::size_t i = 0; i < sides; ++i) {
        const float rest = light.mean_rest[i];
        if (sky_known) sky_lines[i] = half.open_up[i] + (sky_below ? half.open_down[i] : 0.0f);
        const float left = half.lines[i] - sky_lines[i];
        float open = half.open_up[i] + half.open_down[i] - sky_lines[i], sent = rest;
        if (!half.sent_up.empty()) {
          open = (sky_known ? 0.0f : half.sent_up[i]) + (sky_known && sky_below ? 0.0f : half.sent_down[i]);
          sent = std::min(1.0f, light.rest_sent[i]);
        }
        escape_[h][i] = 1.0f - sent + (left > 0.0f ? rest * open / left : 0.0f);
      }
      gather_.emplace_back(half, tree, sky_lines, columns_, cluster_fields_);
    }
    returned_ = returned_reflection(links, along_, columns_);
    radiosity_.resize(sides * columns_);
    weight_.resize(sides);
    for (std::size_t i = 0; i < sides; ++i) weight_[i] = light.area[i / 2];
  }

  /// E_a = E0_a + F_a R E_b and E_b = E0_b + F_b R E_a, for the light of the sky and what has been scattered, where E0 holds the sky and
  /// the sun's first reflection. E_b is eliminated: the eigenvalues of the pair are +-sqrt of those of F_a R F_b R, so that half as many
  /// iterations of the same cost reach the same residual, with fields half as long. `most_albedo` bounds those of F R.
  GmresResult iterate(double tolerance, double most_albedo, Progress& progress) {
    auto& source = sources_.irradiance;
    Field gathered(radiosity_.size());
    for (std::size_t h = 0; h < 2; ++h) {
      if (returned_.empty())
        std::fill(gathered.begin(), gathered.end(), 0.0f);
      else
        gather_[h].gather(returned_.data(), gathered.data());
      gather_[h].add_first_reflection(1.0f, along_[h], gathered.data());
      times_rest(h, gathered);
      add(gathered, source[h]);
    }
    std::vector<double> scale = norms(source[0], weight_, columns_);
    const auto other_norm = norms(source[1], weight_, columns_);
    for (std::size_t c = 0; c < columns_; ++c) scale[c] = std::hypot(scale[c], other_norm[c]);
    half_step(0, source[1], gathered);
    add(gathered, source[0]);
    const auto apply = [&](const Field& x, Field& kx) {
      half_step(1, x, gathered);
      half_step(0, gathered, kx);
    };
    auto result = gmres(apply, source[0], weight_, scale, tolerance, most_iterations, irradiance_[0], progress, most_albedo * most_albedo);
    half_step(1, irradiance_[0], gathered);
    add(gathered, source[1]);
    irradiance_[1] = std::move(source[1]);
    source[0] = {};
    return result;
  }

  /// What the parts gather of the solution, and what of it escapes [columns] [W], but the sun's first reflection.
  void gather_solution(Field& gathered, std::vector<double>& escaped) {
    Field part(radiosity_.size());
    gathered.assign(radiosity_.size(), 0.0f);
    for (std::size_t h = 0; h < 2; ++h) {
      float* b = radiosity_.data();
      reflection_.apply(irradiance_[1 - h].data(), b);
      for (std::size_t i = 0; i < returned_.size(); ++i) b[i] += returned_[i];
      gather_[h].gather(b, part.data());
      for (std::size_t i = 0; i < gathered.size(); ++i) gathered[i] += 0.5f * part[i];
      gather_[h].add_first_reflection(0.5f, along_[h], gathered.data());
      for (std::size_t i = 0; i < weight_.size(); ++i)
        for (std::size_t c = 0; c < columns_; ++c)
          escaped[c] += 0.5 * static_cast<double>(light_.area[i / 2]) * b[i * columns_ + c] * escape_[h][i];
    }
  }

  /// While iterating, with `krylov` fields of GMRES.
  std::size_t bytes(std::size_t krylov) const {
    return ((returned_.empty() ? 5 : 6) + krylov) * bytes_of(radiosity_) + gather_[0].bytes() + gather_[1].bytes() +
           bytes_of(cluster_fields_.sent) + bytes_of(cluster_fields_.received);
  }

 private:
  static std::vector<std::uint32_t> materials(const LitElements& lit, const LineLinks& links) {
    std::vector<std::uint32_t> material(links.whole.size());
    for (std::size_t i = 0; i < material.size(); ++i) material[i] = lit.elements.material[links.whole[i]];
    return material;
  }
  static void add(const Field& more, Field& to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += more[i];
  }
  void times_rest(std::size_t h, Field& field) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, weight_.size(), 4096), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        for (std::size_t c = 0; c < columns_; ++c) field[i * columns_ + c] *= sources_.rest[h][i];
    });
  }
  void half_step(std::size_t h, const Field& from, Field& to) {  // F_h R from
    reflection_.apply(from.data(), radiosity_.data());
    gather_[h].gather(radiosity_.data(), to.data());
    times_rest(h, to);
  }

  std::size_t columns_;
  const std::array<HalfLight, 2>& along_;
  const ScatteredLight& light_;
  PartSources sources_;
  Reflection reflection_;
  std::vector<Gather> gather_;
  ClusterFields cluster_fields_;
  std::vector<float> escape_[2];  ///< [2 * parts] the part of each side's radiosity that goes to the sky and below the horizon
  std::vector<float> weight_;     ///< [2 * parts]
  Field radiosity_, returned_, irradiance_[2];
};

/// The lines, traced or kept from an earlier solve.
std::shared_ptr<StoredTransport> trace(LitElements& lit, const RadiositySettings& settings, const SunReflection& sun,
                                       const std::vector<const Sky*>& skies, bool recorded, Progress& progress) {
  auto made = std::make_shared<StoredTransport>();
  if (settings.method == RadiosityMethod::clustering) made->tree = make_cluster_tree(lit.facets, lit.elements);
  lit.elements.tree = {};
  made->links = line_links(lit.elements, made->tree ? &*made->tree : nullptr, sun, skies, settings, recorded, progress);
  if (!made->links.clustered) made->tree.reset();
  return made;
}

/// The sky's light on cells, and what is enclosed, come with the lines.
void take_along(LitElements& lit, const LineLinks& links, const std::array<HalfLight, 2>& along, ScatteredLight& light) {
  if (along[0].sky.skies() > 0) {
    SkySums sums = along[0].sky;
    sums.add(along[1].sky);
    sky_from_lines(lit.facets, lit.elements, sums, links.area_of_line, lit.direct);
  }
  light.enclosed_part = links.enclosed_part;
  light.whole = links.whole;
  light.enclosed = links.enclosed;
  // what sees the sky is not enclosed: other lines found the two fractions, and together they must not exceed the hemisphere
  for (std::size_t c = 0; c < light.enclosed.size(); ++c)
    light.enclosed[c] = std::min({light.enclosed[c], lit.rest(2 * c), lit.rest(2 * c + 1)});
}

}  // namespace

ScatteredLight solve_scattering(LitElements& lit, const RadiositySettings& settings, const KeptTransport& kept, SolveReport& report,
                                Progress& progress) {
  Stopwatch watch;
  ScatteredLight light;
  const SunReflection sun = sun_reflection(lit);
  const auto skies = light_sources(lit.scene.states).skies;
  auto transport = kept.found;
  std::array<HalfLight, 2> along;
  std::shared_ptr<StoredTransport> made;
  if (!transport) {
    const bool recorded = kept.store && kept.store->entries().has_room(lit.elements.size(), settings.density);
    made = trace(lit, settings, sun, skies, recorded, progress);
    if (recorded) {
      made->elements = lit.elements;
      made->seconds = kept.seconds + watch.seconds();
      kept.store->entries().keep(kept.key, made);
    } else {
      along = std::move(made->links.light);
    }
    transport = made;
  }
  const LineLinks& links = transport->links;
  const auto& tree = transport->tree;
  if (links.recorded()) along = light_along(links, sun, skies);
  take_along(lit, links, along, light);
  PartSources sources = part_sources(lit, links, along, light);
  for (auto& half : along) half.sky = {};
  release_pages(lit.elements);
  add_seconds(report.timings, "lines", watch.seconds());
  report.memory.emplace_back("direct", lit.direct.bytes());
  report.counts.emplace_back("clusters", tree ? tree->size() : 0);
  report.counts.emplace_back("directions", settings.density.directions);
  report.counts.emplace_back("fragments", links.fragments);
  report.counts.emplace_back("links", links.link_count());
  report.memory.emplace_back(
      "links", links.bytes() + bytes_of(along[0].first_reflection) + bytes_of(along[1].first_reflection) + (tree ? tree->bytes() : 0));
  progress.line(fmt::format("{} elements, {} clusters, {} links", lit.elements.size(), tree ? tree->size() : 0, links.link_count()));

  watch = {};
  Exchange exchange(lit, links, along, tree ? &*tree : nullptr, light, std::move(sources));
  if (!links.recorded())
    for (auto& half : made->links.half) half.lines = half.open_up = half.open_down = half.sent_up = half.sent_down = {};
  const double tolerance = settings.tolerance > 0 ? settings.tolerance : settings.density.tolerance;
  const auto result = exchange.iterate(tolerance, largest_albedo(lit.facets), progress);
  for (std::size_t k = 0; k < result.residuals.size(); ++k)
    report.convergence.push_back({0, static_cast<std::uint32_t>(k), result.residuals[k], links.link_count(), watch.seconds()});
  if (!result.converged) report.status = SolveStatus::not_converged;
  const std::size_t columns = lit.columns();
  report.spectral_radius.assign(lit.bands, 0.0);
  for (std::size_t c = 0; c < columns; ++c)
    report.spectral_radius[c % lit.bands] = std::max(report.spectral_radius[c % lit.bands], std::sqrt(result.spectral_radius[c]));

  std::vector<double> escaped(columns, 0.0);
  exchange.gather_solution(light.gathered, escaped);
  for (std::size_t c = 0; c < columns; ++c) report.balance[c / lit.bands][c % lit.bands].escaped += escaped[c];
  const double missed = conserve(lit, first_reflection(along, links.area_of_line, columns), light, report.balance);
  report.memory.emplace_back("fields", exchange.bytes(result.fields));
  add_seconds(report.timings, "iteration", watch.seconds());
  progress.line(fmt::format("{} applications of the operator, residual {:.1e}", result.residuals.size(), result.residuals.back()));
  progress.line(
      fmt::format("{:.1e} of the scattered light had been missed by sampling: scaled, so that all of it is absorbed or escapes", missed));
  return light;
}

}  // namespace sunfleck
