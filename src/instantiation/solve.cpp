#include <sunfleck/instantiation/solve.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/scene/facets.hpp>

#include "instantiation/ground_light.hpp"
#include "instantiation/local_solve.hpp"
#include "instantiation/members.hpp"
#include "instantiation/surroundings.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t basis_bytes = std::size_t{256} << 20;  // of steps of the outer iteration
constexpr std::uint32_t most_passes = 100, most_sweeps = 200;
constexpr std::size_t window_bytes = std::size_t{96} << 20;  // rows of finished copies that wait for their turn
constexpr std::uint64_t fine_stream = 0x1b9e4d6a7c2f5083ULL, sun_stream = 0x5a6c3e1f9b7d2048ULL, ground_stream = 0x2e8b7a4d1c6f3095ULL;

/// Some columns of some members of one original, side by side.
struct Batch {
  std::uint32_t original = 0;
  std::vector<std::uint32_t> members;
  std::size_t first_column = 0, columns = 0;  ///< of each member
  int width = 16;
};

/// Fields of all members, [member][field][column], and the radiosity of the ground, [side][column].
struct Light {
  std::vector<float> fields, ground;
};

class InstantiationSolver {
 public:
  InstantiationSolver(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings, IrradianceSink& sink,
                      Progress& progress)
      : scene_(scene),
        placed_(placed),
        settings_(settings),
        sink_(sink),
        progress_(progress),
        states_(scene.states.size()),
        bands_(scene.band_count()),
        columns_(states_ * bands_),
        lights_(light_sources(scene.states)),
        density_(adapted(settings.density, placed.facets)) {}

  SolveReport run() {
    report_.method = "instantiation";
    report_.balance.assign(states_, std::vector<Balance>(bands_));
    Stopwatch watch;
    members_ = make_members(scene_, placed_, density_.coarse, density_.elements_per_organ, settings_.seed, progress_);
    report_originals();
    timed("originals", watch);
    watch = {};
    sun();
    timed("sun", watch);
    watch = {};
    look_around();
    timed("rays", watch);
    watch = {};
    iterate();
    timed("iteration", watch);
    watch = {};
    open_all();
    timed("opening", watch);
    return std::move(report_);
  }

 private:
  void timed(const char* phase, const Stopwatch& watch) { add_seconds(report_.timings, phase, watch.seconds()); }

  // ---- originals

  void report_originals() {
    std::uint64_t elements = 0, links = 0, bytes = 0;
    for (const auto& o : members_.originals) {
      elements += o.elements.size();
      links += o.coarse->inside.count.size();
      bytes += o.coarse->bytes() + o.elements.bytes();
      fragments_ += o.coarse->fragments;
    }
    report_.counts.emplace_back("originals", members_.originals.size());
    report_.counts.emplace_back("copies", members_.size());
    if (members_.merged > 0) report_.counts.emplace_back("merged_copies", members_.merged);
    report_.counts.emplace_back("elements", elements);
    report_.counts.emplace_back("links", links);
    report_.memory.emplace_back("originals", bytes);
    links_ = links;
    progress_.line(fmt::format("{} originals for {} copies, {} elements, {} links", members_.originals.size(),
                               members_.found.members.size(), elements, links));
  }

  // ---- direct light and what sees what

  void sun() {
    const auto& density = density_;
    double pitch = 0;
    for (std::size_t m = 0; m < members_.maps.size(); ++m) {
      const double organ = members_.original_of(m).elements.organ_area * members_.maps[m].scale * members_.maps[m].scale;
      const double own = std::sqrt(0.5 * organ / (density.sun_lines_per_organ / density.sun_samples));
      pitch = pitch == 0 ? own : std::min(pitch, own);
    }
    std::uint64_t fragments = 0;
    for (const auto* sun : lights_.suns) {
      lit_.push_back(lit_cells(members_.copies, sun_directions(*sun, density.sun_samples, mix(settings_.seed, sun_stream)), pitch,
                               mix(settings_.seed, sun_stream, 1), progress_));
      fragments += lit_.back().fragments;
      report_.memory.emplace_back("sun", bytes_of(lit_.back().lit));
    }
    report_.counts.emplace_back("sun_fragments", fragments);
  }

  void look_around() {
    around_ = std::make_unique<Surroundings>(members_.copies, members_.maps, members_.originals);
    const std::size_t members = members_.maps.size();
    field_start_.assign(members + 1, 0);
    end_start_.assign(members + 1, 0);
    for (std::size_t m = 0; m < members; ++m) {
      const auto& op = members_.coarse_of(m);
      field_start_[m + 1] = field_start_[m] + op.fields();
      end_start_[m + 1] = end_start_[m] + op.points.size();
    }
    ends_.resize(end_start_.back());
    tbb::parallel_for(std::size_t{0}, members, [&](std::size_t m) {
      if (progress_.cancelled()) return;
      look_from(static_cast<std::uint32_t>(m), members_.coarse_of(m), ends_.data() + end_start_[m]);
    });
    progress_.check();
    ground_ = view_from_ground(scene_, members_.copies.ground, *around_, lights_,
                               std::max(8u, density_.ground_rays / (members_.ground_split * members_.ground_split)), density_.sun_samples,
                               mix(settings_.seed, ground_stream), progress_);
    report_.counts.emplace_back("rays", ends_.size() + ground_.ends.size());
    report_.memory.emplace_back("rays", around_->bytes() + bytes_of(ends_) + ground_.bytes());
  }

  void look_from(std::uint32_t m, const LineOperator& op, RayEnd* ends) const {
    const std::size_t pixels = std::size_t{op.pixels()} * op.pixels();
    for (std::size_t f = 0; f < op.fields(); ++f) {
      const Vec3 d = members_.maps[m].direction(op.direction(f / pixels));
      for (auto k = op.point_start[f]; k < op.point_start[f + 1]; ++k) ends[k] = around_->look(m, op.points[k], d);
    }
  }

  // ---- batches of lanes

  /// Batches over the members given, members of one original together, in a fixed order.
  std::vector<Batch> batches_of(const std::vector<std::uint32_t>& members) const {
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_original;
    for (const auto m : members) by_original[members_.found.members[m].original].push_back(m);
    std::vector<Batch> out;
    for (const auto& [original, list] : by_original) {
      const std::size_t lanes = list.size() * columns_;
      int width = 2;  // two batches at least where there is work for them
      while (width < 16 && static_cast<std::size_t>(2 * width) < lanes) width *= 2;
      while (width < 16 && static_cast<std::size_t>(width) < std::min<std::size_t>(columns_, 16)) width *= 2;
      const std::size_t columns = std::min<std::size_t>(columns_, width), each = width / columns;
      for (std::size_t first = 0; first < list.size(); first += each)
        for (std::size_t c = 0; c < columns_; c += columns) {
          Batch b;
          b.original = original;
          b.members.assign(list.begin() + static_cast<std::ptrdiff_t>(first),
                           list.begin() + static_cast<std::ptrdiff_t>(std::min(list.size(), first + each)));
          b.first_column = c;
          b.columns = std::min(columns, columns_ - c);
          b.width = width;
          out.push_back(std::move(b));
        }
    }
    return out;
  }

  template <class Call>
  static void with_width(int width, Call&& call) {
    switch (width) {
      case 2:
        return call(std::integral_constant<int, 2>{});
      case 4:
        return call(std::integral_constant<int, 4>{});
      case 8:
        return call(std::integral_constant<int, 8>{});
      default:
        return call(std::integral_constant<int, 16>{});
    }
  }

  template <int width>
  std::vector<LaneOptics<width>> optics_of(const Batch& b) const {
    std::vector<LaneOptics<width>> out(scene_.optics.size(), LaneOptics<width>{});
    for (std::size_t m = 0; m < scene_.optics.size(); ++m) {
      for (std::size_t lane = 0; lane < b.members.size() * b.columns; ++lane) {
        const std::size_t band = (b.first_column + lane % b.columns) % bands_;
        out[m].front[lane] = scene_.optics[m].reflectance_front[band];
        out[m].back[lane] = scene_.optics[m].reflectance_back[band];
        out[m].transmittance[lane] = scene_.optics[m].transmittance[band];
      }
    }
    return out;
  }

  /// Radiance times pi of the sky towards d, for a column.
  float sky_radiance(const Vec3& d, std::size_t column) const {
    const auto k = lights_.sky_of_state[column / bands_];
    if (k == LightSources::none) return 0.0f;
    return static_cast<float>(std::numbers::pi * lights_.skies[k]->relative_radiance(d) *
                              scene_.states[column / bands_].sky->irradiance[column % bands_]);
  }

  /// What comes in through each field: means over the rays of each pixel. `light`: what members and the ground send (null = nothing);
  /// `sky`: the sky's part is added.
  template <int width>
  void incoming(const Batch& b, const LineOperator& op, const std::vector<const RayEnd*>& ends, const Light* light, bool sky,
                LaneField<width>& field) const {
    field.assign(op.fields(), Lanes<width>{});
    const std::size_t pixels = std::size_t{op.pixels()} * op.pixels();
    std::vector<float> radiance(b.columns, 0.0f);
    for (std::size_t j = 0; j < b.members.size(); ++j) {
      const auto& map = members_.maps[b.members[j]];
      const std::size_t lane = j * b.columns;
      for (std::size_t f = 0; f < op.fields(); ++f) {
        if (sky && f % pixels == 0) {
          const Vec3 d = map.direction(op.direction(f / pixels));
          for (std::size_t c = 0; c < b.columns; ++c) radiance[c] = sky_radiance(d, b.first_column + c);
        }
        const auto first = op.point_start[f], last = op.point_start[f + 1];
        if (first == last) continue;
        float sum[16] = {};
        for (auto k = first; k < last; ++k) {
          const RayEnd& end = ends[j][k];
          const float* from = nullptr;
          if (end.is_sky()) {
            if (sky) from = radiance.data();
          } else if (light) {
            from = end.is_ground() ? light->ground.data() + (2 * std::size_t{end.facet()} + end.field) * columns_ + b.first_column
                                   : light->fields.data() + (field_start_[end.target] + end.field) * columns_ + b.first_column;
          }
          if (from)
            for (std::size_t c = 0; c < b.columns; ++c) sum[c] += from[c];
        }
        for (std::size_t c = 0; c < b.columns; ++c) field[f][lane + c] = sum[c] / static_cast<float>(last - first);
      }
    }
  }

  std::vector<const RayEnd*> stored_ends(const Batch& b) const {
    std::vector<const RayEnd*> out;
    for (const auto m : b.members) out.push_back(ends_.data() + end_start_[m]);
    return out;
  }

  /// Per element side: cosine towards the sun times the lit fraction, area mean over its cells.
  void sun_on_elements(std::uint32_t m, std::size_t sun, std::vector<float>& out) const {
    const auto& e = members_.original_of(m).elements;
    const auto& s = e.surface;
    const Vec3 d = members_.maps[m].direction_back(lights_.suns[sun]->direction);
    const std::uint8_t* lit = lit_[sun].lit.data() + lit_[sun].first[m];
    out.assign(2 * e.size(), 0.0f);
    for (std::size_t t = 0; t < s.size(); ++t) {
      if (s.split[t] == 0) continue;
      const auto cosine = static_cast<float>(s.normal[0][t] * d.x + s.normal[1][t] * d.y + s.normal[2][t] * d.z);
      const float weight = std::fabs(cosine) * s.cell_area[t] / 255.0f;
      for (auto c = s.first_cell[t]; c < s.first_cell[t + 1]; ++c)
        out[2 * e.element_of_cell[c] + (cosine > 0 ? 0 : 1)] += weight * static_cast<float>(lit[c]);
    }
    for (std::size_t i = 0; i < out.size(); ++i)
      if (e.area[i / 2] > 0) out[i] /= e.area[i / 2];
  }

  template <int width>
  void add_sun(const Batch& b, LaneField<width>& source) const {
    if (lights_.suns.empty()) return;
    std::vector<float> lit;
    for (std::size_t j = 0; j < b.members.size(); ++j)
      for (std::size_t sun = 0; sun < lights_.suns.size(); ++sun) {
        bool made = false;
        for (std::size_t c = 0; c < b.columns; ++c) {
          const std::size_t column = b.first_column + c, state = column / bands_;
          if (lights_.sun_of_state[state] != sun) continue;
          if (!made) sun_on_elements(b.members[j], sun, lit);
          made = true;
          const auto irradiance = static_cast<float>(scene_.states[state].sun->irradiance[column % bands_]);
          for (std::size_t i = 0; i < lit.size(); ++i) source[i][j * b.columns + c] += irradiance * lit[i];
        }
      }
  }

  // ---- outer iteration

  std::vector<std::uint32_t> all_members() const {
    std::vector<std::uint32_t> out(members_.maps.size());
    for (std::uint32_t m = 0; m < out.size(); ++m) out[m] = m;
    return out;
  }

  /// Irradiance of the ground: direct light and what members and other ground send.
  std::vector<float> ground_irradiance(const Light* light, bool direct) const {
    const std::size_t sides = ground_.seen.size();
    std::vector<float> out(sides * columns_, 0.0f);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides, 64), [&](const auto& range) {
      for (std::size_t side = range.begin(); side < range.end(); ++side) {
        if (!ground_.seen[side]) continue;
        float* e = out.data() + side * columns_;
        if (light) {
          for (std::uint32_t k = 0; k < ground_.rays; ++k) {
            const RayEnd& end = ground_.ends[side * ground_.rays + k];
            if (end.is_sky()) continue;
            const float* from = end.is_ground() ? light->ground.data() + (2 * std::size_t{end.facet()} + end.field) * columns_
                                                : light->fields.data() + (field_start_[end.target] + end.field) * columns_;
            for (std::size_t c = 0; c < columns_; ++c) e[c] += from[c];
          }
          for (std::size_t c = 0; c < columns_; ++c) e[c] /= static_cast<float>(ground_.rays);
        }
        if (direct)
          for (std::size_t c = 0; c < columns_; ++c) e[c] += ground_direct(side, c);
      }
    });
    return out;
  }

  float ground_direct(std::size_t side, std::size_t column) const {
    const std::size_t state = column / bands_, band = column % bands_;
    float e = 0;
    if (const auto k = lights_.sky_of_state[state]; k != LightSources::none)
      e += static_cast<float>(scene_.states[state].sky->irradiance[band]) * ground_.sky[k][side];
    if (const auto k = lights_.sun_of_state[state]; k != LightSources::none)
      e += static_cast<float>(scene_.states[state].sun->irradiance[band]) * ground_.lit[k][side];
    return e;
  }

  /// Radiosity from irradiance, in place.
  void reflect_from_ground(std::vector<float>& e) const {
    if (!scene_.ground) return;
    const auto& optics = scene_.ground->optics;
    for (std::size_t f = 0; f + 1 < ground_.seen.size(); f += 2)
      for (std::size_t c = 0; c < columns_; ++c) {
        const float front = e[f * columns_ + c], back = e[(f + 1) * columns_ + c];
        const std::size_t band = c % bands_;
        e[f * columns_ + c] = optics.reflectance_front[band] * front + optics.transmittance[band] * back;
        e[(f + 1) * columns_ + c] = optics.reflectance_back[band] * back + optics.transmittance[band] * front;
      }
  }

  /// One pass over all members: what they send when `in` comes in; `direct`: with sun and sky.
  void pass(const std::vector<Batch>& batches, const Light* in, bool direct, Light& out) {
    std::vector<std::uint32_t> sweeps(batches.size(), 0);
    tbb::parallel_for(std::size_t{0}, batches.size(), [&](std::size_t q) {
      if (progress_.cancelled()) return;
      with_width(batches[q].width, [&](auto constant) {
        constexpr int width = decltype(constant)::value;
        const Batch& b = batches[q];
        const auto& original = members_.originals[b.original];
        const LineOperator& op = *original.coarse;
        LaneField<width> field, source(2 * original.elements.size(), Lanes<width>{}), radiosity;
        incoming<width>(b, op, stored_ends(b), in, direct, field);
        add_outside<width>(op, field, source);
        if (direct) add_sun<width>(b, source);
        const auto swept = solve_inside<width>(op, original.elements.material, optics_of<width>(b), source,
                                               static_cast<float>((direct ? 1.0 : 5.0) * density_.inner_tolerance), most_sweeps, radiosity);
        sweeps[q] = swept.sweeps;
        outgoing<width>(op, radiosity, field);
        for (std::size_t j = 0; j < b.members.size(); ++j)
          for (std::size_t f = 0; f < op.fields(); ++f)
            for (std::size_t c = 0; c < b.columns; ++c)
              out.fields[(field_start_[b.members[j]] + f) * columns_ + b.first_column + c] = field[f][j * b.columns + c];
      });
    });
    progress_.check();
    for (const auto n : sweeps) sweeps_ += n;
    out.ground = ground_irradiance(in, direct);
    reflect_from_ground(out.ground);
  }

  /// Scalar product of two lights per column: power that leaves through the fields and from the ground as the weight.
  std::vector<double> product(const Light& a, const Light& b) const {
    std::vector<double> out(columns_, 0.0);
    for (std::size_t m = 0; m < members_.maps.size(); ++m) {
      const auto& op = members_.coarse_of(m);
      const double unit = members_.maps[m].scale * members_.maps[m].scale * op.line_area / op.directions();
      const float *x = a.fields.data() + field_start_[m] * columns_, *y = b.fields.data() + field_start_[m] * columns_;
      for (std::size_t f = 0; f < op.fields(); ++f)
        for (std::size_t c = 0; c < columns_; ++c) out[c] += unit * op.field_lines[f] * x[f * columns_ + c] * y[f * columns_ + c];
    }
    for (std::size_t side = 0; side < ground_.seen.size(); ++side)
      for (std::size_t c = 0; c < columns_; ++c)
        out[c] += double{ground_.area[side / 2]} * a.ground[side * columns_ + c] * b.ground[side * columns_ + c];
    return out;
  }

  Light no_light() const {
    return {std::vector<float>(field_start_.back() * columns_, 0.0f), std::vector<float>(ground_.seen.size() * columns_, 0.0f)};
  }

  /// x = b + A x, where A is a pass without direct light. Steps d_k = A^k r from the residual r are all kept, a few, and combined so that
  /// the residual |r - sum c_k (d_k - d_{k+1})| is least, column by column: GMRES on the power basis (reduced rank extrapolation, Sidi
  /// 1991, doi:10.1016/0377-0427(91)90013-A), which is well enough conditioned for so few. Then again from the true residual.
  void iterate() {
    const auto batches = batches_of(all_members());
    const double tolerance = settings_.tolerance > 0 ? settings_.tolerance : density_.tolerance;
    total_ = no_light();
    const std::size_t bytes = bytes_of(total_.fields) + bytes_of(total_.ground);
    const auto most_steps = static_cast<std::size_t>(std::clamp<std::uint64_t>(basis_bytes / std::max<std::size_t>(bytes, 1), 3, 10));
    Stopwatch watch;
    std::vector<double> scale;  // |b| per column
    std::size_t kept = 0;
    bool done = false;
    for (std::uint32_t passes = 0; !done && passes < most_passes;) {
      std::vector<Light> step(1, no_light());
      pass(batches, passes == 0 ? nullptr : &total_, true, step[0]);
      for (std::size_t i = 0; i < total_.fields.size(); ++i) step[0].fields[i] -= total_.fields[i];
      for (std::size_t i = 0; i < total_.ground.size(); ++i) step[0].ground[i] -= total_.ground[i];
      ++passes;
      const auto first = product(step[0], step[0]);
      if (scale.empty()) scale = first;
      done = relative(first, scale) <= tolerance;
      say_residual(passes, relative(first, scale), watch);
      std::vector<Eigen::MatrixXd> gram(columns_, Eigen::MatrixXd::Zero(most_steps + 1, most_steps + 1));  // d_i . d_j
      for (std::size_t c = 0; c < columns_; ++c) gram[c](0, 0) = first[c];
      std::vector<Eigen::VectorXd> weights(columns_);
      while (!done && step.size() <= most_steps && passes < most_passes) {
        step.push_back(no_light());
        pass(batches, &step[step.size() - 2], false, step.back());
        ++passes;
        const auto n = static_cast<Eigen::Index>(step.size()) - 1;
        for (Eigen::Index i = 0; i <= n; ++i) {
          const auto dot = product(step[i], step.back());
          for (std::size_t c = 0; c < columns_; ++c) gram[c](i, n) = gram[c](n, i) = dot[c];
        }
        double residual = 0;
        for (std::size_t c = 0; c < columns_; ++c) {
          const double left = least_residual(gram[c].topLeftCorner(n + 1, n + 1), weights[c]);
          if (scale[c] > 0) residual = std::max(residual, std::sqrt(left / scale[c]));
        }
        say_residual(passes, residual, watch);
        done = residual <= tolerance;
      }
      kept = std::max(kept, step.size());
      for (std::size_t k = 0; k + 1 < step.size(); ++k) add(step[k], weights, k);
      if (step.size() == 1 && done) {  // the residual itself is the last correction
        for (auto& w : weights) w = Eigen::VectorXd::Ones(1);
        add(step[0], weights, 0);
      }
    }
    if (!done) report_.status = SolveStatus::not_converged;
    report_.memory.emplace_back("fields", (kept + 1) * bytes);
    report_.counts.emplace_back("sweeps", sweeps_);
  }

  double relative(const std::vector<double>& squared, const std::vector<double>& scale) const {
    double worst = 0;
    for (std::size_t c = 0; c < columns_; ++c)
      if (scale[c] > 0) worst = std::max(worst, std::sqrt(squared[c] / scale[c]));
    return worst;
  }

  void say_residual(std::uint32_t passes, double residual, const Stopwatch& watch) {
    report_.convergence.push_back({0, passes - 1, residual, links_, watch.seconds()});
    progress_.line(fmt::format("pass {}: residual {:.1e}, {:.1f} s", passes, residual, watch.seconds()));
  }

  /// Least |r - sum_k c_k (d_k - d_{k+1})|^2 over c, from the scalar products of d_0 = r, d_1, ..., d_n.
  static double least_residual(const Eigen::MatrixXd& gram, Eigen::VectorXd& c) {
    const auto n = gram.rows() - 1;
    Eigen::MatrixXd normal(n, n);
    Eigen::VectorXd right(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      right(i) = gram(0, i) - gram(0, i + 1);
      for (Eigen::Index j = 0; j < n; ++j) normal(i, j) = gram(i, j) - gram(i + 1, j) - gram(i, j + 1) + gram(i + 1, j + 1);
    }
    c = normal.completeOrthogonalDecomposition().solve(right);
    return std::max(0.0, gram(0, 0) - 2.0 * c.dot(right) + c.dot(normal * c));
  }

  void add(const Light& step, const std::vector<Eigen::VectorXd>& weights, std::size_t k) {
    std::vector<float> w(columns_);
    for (std::size_t c = 0; c < columns_; ++c)
      w[c] = static_cast<std::size_t>(weights[c].size()) > k ? static_cast<float>(weights[c](k)) : 0.0f;
    for (std::size_t i = 0; i < total_.fields.size(); ++i) total_.fields[i] += w[i % columns_] * step.fields[i];
    for (std::size_t i = 0; i < total_.ground.size(); ++i) total_.ground[i] += w[i % columns_] * step.ground[i];
  }

  // ---- opening

  /// Rows of one copy, as the sink takes them.
  struct Rows {
    std::size_t first = 0, count = 0;
    std::vector<float> irradiance, sunlit;
  };

  void open_all() {
    const auto ground_e = ground_irradiance(&total_, true);  // before the fields change no more
    std::map<std::size_t, Rows> waiting;
    std::size_t next_row = 0;
    std::uint32_t fine_of = no_parent;
    std::unique_ptr<LineOperator> fine;
    std::size_t first = 0;
    while (first < members_.maps.size()) {
      std::vector<std::uint32_t> window;
      std::size_t bytes = 0;
      for (; first < members_.maps.size() && (window.empty() || bytes < window_bytes); ++first) {
        window.push_back(static_cast<std::uint32_t>(first));
        bytes += members_.found.originals[members_.found.members[first].original].facets * 2 * sizeof(float) * (columns_ + states_);
      }
      progress_.fraction("opening", static_cast<double>(window.front()) / static_cast<double>(members_.maps.size()));
      std::vector<Rows> rows(placed_rows(window));
      auto batches = batches_of(window);
      for (std::size_t begin = 0; begin < batches.size();) {
        std::size_t end = begin;
        while (end < batches.size() && batches[end].original == batches[begin].original) ++end;
        if (fine_of != batches[begin].original) {
          fine.reset();
          fine_of = batches[begin].original;
          fine = std::make_unique<LineOperator>(members_.originals[fine_of].elements, density_.fine,
                                                mix(settings_.seed, fine_stream, fine_of), progress_);
          if (fine->bytes() > fine_bytes_) fine_bytes_ = fine->bytes();
        }
        std::vector<std::vector<Balance>> partial(end - begin);
        tbb::parallel_for(begin, end, [&](std::size_t q) {
          if (progress_.cancelled()) return;
          with_width(batches[q].width,
                     [&](auto constant) { open<decltype(constant)::value>(batches[q], *fine, rows, window.front(), partial[q - begin]); });
        });
        progress_.check();
        for (std::size_t q = begin; q < end; ++q) add_balance(batches[q], partial[q - begin]);
        begin = end;
      }
      for (auto& r : rows) {
        const auto place = r.first;
        waiting.emplace(place, std::move(r));
      }
      while (!waiting.empty() && waiting.begin()->first == next_row) {
        const Rows& r = waiting.begin()->second;
        sink_.rows({r.first, r.count, r.irradiance.data(), lights_.suns.empty() ? nullptr : r.sunlit.data(), nullptr});
        next_row += r.count;
        waiting.erase(waiting.begin());
      }
    }
    report_.memory.emplace_back("fine", fine_bytes_);
    write_ground(ground_e);
  }

  /// Space for the rows of the copies of the members, member by member, part by part.
  std::vector<Rows> placed_rows(const std::vector<std::uint32_t>& window) {
    std::vector<Rows> out;
    row_of_member_.clear();
    for (const auto m : window) {
      row_of_member_.push_back(out.size());
      for (const auto c : members_.found.members[m].copies) {
        Rows r;
        r.first = placed_.copies[c].first_facet;
        r.count = placed_.plant_facets[placed_.copies[c].plant];
        r.irradiance.assign(states_ * r.count * 2 * bands_, 0.0f);
        if (!lights_.suns.empty()) r.sunlit.assign(states_ * r.count * 2, 0.0f);
        out.push_back(std::move(r));
      }
    }
    return out;
  }

  template <int width>
  void open(const Batch& b, const LineOperator& fine, std::vector<Rows>& rows, std::uint32_t window_first, std::vector<Balance>& balance) {
    const auto& original = members_.originals[b.original];
    const auto& e = original.elements;
    const std::size_t sides = 2 * e.size(), lanes = b.members.size() * b.columns;
    LaneField<width> field, source(sides, Lanes<width>{}), radiosity;
    incoming<width>(b, *original.coarse, stored_ends(b), &total_, true, field);
    add_outside<width>(*original.coarse, field, source);
    add_sun<width>(b, source);
    solve_inside<width>(*original.coarse, e.material, optics_of<width>(b), source, static_cast<float>(density_.inner_tolerance),
                        most_sweeps, radiosity);

    std::vector<std::vector<RayEnd>> ends(b.members.size(), std::vector<RayEnd>(fine.points.size()));
    std::vector<const RayEnd*> pointers;
    for (std::size_t j = 0; j < b.members.size(); ++j) {
      look_from(b.members[j], fine, ends[j].data());
      pointers.push_back(ends[j].data());
    }
    // the sky's light first, for the balance
    LaneField<width> sky(sides, Lanes<width>{}), scattered(sides, Lanes<width>{});
    incoming<width>(b, fine, pointers, nullptr, true, field);
    add_outside<width>(fine, field, sky);
    incoming<width>(b, fine, pointers, &total_, false, field);
    add_outside<width>(fine, field, scattered);
    for (std::size_t i = 0; i < e.size(); ++i) {
      if (fine.lines[i] == 0) continue;
      const float share = 1.0f / static_cast<float>(fine.lines[i]);
      for (std::size_t side = 2 * i; side < 2 * i + 2; ++side) add_row<width>(fine.inside, side, share, radiosity.data(), scattered[side]);
    }
    balance.assign(b.columns, Balance{});
    escaped<width>(b, fine, pointers, radiosity, balance);
    for (std::size_t j = 0; j < b.members.size(); ++j)
      member_rows<width>(b, j, fine, sky, scattered, rows, row_of_member_[b.members[j] - window_first], balance);
    (void)lanes;
  }

  /// Radiosity that ends in the sky: sum of area * B * (lines of the side that do) / W.
  template <int width>
  void escaped(const Batch& b, const LineOperator& op, const std::vector<const RayEnd*>& ends, const LaneField<width>& radiosity,
               std::vector<Balance>& balance) const {
    const auto& e = members_.originals[b.original].elements;
    std::vector<float> open(op.fields());
    for (std::size_t j = 0; j < b.members.size(); ++j) {
      for (std::size_t f = 0; f < op.fields(); ++f) {
        std::uint32_t n = 0;
        for (auto k = op.point_start[f]; k < op.point_start[f + 1]; ++k) n += ends[j][k].is_sky();
        open[f] = n ? static_cast<float>(n) / static_cast<float>(op.point_start[f + 1] - op.point_start[f]) : 0.0f;
      }
      const double scale = members_.maps[b.members[j]].scale * members_.maps[b.members[j]].scale;
      for (std::size_t side = 0; side < radiosity.size(); ++side) {
        if (op.lines[side / 2] == 0) continue;
        float lines = 0;
        for (auto k = op.outside.start[side]; k < op.outside.start[side + 1]; ++k)
          lines += static_cast<float>(op.outside.count[k]) * open[op.outside.column[k]];
        if (lines == 0) continue;
        const double area = scale * e.area[side / 2] * lines / op.lines[side / 2];
        for (std::size_t c = 0; c < b.columns; ++c) balance[c].escaped += area * radiosity[side][j * b.columns + c];
      }
    }
  }

  template <int width>
  void member_rows(const Batch& b, std::size_t j, const LineOperator& fine, const LaneField<width>& sky, const LaneField<width>& scattered,
                   std::vector<Rows>& rows, std::size_t first_row, std::vector<Balance>& balance) {
    const std::uint32_t m = b.members[j];
    const auto& original = members_.originals[b.original];
    const auto& e = original.elements;
    const auto& s = e.surface;
    const double scale = members_.maps[m].scale * members_.maps[m].scale;
    for (std::size_t t = 0; t < s.size(); ++t) {
      if (s.split[t] == 0) continue;
      const std::uint32_t facet = e.order[t];
      const auto part = static_cast<std::size_t>(std::upper_bound(original.facet_of_part.begin(), original.facet_of_part.end(), facet) -
                                                 original.facet_of_part.begin() - 1);
      Rows& out = rows[first_row + part];
      const std::size_t i = facet - original.facet_of_part[part];
      const std::uint32_t begin = s.first_cell[t], end = s.first_cell[t + 1];
      const float share = 1.0f / static_cast<float>(end - begin);
      const auto& optics = scene_.optics[original.facet_material[facet]];
      const double area = scale * s.cell_area[t] * (end - begin);
      for (std::size_t c = 0; c < b.columns; ++c) {
        const std::size_t column = b.first_column + c, state = column / bands_, band = column % bands_, lane = j * b.columns + c;
        const auto sun = lights_.sun_of_state[state];
        const float sun_strength = sun == LightSources::none ? 0.0f : static_cast<float>(scene_.states[state].sun->irradiance[band]);
        double absorbed = 0;
        for (std::size_t side = 0; side < 2; ++side) {
          float direct = 0, rest = 0, lit = 0;
          for (auto cell = begin; cell < end; ++cell) {
            const std::size_t from = 2 * std::size_t{fine.stand_in[e.element_of_cell[cell]]} + side;
            direct += share * sky[from][lane];
            rest += share * scattered[from][lane];
          }
          if (sun != LightSources::none) {
            const Vec3 d = members_.maps[m].direction_back(lights_.suns[sun]->direction);
            const double cosine = s.normal[0][t] * d.x + s.normal[1][t] * d.y + s.normal[2][t] * d.z;
            if ((cosine > 0) == (side == 0)) {
              for (auto cell = begin; cell < end; ++cell)
                lit += share * static_cast<float>(lit_[sun].lit[lit_[sun].first[m] + cell]) / 255.0f;
              direct += lit * static_cast<float>(std::fabs(cosine)) * sun_strength;
            }
            if (band == 0) out.sunlit[(state * out.count + i) * 2 + side] = lit;
          }
          out.irradiance[((state * out.count + i) * 2 + side) * bands_ + band] = direct + rest;
          balance[c].incident += area * direct;
          absorbed += (1.0 - (side == 0 ? optics.reflectance_front[band] : optics.reflectance_back[band]) - optics.transmittance[band]) *
                      (double{direct} + rest);
        }
        balance[c].leaves += area * absorbed;
      }
    }
  }

  void add_balance(const Batch& b, const std::vector<Balance>& partial) {
    for (std::size_t c = 0; c < b.columns; ++c) {
      auto& out = report_.balance[(b.first_column + c) / bands_][(b.first_column + c) % bands_];
      out.incident += partial[c].incident;
      out.leaves += partial[c].leaves;
      out.escaped += partial[c].escaped;
    }
  }

  void write_ground(const std::vector<float>& e) {
    const std::size_t n = placed_.ground.size();
    if (n == 0) return;
    std::vector<float> b = e;
    reflect_from_ground(b);
    const auto& optics = scene_.ground->optics;
    const std::size_t parts = std::size_t{members_.ground_split} * members_.ground_split;
    const float share = 1.0f / static_cast<float>(parts);
    std::vector<float> irradiance(states_ * n * 2 * bands_, 0.0f), sunlit(lights_.suns.empty() ? 0 : states_ * n * 2, 0.0f);
    for (std::size_t part = 0; part < n * parts; ++part)
      for (std::size_t c = 0; c < columns_; ++c) {
        const std::size_t f = part / parts, state = c / bands_, band = c % bands_;
        auto& balance = report_.balance[state][band];
        for (std::size_t side = 0; side < 2; ++side) {
          const std::size_t i = 2 * part + side;
          const float value = e[i * columns_ + c];
          irradiance[((state * n + f) * 2 + side) * bands_ + band] += share * value;
          const double area = ground_.area[part];
          balance.incident += area * ground_direct(i, c);
          balance.ground +=
              area * value *
              (1.0 - (side == 0 ? optics.reflectance_front[band] : optics.reflectance_back[band]) - optics.transmittance[band]);
          balance.escaped += area * b[i * columns_ + c] * ground_.sky_seen[i];
          if (const auto sun = lights_.sun_of_state[state]; sun != LightSources::none && band == 0)
            sunlit[(state * n + f) * 2 + side] += share * ground_.sunlit[sun][i];
        }
      }
    sink_.rows({placed_.first_ground_facet, n, irradiance.data(), lights_.suns.empty() ? nullptr : sunlit.data(), nullptr});
  }

  const Scene& scene_;
  const PlacedScene& placed_;
  const InstantiationSettings& settings_;
  IrradianceSink& sink_;
  Progress& progress_;
  const std::size_t states_, bands_, columns_;
  const LightSources lights_;
  const InstantiationDensity density_;
  Members members_;
  std::vector<LitCells> lit_;
  std::unique_ptr<Surroundings> around_;
  std::vector<std::uint64_t> field_start_, end_start_;  ///< per member
  std::vector<RayEnd> ends_;
  GroundView ground_;
  Light total_;
  std::vector<std::size_t> row_of_member_;  ///< of the window
  std::uint64_t sweeps_ = 0, links_ = 0, fragments_ = 0;
  std::size_t fine_bytes_ = 0;
  SolveReport report_;
};

}  // namespace

InstantiationDensity instantiation_density(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {{32, 1.5, 6, 1}, {64, 3.0, 6, 1}, 2.0, 2, 200.0, 32, 5e-3, 3e-3};
    case Quality::standard:
      return {{48, 2.0, 8, 1}, {128, 5.0, 8, 2}, 2.0, 4, 1000.0, 64, 2e-3, 1e-3};
    case Quality::fine:
      return {{96, 4.0, 8, 2}, {256, 8.0, 8, 2}, 4.0, 8, 4000.0, 128, 3e-4, 5e-5};
  }
  return {};
}

SolveReport solve_instantiation(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings, IrradianceSink& sink,
                                Progress& progress) {
  std::optional<tbb::global_control> control;
  if (settings.threads > 0) control.emplace(tbb::global_control::max_allowed_parallelism, settings.threads);
  return InstantiationSolver(scene, placed, settings, sink, progress).run();
}

}  // namespace sunfleck
