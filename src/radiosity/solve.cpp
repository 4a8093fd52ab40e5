#include <sunfleck/radiosity/solve.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/release_memory.hpp>
#include <sunfleck/radiosity/sensor_gather.hpp>
#include <sunfleck/visibility/endless_light.hpp>

#include "direct_light.hpp"
#include "gmres.hpp"
#include "lamp_cells.hpp"
#include "transport.hpp"

namespace sunfleck {

namespace {

constexpr int most_iterations = 400;
constexpr std::size_t conserved_block = 4096;  ///< cells, or parts, that are summed together
constexpr double most_scaling = 0.05;          ///< of scattered light, to make the balance close

class RadiositySolver {
 public:
  RadiositySolver(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings, IrradianceSink& sink, Progress& progress)
      : scene_(scene),
        facets_(facets),
        settings_(settings),
        sink_(sink),
        progress_(progress),
        states_(scene.states.size()),
        bands_(facets.bands),
        columns_(states_ * bands_),
        lamps_(scene) {}

  SolveReport run() {
    if (facets_.zero_area_facets == facets_.size() && scene_.sensors.empty())
      throw InputError(location(scene_.file), "no facet with an area", "at least one that light can meet");
    report_.method = settings_.method == RadiosityMethod::direct ? "direct"
                     : settings_.method == RadiosityMethod::flat ? "flat"
                                                                 : "clustering";
    const bool scatter = settings_.method != RadiosityMethod::direct && anything_scatters(facets_);
    report_.balance.assign(states_, std::vector<Balance>(bands_));
    Stopwatch watch;
    if (!scene_.lamps.empty() || !scene_.sensors.empty()) trace_rays();
    if (facets_.bounds.empty()) {  // sensors in an empty scene
      write_nothing();
      sensors();
      return std::move(report_);
    }
    watch = {};
    elements_ = make_elements(scene_, facets_, settings_);
    release_pages();
    timed("elements", watch);
    report_.counts.emplace_back("elements", elements_.size());
    report_.counts.emplace_back("cells", elements_.surface.cells());
    report_.memory.emplace_back("elements", elements_.bytes());
    direct_ = direct_light(scene_, facets_, elements_, settings_, report_.timings, progress_);
    report_.counts.emplace_back("direct_fragments", direct_.fragments);
    if (!lamps_.empty() && scatter) check_lamplight_ends(scene_, *rays_);
    if (!lamps_.empty()) lamps();
    if (scatter)
      solve_scattering();
    else {
      report_.memory.emplace_back("direct", direct_.bytes());
      if (settings_.method != RadiosityMethod::direct) report_.convergence.push_back({0, 0, 0.0, 0, 0.0});  // all is black: E = E0
    }
    watch = {};
    write_rows();
    timed("rows", watch);
    if (!scene_.sensors.empty()) sensors();
    return std::move(report_);
  }

 private:
  double largest_albedo() const {
    double albedo = 0;
    for (const auto& m : facets_.materials)
      for (std::size_t b = 0; b < bands_; ++b)
        albedo = std::max(albedo, static_cast<double>(std::max(m.reflectance_front[b], m.reflectance_back[b])) + m.transmittance[b]);
    return albedo;
  }

  /// Pays from some 100 MB on.
  void release_pages() const {
    if (elements_.size() > 100'000) release_freed_memory();
  }

  void timed(const char* phase, const Stopwatch& watch) { add_seconds(report_.timings, phase, watch.seconds()); }

  /// The tree of rays that lamps and sensors need, and nothing else does.
  void trace_rays() {
    const Stopwatch watch;
    rays_.emplace(facets_);
    world_.emplace(facets_, *rays_, [this](std::uint32_t facet, bool front, double u, double v, float* values) {
      radiosity_at(facet, front, u, v, values);
    });
    report_.memory.emplace_back("tree of rays", rays_->bytes());
    timed("tree of rays", watch);
  }

  void lamps() {
    const Stopwatch watch;
    lamp_ = lamp_irradiance(lamps_, facets_, elements_, settings_, *world_, progress_);
    report_.counts.emplace_back("lamp_rays", lamp_.rays);
    report_.memory.emplace_back("lamps", lamp_.bytes());
    timed("lamps", watch);
  }

  void sensors() {
    const Stopwatch watch;
    const SensorSettings settings{sensor_samples(settings_.density), settings_.seed,
                                  settings_.method != RadiosityMethod::direct && !facets_.bounds.empty()};
    report_.counts.emplace_back("sensor_rays", sensor_rays(scene_, facets_.bounds, settings));
    report_.sensors = read_sensors(scene_, place_sensors(scene_, facets_.bounds), lamps_, *world_, settings, progress_);
    timed("sensors", watch);
  }

  /// Radiosity of a side at a point of a facet, all columns.
  void radiosity_at(std::uint32_t facet, bool front, double u, double v, float* values) const {
    const std::size_t t = row_of_facet_[facet];
    const auto& s = elements_.surface;
    const auto& m = facets_.materials[facets_.optics[facet]];
    const std::uint32_t cell = s.first_cell[t] + cell_of(static_cast<float>(u), static_cast<float>(v), s.split[t]);
    for (std::size_t column = 0; column < columns_; ++column) {
      const std::size_t state = column / bands_, band = column % bands_;
      float light[2];
      for (std::size_t side = 0; side < 2; ++side)
        light[side] = sky_irradiance(2 * cell + side, state, band) + sun_irradiance(t, 2 * cell + side, state, band) +
                      lamp_.at(2 * cell + side, state, band, bands_) + scattered_irradiance(cell, side, column);
      const float here = front ? light[0] : light[1], other = front ? light[1] : light[0];
      values[column] = (front ? m.reflectance_front : m.reflectance_back)[band] * here + m.transmittance[band] * other;
    }
  }

  /// Irradiance of the sky, and of the sun, on a side of a cell of row t, for a state and band [W m^-2].
  float sky_irradiance(std::size_t cell_side, std::size_t state, std::size_t band) const {
    const auto k = direct_.sky_of_state[state];
    return k == DirectLight::none ? 0.0f : static_cast<float>(scene_.states[state].sky->irradiance[band]) * direct_.sky[k][cell_side];
  }
  float sun_irradiance(std::size_t t, std::size_t cell_side, std::size_t state, std::size_t band) const {
    const auto k = direct_.sun_of_state[state];
    if (k == DirectLight::none) return 0.0f;
    const float cosine = cell_side & 1 ? -direct_.sun_cosine[k][t] : direct_.sun_cosine[k][t];
    return static_cast<float>(scene_.states[state].sun->irradiance[band]) * std::max(0.0f, cosine) * direct_.sunlit[k][cell_side];
  }

  /// Fraction of a side's hemisphere that is not open sky.
  float rest(std::size_t cell_side) const { return direct_.sky_seen.empty() ? 1.0f : std::max(0.0f, 1.0f - direct_.sky_seen[cell_side]); }

  float enclosed(std::size_t cell) const { return enclosed_.empty() ? 0.0f : enclosed_[cell]; }

  /// Per part: its area, and for each half of the lines the sky's irradiance and the fraction of the hemisphere that is not open sky. Each
  /// half has its own, as the product of two figures from the same lines would be biased; a side that no line of a half meets takes the
  /// area means over its cells, which come from both. No direct light reaches enclosed parts.
  void part_sources(const LineLinks& links) {
    const std::size_t sides = links.sides();
    for (std::size_t h = 0; h < 2; ++h) {
      source_[h].assign(sides * columns_, 0.0f);
      part_rest_[h].assign(sides, 1.0f);
    }
    part_area_.assign(sides / 2, 0.0f);
    mean_rest_.assign(sides, 1.0f);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, elements_.size(), 256), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        double area = 0, hidden = 0;
        for_cells(i, [&](std::size_t c, double a) {
          area += a;
          hidden += a * enclosed(c);
        });
        const double open = area - hidden;
        const std::uint32_t inside = links.enclosed_part.empty() ? LineLinks::none : links.enclosed_part[i];
        if (inside != LineLinks::none) part_area_[inside] = static_cast<float>(hidden);
        part_area_[i] = static_cast<float>(open);
        if (open <= 1e-6 * area || area == 0.0 || direct_.sky_seen.empty()) continue;
        for (std::size_t row = 2 * i, end = row + 2; row < end; ++row) {
          double rest_of = 0;
          for_cells(i, [&](std::size_t c, double a) { rest_of += a * (rest(2 * c + row % 2) - enclosed(c)); });
          mean_rest_[row] = static_cast<float>(rest_of / open);
          for (std::size_t h = 0; h < 2; ++h) {
            const auto& half = links.half[h];
            double lines = 0;
            for (std::uint32_t k = elements_.first_cell[i]; k < elements_.first_cell[i + 1]; ++k) lines += half.sky.all(elements_.cells[k]);
            if (inside != LineLinks::none && lines > 0)
              lines *= half.lines[row] / (half.lines[row] + half.lines[2 * std::size_t{inside} + row % 2]);
            if (lines > 0.5)
              source_of_lines(half.sky, i, row, lines, part_rest_[h][row], source_[h].data() + row * columns_);
            else
              source_of_cells(i, row, open, part_rest_[h][row], source_[h].data() + row * columns_);
          }
        }
      }
    });
  }

  template <class F>
  void for_cells(std::size_t element, const F& f) const {
    const auto& s = elements_.surface;
    for (std::uint32_t k = elements_.first_cell[element]; k < elements_.first_cell[element + 1]; ++k) {
      const auto c = elements_.cells[k];
      const auto t = elements_.row_of_cell[c];
      if (s.split[t] > 0) f(c, static_cast<double>(s.cell_area[t]));
    }
  }

  void source_of_lines(const SkySums& sums, std::size_t element, std::size_t row, double lines, float& rest_of, float* source) const {
    double seen = 0;
    std::vector<double> sky(sums.skies(), 0.0);
    for (std::uint32_t k = elements_.first_cell[element]; k < elements_.first_cell[element + 1]; ++k) {
      const std::size_t cell_side = 2 * std::size_t{elements_.cells[k]} + row % 2;
      seen += sums.seen(cell_side);
      for (std::size_t j = 0; j < sky.size(); ++j) sky[j] += sums.seen(cell_side, 1 + j);
    }
    const double all = std::max(lines, seen);
    rest_of = static_cast<float>(1.0 - seen / all);
    for (std::size_t column = 0; column < columns_; ++column)
      if (const auto k = direct_.sky_of_state[column / bands_]; k != DirectLight::none)
        source[column] = static_cast<float>(scene_.states[column / bands_].sky->irradiance[column % bands_] * sky[k] / all);
  }

  void source_of_cells(std::size_t element, std::size_t row, double open, float& rest_of, float* source) const {
    std::vector<double> sum(columns_, 0.0);
    for_cells(element, [&](std::size_t c, double a) {
      for (std::size_t column = 0; column < columns_; ++column)
        sum[column] += a * sky_irradiance(2 * c + row % 2, column / bands_, column % bands_);
    });
    rest_of = mean_rest_[row];
    for (std::size_t column = 0; column < columns_; ++column) source[column] = static_cast<float>(sum[column] / open);
  }

  /// Light of sun and lamps after reflection and transmission on each cell.
  SunReflection sun_reflection() const {
    SunReflection out;
    if (direct_.sunlit.empty() && lamp_.empty()) return out;
    const auto& s = elements_.surface;
    out.columns = columns_;
    out.exitance.assign(2 * s.cells() * columns_, 0.0f);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, s.cells(), 1024), [&](const auto& range) {
      for (std::size_t c = range.begin(); c < range.end(); ++c) {
        const auto t = elements_.row_of_cell[c];
        const auto& m = facets_.materials[facets_.optics[elements_.order[t]]];
        for (std::size_t column = 0; column < columns_; ++column) {
          const std::size_t state = column / bands_, band = column % bands_;
          const float front = sun_irradiance(t, 2 * c, state, band) + lamp_.at(2 * c, state, band, bands_),
                      back = sun_irradiance(t, 2 * c + 1, state, band) + lamp_.at(2 * c + 1, state, band, bands_);
          out.exitance[2 * c * columns_ + column] = m.reflectance_front[band] * front + m.transmittance[band] * back;
          out.exitance[(2 * c + 1) * columns_ + column] = m.reflectance_back[band] * back + m.transmittance[band] * front;
        }
      }
    });
    return out;
  }

  /// What enclosed parts withhold of the sun's first reflection, spread over the rest of their elements as exitance; empty if nothing.
  Field returned_reflection(const LineLinks& links) const {
    const auto &a = links.half[0].withheld_reflection, &b = links.half[1].withheld_reflection;
    if (a.empty() && b.empty()) return {};
    Field exitance(links.sides() * columns_, 0.0f);
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
      const float lines = links.half[0].lines[i / columns_] + links.half[1].lines[i / columns_];
      if (lines > 0.0f) exitance[i] = ((a.empty() ? 0.0f : a[i]) + (b.empty() ? 0.0f : b[i])) / lines;
    }
    return exitance;
  }

  void solve_scattering() {
    Stopwatch watch;
    std::optional<ClusterTree> tree;
    if (settings_.method == RadiosityMethod::clustering) tree = make_cluster_tree(facets_, elements_);
    elements_.tree = {};
    LineLinks links =
        line_links(elements_, tree ? &*tree : nullptr, sun_reflection(), light_sources(scene_.states).skies, settings_, progress_);
    if (!links.clustered) tree.reset();
    if (links.half[0].sky.skies() > 0) {
      SkySums sums = links.half[0].sky;
      sums.add(links.half[1].sky);
      sky_from_lines(facets_, elements_, sums, links.area_of_line, direct_);
    }
    enclosed_part_ = links.enclosed_part;
    whole_ = links.whole;
    enclosed_ = links.enclosed;
    // what sees the sky is not enclosed: other lines found the two fractions, and together they must not exceed the hemisphere
    for (std::size_t c = 0; c < enclosed_.size(); ++c) enclosed_[c] = std::min({enclosed_[c], rest(2 * c), rest(2 * c + 1)});
    part_sources(links);
    for (auto& half : links.half) half.sky = {};
    release_pages();
    timed("lines", watch);
    report_.memory.emplace_back("direct", direct_.bytes());
    const std::size_t sides = links.sides();
    report_.counts.emplace_back("clusters", tree ? tree->size() : 0);
    report_.counts.emplace_back("directions", settings_.density.directions);
    report_.counts.emplace_back("fragments", links.fragments);
    report_.counts.emplace_back("links", links.link_count());
    report_.memory.emplace_back("links", links.bytes() + (tree ? tree->bytes() : 0));
    progress_.line(fmt::format("{} elements, {} clusters, {} links", elements_.size(), tree ? tree->size() : 0, links.link_count()));

    watch = {};
    const bool sky_known = !direct_.sky_seen.empty();
    bool sky_below = false;
    for (const auto& state : scene_.states) sky_below = sky_below || (state.sky && state.sky->reaches_below_horizon());
    std::vector<Gather> gather;
    ClusterFields cluster_fields;
    std::vector<float> escape[2];  // the part of each side's radiosity that goes to the sky and below the horizon
    for (std::size_t h = 0; h < 2; ++h) {
      const auto& half = links.half[h];
      std::vector<float> sky_lines(sides, 0.0f);
      escape[h].assign(sides, 0.0f);
      for (std::size_t i = 0; i < sides; ++i) {
        if (sky_known) sky_lines[i] = half.open_up[i] + (sky_below ? half.open_down[i] : 0.0f);
        const float left = half.lines[i] - sky_lines[i], open = half.open_up[i] + half.open_down[i] - sky_lines[i];
        escape[h][i] = 1.0f - mean_rest_[i] + (left > 0.0f ? mean_rest_[i] * open / left : 0.0f);
      }
      gather.emplace_back(half, tree ? &*tree : nullptr, sky_lines, columns_, cluster_fields);
    }
    const Field returned = returned_reflection(links);
    for (auto& half : links.half) half.lines = half.open_up = half.open_down = {};
    std::vector<std::uint32_t> material(links.whole.size());
    for (std::size_t i = 0; i < material.size(); ++i) material[i] = elements_.material[links.whole[i]];
    const Reflection reflection(facets_, std::move(material), states_);

    // E_a = E0_a + F_a R E_b and E_b = E0_b + F_b R E_a, for the light of the sky and what has been scattered, where E0 holds the sky and
    // the sun's first reflection. E_b is eliminated: the eigenvalues of the pair are +-sqrt of those of F_a R F_b R, so that half as many
    // iterations of the same cost reach the same residual, with fields half as long.
    const std::size_t values = sides * columns_;
    Field radiosity(values);
    std::vector<float> weight(sides);
    for (std::size_t i = 0; i < sides; ++i) weight[i] = part_area_[i / 2];
    const auto times_rest = [&](std::size_t h, Field& field) {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides, 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          for (std::size_t c = 0; c < columns_; ++c) field[i * columns_ + c] *= part_rest_[h][i];
      });
    };
    Field gathered(values);
    for (std::size_t h = 0; h < 2; ++h) {
      if (returned.empty())
        std::fill(gathered.begin(), gathered.end(), 0.0f);
      else
        gather[h].gather(returned.data(), gathered.data());
      gather[h].add_first_reflection(1.0f, gathered.data());
      times_rest(h, gathered);
      for (std::size_t i = 0; i < values; ++i) source_[h][i] += gathered[i];
    }
    const auto half_step = [&](std::size_t h, const Field& from, Field& to) {  // F_h R from
      reflection.apply(from.data(), radiosity.data());
      gather[h].gather(radiosity.data(), to.data());
      times_rest(h, to);
    };
    std::vector<double> scale = norms(source_[0], weight, columns_);
    const auto other_norm = norms(source_[1], weight, columns_);
    for (std::size_t c = 0; c < columns_; ++c) scale[c] = std::hypot(scale[c], other_norm[c]);
    half_step(0, source_[1], gathered);
    for (std::size_t i = 0; i < values; ++i) source_[0][i] += gathered[i];
    Field irradiance[2];
    const auto apply = [&](const Field& x, Field& kx) {
      half_step(1, x, gathered);
      half_step(0, gathered, kx);
    };
    const double tolerance = settings_.tolerance > 0 ? settings_.tolerance : settings_.density.tolerance;
    const auto result =
        gmres(apply, source_[0], weight, scale, tolerance, most_iterations, irradiance[0], progress_, largest_albedo() * largest_albedo());
    half_step(1, irradiance[0], gathered);
    for (std::size_t i = 0; i < values; ++i) source_[1][i] += gathered[i];
    irradiance[1] = std::move(source_[1]);
    source_[0] = {};
    for (std::size_t k = 0; k < result.residuals.size(); ++k)
      report_.convergence.push_back({0, static_cast<std::uint32_t>(k), result.residuals[k], links.link_count(), watch.seconds()});
    if (!result.converged) report_.status = SolveStatus::not_converged;
    report_.spectral_radius.assign(bands_, 0.0);
    for (std::size_t c = 0; c < columns_; ++c)
      report_.spectral_radius[c % bands_] = std::max(report_.spectral_radius[c % bands_], std::sqrt(result.spectral_radius[c]));

    gathered_.assign(values, 0.0f);
    for (std::size_t h = 0; h < 2; ++h) {
      float* b = radiosity.data();
      reflection.apply(irradiance[1 - h].data(), b);
      for (std::size_t i = 0; i < returned.size(); ++i) b[i] += returned[i];
      gather[h].gather(b, gathered.data());
      for (std::size_t i = 0; i < values; ++i) gathered_[i] += 0.5f * gathered[i];
      gather[h].add_first_reflection(0.5f, gathered_.data());
      for (std::size_t i = 0; i < sides; ++i)
        for (std::size_t c = 0; c < columns_; ++c)
          report_.balance[c / bands_][c % bands_].escaped +=
              0.5 * static_cast<double>(part_area_[i / 2]) * b[i * columns_ + c] * escape[h][i];
    }
    conserve(first_reflection(links));
    report_.memory.emplace_back("fields", ((returned.empty() ? 5 : 6) + result.fields) * bytes_of(irradiance[0]) + gather[0].bytes() +
                                              gather[1].bytes() + bytes_of(cluster_fields.sent) + bytes_of(cluster_fields.received));
    timed("iteration", watch);
    progress_.line(fmt::format("{} applications of the operator, residual {:.1e}", result.residuals.size(), result.residuals.back()));
  }

  /// The first reflection of sun and lamps as lines counted it [columns] [W]: all of it, and what left the scene.
  struct FirstReflection {
    std::vector<double> all, escaped;
  };

  FirstReflection first_reflection(const LineLinks& links) const {
    FirstReflection first{std::vector<double>(columns_, 0.0), std::vector<double>(columns_, 0.0)};
    for (const auto& half : links.half) {
      for (std::size_t c = 0; c < half.escaped_reflection.size(); ++c) {
        first.escaped[c] += half.escaped_reflection[c] * links.area_of_line;
        first.all[c] += half.escaped_reflection[c] * links.area_of_line;
      }
      for (const auto* met : {&half.first_reflection, &half.withheld_reflection})
        for (std::size_t i = 0; i < met->size(); ++i) first.all[i % columns_] += static_cast<double>((*met)[i]) * links.area_of_line;
    }
    return first;
  }

  /// Scattered light of a state and band must be absorbed or escape, all of it. Lines sample the area of what scatters, and cells share it
  /// out by their true areas, so sums differ by the sampling: both the light gathered and that which escapes are multiplied by one factor.
  /// Of the first reflection, lines tell the share that escapes; how much there is, cells tell.
  void conserve(const FirstReflection& first) {
    std::vector<double> direct(columns_, 0.0), followed(columns_, 0.0), absorbed(columns_, 0.0);
    const auto albedo = [&](const Optics& m, std::size_t side, std::size_t band) {
      return static_cast<double>(side == 0 ? m.reflectance_front[band] : m.reflectance_back[band]) + m.transmittance[band];
    };
    const auto blocks = [](std::size_t n) { return (n + conserved_block - 1) / conserved_block; };
    const auto sum_blocks = [&](std::size_t n, std::vector<double>& total, const auto& add) {
      std::vector<double> partial(blocks(n) * columns_, 0.0);
      tbb::parallel_for(std::size_t{0}, blocks(n), [&](std::size_t b) {
        for (std::size_t i = b * conserved_block, end = std::min(n, i + conserved_block); i < end; ++i)
          add(i, partial.data() + b * columns_);
      });
      for (std::size_t k = 0; k < partial.size(); ++k) total[k % columns_] += partial[k];
    };
    const auto& s = elements_.surface;
    const auto sum_direct = [&](std::vector<double>& total, const auto& light) {
      sum_blocks(s.cells(), total, [&](std::size_t c, double* sum) {
        const auto t = elements_.row_of_cell[c];
        if (s.split[t] == 0) return;
        const auto& m = facets_.materials[facets_.optics[elements_.order[t]]];
        for (std::size_t side = 0; side < 2; ++side)
          for (std::size_t column = 0; column < columns_; ++column)
            sum[column] += static_cast<double>(s.cell_area[t]) * light(t, 2 * c + side, column / bands_, column % bands_) *
                           albedo(m, side, column % bands_);
      });
    };
    if (!direct_.sunlit.empty() || !lamp_.empty())
      sum_direct(followed, [&](std::size_t t, std::size_t i, std::size_t state, std::size_t band) {
        return static_cast<double>(sun_irradiance(t, i, state, band)) + lamp_.at(i, state, band, bands_);
      });
    direct = followed;
    if (!direct_.sky.empty())
      sum_direct(direct, [&](std::size_t, std::size_t i, std::size_t state, std::size_t band) {
        return static_cast<double>(sky_irradiance(i, state, band));
      });
    const std::size_t parts = gathered_.size() / (2 * columns_);
    sum_blocks(parts, absorbed, [&](std::size_t i, double* sum) {
      const bool inside = i >= elements_.size();
      const auto& m = facets_.materials[elements_.material[inside ? whole_[i] : i]];
      for (std::size_t row = 2 * i, end = row + 2; row < end; ++row) {
        const double area = static_cast<double>(part_area_[i]) * (inside ? 1.0 : mean_rest_[row]);
        for (std::size_t column = 0; column < columns_; ++column)
          sum[column] += area * gathered_[row * columns_ + column] * (1.0 - albedo(m, row % 2, column % bands_));
      }
    });
    std::vector<float> factor(columns_);
    double most = 0;
    for (std::size_t column = 0; column < columns_; ++column) {
      double scale = 1.0;
      auto& escaped = report_.balance[column / bands_][column % bands_].escaped;
      if (first.all[column] > 0.0) escaped += first.escaped[column] * followed[column] / first.all[column];
      const double found = absorbed[column] + escaped;
      if (found > 0.0 && direct[column] > 0.0) scale = direct[column] / found;
      if (std::fabs(scale - 1.0) > most_scaling) scale = 1.0;  // not the sampling: let the balance show it
      most = std::max(most, std::fabs(scale - 1.0));
      escaped *= scale;
      factor[column] = static_cast<float>(scale);
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, 2 * parts, 4096), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        for (std::size_t c = 0; c < columns_; ++c) gathered_[i * columns_ + c] *= factor[c];
    });
    progress_.line(
        fmt::format("{:.1e} of the scattered light had been missed by sampling: scaled, so that all of it is absorbed or escapes", most));
  }

  /// E = direct + (fraction that is not open sky) x gathered, averaged over the facet's cells.
  void write_rows() {
    const auto& s = elements_.surface;
    const std::size_t n = facets_.size();
    row_of_facet_.resize(n);
    for (std::size_t t = 0; t < n; ++t) row_of_facet_[elements_.order[t]] = static_cast<std::uint32_t>(t);
    const bool any_sun = !direct_.sunlit.empty();
    constexpr std::size_t chunk = 16384;
    std::vector<float> irradiance, sunlit;
    const std::size_t blocks_in_chunk = 16, block = chunk / blocks_in_chunk;
    std::vector<std::vector<Balance>> partial(blocks_in_chunk, std::vector<Balance>(columns_));
    for (std::size_t first = 0; first < n; first += chunk) {
      progress_.check();
      const std::size_t count = std::min(chunk, n - first);
      irradiance.assign(states_ * count * 2 * bands_, 0.0f);
      if (any_sun) sunlit.assign(states_ * count * 2, 0.0f);
      tbb::parallel_for(std::size_t{0}, blocks_in_chunk, [&](std::size_t b) {
        std::fill(partial[b].begin(), partial[b].end(), Balance{});
        FacetLight light;
        for (std::size_t i = b * block, end = std::min(count, (b + 1) * block); i < end; ++i) {
          const std::size_t t = row_of_facet_[first + i];
          if (s.split[t] == 0) continue;
          facet_row(t, first + i, i, count, light, irradiance, sunlit, partial[b]);
        }
      });
      for (const auto& p : partial)
        for (std::size_t c = 0; c < columns_; ++c) {
          auto& balance = report_.balance[c / bands_][c % bands_];
          balance.incident += p[c].incident;
          balance.leaves += p[c].leaves;
          balance.ground += p[c].ground;
        }
      sink_.rows({first, count, irradiance.data(), any_sun ? sunlit.data() : nullptr, nullptr});
    }
    if (settings_.method == RadiosityMethod::direct)  // what is not absorbed is not followed: it counts as scattered out of the scene
      for (auto& state : report_.balance)
        for (auto& b : state) b.escaped = b.incident - b.leaves - b.ground;
  }

  /// Rows of facets without area.
  void write_nothing() {
    const std::vector<float> zeros(states_ * facets_.size() * 2 * bands_, 0.0f);
    if (facets_.size() > 0) sink_.rows({0, facets_.size(), zeros.data(), nullptr, nullptr});
  }

  float scattered_irradiance(std::uint32_t cell, std::size_t side, std::size_t column) const {
    if (gathered_.empty()) return 0.0f;
    const auto element = elements_.element_of_cell[cell];
    const float open = rest(2 * cell + side), inside = enclosed(cell), seen = gathered_[(2 * element + side) * columns_ + column];
    if (inside == 0.0f) return open * seen;
    const float seen_inside = gathered_[(2 * enclosed_part_[element] + side) * columns_ + column];
    return (open - inside) * seen + inside * seen_inside;
  }

  /// Light on the two sides of a facet, means over its cells.
  struct FacetLight {
    std::vector<float> scattered;  ///< [2][columns] irradiance [W m^-2]
    std::vector<float> sky, lit;   ///< [2][skies], [2][suns] as in DirectLight
    std::vector<float> lamp;       ///< [2][sets of lamps][b] irradiance [W m^-2]
  };

  void light_of_facet(std::size_t t, FacetLight& light) const {
    const auto& s = elements_.surface;
    const std::uint32_t begin = s.first_cell[t], end = s.first_cell[t + 1];
    const float share = 1.0f / static_cast<float>(end - begin);
    const std::size_t skies = direct_.sky.size(), suns = direct_.sunlit.size();
    light.scattered.assign(gathered_.empty() ? 0 : 2 * columns_, 0.0f);
    light.sky.assign(2 * skies, 0.0f);
    light.lit.assign(2 * suns, 0.0f);
    const std::size_t lamp_values = lamp_.sets.size() * bands_;
    light.lamp.assign(2 * lamp_values, 0.0f);
    const auto add = [&](std::size_t part, std::size_t side, float part_share) {
      const float* from = gathered_.data() + (2 * part + side) * columns_;
      float* to = light.scattered.data() + side * columns_;
      for (std::size_t column = 0; column < columns_; ++column) to[column] += part_share * from[column];
    };
    for (std::uint32_t c = begin; c < end; ++c)
      for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t cell_side = 2 * std::size_t{c} + side;
        for (std::size_t k = 0; k < skies; ++k) light.sky[side * skies + k] += share * direct_.sky[k][cell_side];
        for (std::size_t k = 0; k < suns; ++k) light.lit[side * suns + k] += share * direct_.sunlit[k][cell_side];
        for (std::size_t k = 0; k < lamp_values; ++k)
          light.lamp[side * lamp_values + k] += share * lamp_.sets[k / bands_][cell_side * bands_ + k % bands_];
        if (gathered_.empty()) continue;
        const auto element = elements_.element_of_cell[c];
        const float inside = enclosed(c);
        add(element, side, share * (rest(cell_side) - inside));
        if (inside > 0.0f) add(enclosed_part_[element], side, share * inside);
      }
  }

  void facet_row(std::size_t t, std::size_t facet, std::size_t i, std::size_t count, FacetLight& light, std::vector<float>& irradiance,
                 std::vector<float>& sunlit, std::vector<Balance>& balance) {
    const auto& optics = facets_.materials[facets_.optics[facet]];
    const double area = facets_.area[facet];
    const bool is_plant = facet < facets_.plant_facets;
    const std::size_t skies = direct_.sky.size(), suns = direct_.sunlit.size();
    light_of_facet(t, light);
    for (std::size_t state = 0; state < states_; ++state) {
      const auto& sky = scene_.states[state].sky;
      const auto& sun = scene_.states[state].sun;
      const auto sky_row = direct_.sky_of_state[state], sun_row = direct_.sun_of_state[state];
      const auto lamp_row = lamp_.empty() ? Lamps::none : lamp_.set_of_state[state];
      for (std::size_t side = 0; side < 2; ++side) {
        const float seen = sky_row == DirectLight::none ? 0.0f : light.sky[side * skies + sky_row];
        float lit = 0.0f;
        if (sun_row != DirectLight::none) {
          const float cosine = direct_.sun_cosine[sun_row][t];
          sunlit[(state * count + i) * 2 + side] = light.lit[side * suns + sun_row];
          lit = light.lit[side * suns + sun_row] * std::max(0.0f, side == 0 ? cosine : -cosine);
        }
        for (std::size_t band = 0; band < bands_; ++band) {
          float direct = 0.0f;
          if (sky_row != DirectLight::none) direct += static_cast<float>(sky->irradiance[band]) * seen;
          if (sun_row != DirectLight::none) direct += static_cast<float>(sun->irradiance[band]) * lit;
          if (lamp_row != Lamps::none) direct += light.lamp[(side * lamp_.sets.size() + lamp_row) * bands_ + band];
          const std::size_t column = state * bands_ + band;
          const float e = gathered_.empty() ? direct : direct + light.scattered[side * columns_ + column];
          irradiance[((state * count + i) * 2 + side) * bands_ + band] = e;
          auto& sums = balance[column];
          sums.incident += area * direct;
          const double kept =
              (1.0 - (side == 0 ? optics.reflectance_front[band] : optics.reflectance_back[band])) - optics.transmittance[band];
          (is_plant ? sums.leaves : sums.ground) += area * kept * e;
        }
      }
    }
  }

  const Scene& scene_;
  const FacetScene& facets_;
  const RadiositySettings& settings_;
  IrradianceSink& sink_;
  Progress& progress_;
  const std::size_t states_, bands_, columns_;
  Elements elements_;
  DirectLight direct_;
  const LampLight lamps_;
  std::optional<RayScene> rays_;
  std::optional<FacetSurroundings> world_;
  LampIrradiance lamp_;
  std::vector<std::uint32_t> row_of_facet_;
  Field source_[2], gathered_;                               ///< source_: of each half
  std::vector<float> part_rest_[2], mean_rest_, part_area_;  ///< mean_rest_: area mean over the part's cells, from both halves
  std::vector<std::uint32_t> enclosed_part_, whole_;
  std::vector<float> enclosed_;
  SolveReport report_;
};

}  // namespace

SolveReport solve_radiosity(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings, IrradianceSink& sink,
                            Progress& progress) {
  std::optional<tbb::global_control> control;
  if (settings.threads > 0) control.emplace(tbb::global_control::max_allowed_parallelism, settings.threads);
  return RadiositySolver(scene, facets, settings, sink, progress).run();
}

}  // namespace sunfleck
