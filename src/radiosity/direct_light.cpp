#include "direct_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/light/level_light.hpp>
#include <sunfleck/light/open_light.hpp>
#include <sunfleck/light/sky_parts.hpp>
#include <sunfleck/light/wide_sun.hpp>
#include <sunfleck/scene/slope.hpp>
#include <sunfleck/visibility/projection.hpp>

#include "transport.hpp"

namespace sunfleck {

namespace {

constexpr std::uint64_t sky_stream = 0x51ed270b27c4f2a9ULL, sun_stream = 0x2545f4914f6cdd1dULL;
constexpr double least_sun_slope = 1e-3;  // of the sun's lines in periodic scenes

constexpr std::uint32_t fewest_wide_samples = 128;  ///< of the disc of a wide sun

/// Mean distance between lines so that an organ of the mean size meets `lines` of them (a leaf shows half its area on average).
double pitch_for(double patch_area, double lines) {
  return std::sqrt(0.5 * patch_area / lines);
}

/// Points of the sun's disc, each with a grid of its own: enough for the penumbrae, while some lines of each still meet every organ.
std::uint32_t sun_samples(const Sun& sun, const Surface& surface, double patch_area, const RadiosityDensity& density) {
  constexpr double fewest_lines = 8.0;  ///< of one grid on an organ
  const auto most = static_cast<std::uint32_t>(density.sun_lines_per_organ / fewest_lines);
  const auto wanted = sun_disc_points(sun, density.sun_samples, surface.longest_way(sun.direction), patch_area);
  return std::max(density.sun_samples, std::min(wanted, most));
}

/// Element means of a per-side quantity take the place of what no line has met; where none met a whole element (a sliver, a speck), the
/// mean of its organ.
void fill_unsampled(const Elements& e, const std::vector<bool>& unsampled, std::vector<float>& value) {
  std::vector<std::uint32_t> missed;
  for (std::size_t i = 0; i < e.size(); ++i) {
    double sum[2] = {0, 0};
    std::uint32_t known = 0;
    const auto first = e.cells.begin() + e.first_cell[i], last = e.cells.begin() + e.first_cell[i + 1];
    for (auto c = first; c != last; ++c)
      if (!unsampled[*c]) {
        ++known;
        for (int side = 0; side < 2; ++side) sum[side] += value[2 * *c + side];
      }
    if (known == 0 && first != last) missed.push_back(static_cast<std::uint32_t>(i));
    if (known == 0 || known == static_cast<std::uint32_t>(last - first)) continue;
    for (auto c = first; c != last; ++c)
      if (unsampled[*c])
        for (int side = 0; side < 2; ++side) value[2 * *c + side] = static_cast<float>(sum[side] / known);
  }
  if (missed.empty()) return;
  struct Mean {
    double sum[2] = {0, 0};
    std::uint64_t known = 0;
  };
  const auto patch_of = [&](std::size_t cell) { return e.patch_of_row[e.row_of_cell[cell]]; };
  std::vector<Mean> patches(*std::max_element(e.patch_of_row.begin(), e.patch_of_row.end()) + std::size_t{1});
  for (std::size_t c = 0; c < unsampled.size(); ++c) {
    if (unsampled[c]) continue;
    auto& mean = patches[patch_of(c)];
    ++mean.known;
    for (int side = 0; side < 2; ++side) mean.sum[side] += value[2 * c + side];
  }
  for (const auto i : missed)
    for (std::uint32_t k = e.first_cell[i]; k < e.first_cell[i + 1]; ++k) {
      const auto c = e.cells[k];
      const auto& mean = patches[patch_of(c)];
      if (mean.known > 0)
        for (int side = 0; side < 2; ++side) value[2 * c + side] = static_cast<float>(mean.sum[side] / static_cast<double>(mean.known));
    }
}

/// Lines conserve light: each ends at the sun or the sky once. Ratios of small counts, and cells that no line met, do not: the values of
/// plants and of the ground are scaled so that area x value adds up to what the lines found.
class Conservation {
 public:
  void add(bool ground, double found, double given) {
    found_[ground] += found;
    given_[ground] += given;
  }
  float factor(bool ground) const {
    return given_[ground] > 0.0 && found_[ground] > 0.0 ? static_cast<float>(found_[ground] / given_[ground]) : 1.0f;
  }

 private:
  double found_[2] = {0, 0}, given_[2] = {0, 0};
};

bool is_ground(const FacetScene& facets, const Elements& e, std::size_t cell) {
  return e.order[e.row_of_cell[cell]] >= facets.plant_facets;
}

double cell_area(const Elements& e, std::size_t cell) {
  const auto t = e.row_of_cell[cell];
  return e.surface.split[t] > 0 ? static_cast<double>(e.surface.cell_area[t]) : 0.0;
}

/// Area that one line stands for, on plants and on the ground: the nominal one in periodic scenes, whose lines fill the cell. In a finite
/// scene the lines that meet plants sample their area too: taken by their number, plates that see the whole sun or sky get all of it.
struct AreaOfLine {
  double of[2];  ///< [plants, ground]

  template <class Area>  // of a cell
  AreaOfLine(const FacetScene& facets, const Elements& e, const std::vector<float>& lines_met, double nominal, Area&& area_of)
      : of{nominal, nominal} {
    if (e.surface.periodic) return;
    double area[2] = {0, 0}, lines[2] = {0, 0};
    for (std::size_t c = 0; c < lines_met.size(); ++c) {
      area[is_ground(facets, e, c)] += area_of(c);
      lines[is_ground(facets, e, c)] += lines_met[c];
    }
    for (int g = 0; g < 2; ++g)
      if (lines[g] > 0.0) of[g] = area[g] / lines[g];
  }
};

/// Sums over lines become means over each cell's lines.
void normalise(const FacetScene& facets, const Elements& e, const std::vector<float>& all, const std::vector<bool>& unsampled,
               double area_of_line, std::vector<float>& value) {
  Conservation conservation;
  const AreaOfLine per_line(facets, e, all, area_of_line, [&](std::size_t c) { return cell_area(e, c); });
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (unsampled[c]) continue;
    const bool ground = is_ground(facets, e, c);
    conservation.add(ground, (static_cast<double>(value[2 * c]) + value[2 * c + 1]) * per_line.of[ground], 0.0);
    for (int side = 0; side < 2; ++side) value[2 * c + side] /= all[c];
  }
  fill_unsampled(e, unsampled, value);
  for (std::size_t c = 0; c < all.size(); ++c)
    conservation.add(is_ground(facets, e, c), 0.0, cell_area(e, c) * (static_cast<double>(value[2 * c]) + value[2 * c + 1]));
  for (std::size_t c = 0; c < all.size(); ++c)
    for (int side = 0; side < 2; ++side) value[2 * c + side] *= conservation.factor(is_ground(facets, e, c));
}

class DirectLightSolver {
 public:
  DirectLightSolver(const Scene& scene, const FacetScene& facets, const Elements& elements, const RadiositySettings& settings,
                    Timings& timings, Progress& progress)
      : scene_(scene), facets_(facets), e_(elements), s_(elements.surface), settings_(settings), timings_(timings), progress_(progress) {}

  DirectLight run() {
    auto sources = light_sources(scene_.states);
    skies_ = std::move(sources.skies);
    suns_ = std::move(sources.suns);
    out_.sky_of_state = std::move(sources.sky_of_state);
    out_.sun_of_state = std::move(sources.sun_of_state);
    Stopwatch sky_watch;
    if (!skies_.empty() && (settings_.method == RadiosityMethod::direct || !anything_scatters(facets_))) {
      sky();
      add_seconds(timings_, "sky", sky_watch.seconds());
    }
    Stopwatch sun_watch;
    for (std::size_t i = 0; i < suns_.size(); ++i) {
      progress_.check();
      sun(*suns_[i]);
    }
    if (!suns_.empty()) add_seconds(timings_, "sun", sun_watch.seconds());
    return std::move(out_);
  }

 private:
  /// The skies by directions of their own: E_side = E of the open plane x the share of it that is seen.
  void sky() {
    const auto& density = settings_.density;
    ManyDirections many;
    bool below = false;
    for (const auto* sky : skies_) below = below || sky->reaches_below_horizon();
    for (std::uint32_t i = 0; i < density.sky_directions; ++i)
      many.towards.push_back(along_lines(s_, hemisphere_direction(i, density.sky_directions, mix(settings_.seed, sky_stream))));
    for (const auto* sky : skies_) {
      auto &from_above = many.above.emplace_back(), &from_below = many.below.emplace_back();
      const auto radiance = radiances_along(*sky, many.towards);
      for (std::size_t i = 0; i < radiance.size(); ++i) {
        const Vec3& d = many.towards[i];
        from_above.push_back(static_cast<float>(radiance[i]));
        if (below) from_below.push_back(static_cast<float>(sky->relative_radiance(-d)));
      }
    }
    if (!below) many.below.clear();
    const auto shares = share_seen(many, pitch_for(e_.patch_area, density.sky_lines_per_organ), mix(settings_.seed, sky_stream, 1), "sky");
    for (std::size_t k = 0; k < skies_.size(); ++k) {
      const OpenSky open(*skies_[k]);
      auto& sky = out_.sky.emplace_back(light_of_shares(shares[k], [&](const Vec3& normal) { return open.on(normal); }));
      conserve(sky, skies_[k]->reaches_below_horizon() ? 2.0 * slope_area() : open.on(skies_[k]->horizon) * slope_area());
    }
  }

  /// A disc so wide that surfaces may turn one side to a part of it and the other side to the rest.
  void wide_sun(const Sun& sun) {
    const auto& density = settings_.density;
    const auto samples = std::max(fewest_wide_samples, sun_samples(sun, s_, e_.patch_area, density));
    const auto seed = mix(settings_.seed, sun_stream);
    ManyDirections many;
    many.towards = sun_disc(sun, samples, seed);
    many.above.emplace_back(samples, 1.0f);
    double facing = 0.0;  // of a plane that faces the disc's centre
    for (auto& d : many.towards) {
      if (s_.periodic) d = lifted(*s_.periodic, d, least_sun_slope);
      facing += glm::dot(d, sun.direction);
    }
    const auto shares = share_seen(many, pitch_for(e_.patch_area, density.sun_lines_per_organ / samples), mix(seed, 1), "sun");
    const auto mean_of = [&](const Vec3& normal, auto&& value) {
      double sum = 0.0;
      for (const auto& d : many.towards) sum += value(glm::dot(normal, d));
      return sum;
    };
    auto& received = out_.wide_sun.back();
    received =
        light_of_shares(shares[0], [&](const Vec3& normal) { return mean_of(normal, [](double c) { return std::max(0.0, c); }) / facing; });
    double level = 0.0;
    for (const auto& d : many.towards) level += (s_.periodic ? s_.periodic->above(d) : d.z) / facing;
    conserve(received, level);
    out_.sunlit.back() = light_of_shares(
        shares[0], [&](const Vec3& normal) { return mean_of(normal, [](double c) { return c > 0.0 ? 1.0 : 0.0; }) / samples; });
  }

  /// Light from many directions, each of several lights with a weight in each; `below` [lights][directions] is that from the opposite
  /// direction, and may be empty.
  struct ManyDirections {
    std::vector<Vec3> towards;
    std::vector<std::vector<float>> above, below;
  };

  /// Per light and side of a cell: of the light that comes from where the side faces, the share that reaches it. Both are sums over the
  /// same lines, so that what stands in the open has all of it.
  std::vector<std::vector<float>> share_seen(const ManyDirections& many, double pitch, std::uint64_t seed, const char* phase) {
    const std::size_t cells = s_.cells(), lights = many.above.size(), directions = many.towards.size();
    std::vector<std::vector<float>> seen(lights, std::vector<float>(2 * cells, 0.0f)), facing = seen;
    constexpr std::size_t batch = 8;
    const bool below = !many.below.empty();
    std::vector<VisibleCounts> counts(batch), counts_below(below ? batch : 0);
    std::vector<float> area(batch);  // that a line stands for, over pitch^2
    for (std::size_t first = 0; first < directions; first += batch) {
      progress_.check();
      progress_.fraction(phase, static_cast<double>(first) / static_cast<double>(directions));
      const std::size_t n = std::min(batch, directions - first);
      tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
        const auto p = project_set_member(s_, many.towards[first + i], static_cast<std::uint32_t>(first + i), pitch, seed);
        area[i] = static_cast<float>(p.line_area / (pitch * pitch));
        clear(counts[i], cells);
        count_visible(s_, p, false, counts[i]);
        if (!below) return;
        clear(counts_below[i], cells);
        count_visible(s_, p, true, counts_below[i]);
      });
      for (std::size_t i = 0; i < n; ++i)
        for (const float lines : counts[i].all) out_.fragments += static_cast<std::uint64_t>(lines);
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells, 4096), [&](const auto& range) {
        for (std::size_t i = 0; i < n; ++i) {
          const Vec3& d = many.towards[first + i];
          const auto dx = static_cast<float>(d.x), dy = static_cast<float>(d.y), dz = static_cast<float>(d.z);
          for (std::size_t c = range.begin(); c < range.end(); ++c) {
            const float lines = counts[i].all[c];
            if (lines == 0.0f) continue;
            const auto t = e_.row_of_cell[c];
            const bool front_up = s_.normal[0][t] * dx + s_.normal[1][t] * dy + s_.normal[2][t] * dz > 0.0f;
            const std::size_t up = 2 * c + (front_up ? 0 : 1);
            for (std::size_t k = 0; k < lights; ++k) {
              const float weight = area[i] * many.above[k][first + i];
              seen[k][up] += weight * counts[i].visible[c];
              facing[k][up] += weight * lines;
              if (!below) continue;
              const float weight_below = area[i] * many.below[k][first + i];
              seen[k][up ^ 1] += weight_below * counts_below[i].visible[c];
              facing[k][up ^ 1] += weight_below * lines;
            }
          }
        }
      });
    }
    std::vector<bool> unsampled(cells);
    for (std::size_t k = 0; k < lights; ++k) {
      for (std::size_t c = 0; c < cells; ++c) unsampled[c] = facing[k][2 * c] == 0.0f && facing[k][2 * c + 1] == 0.0f;
      for (std::size_t i = 0; i < 2 * cells; ++i)
        if (facing[k][i] > 0.0f) seen[k][i] /= facing[k][i];
      fill_unsampled(e_, unsampled, seen[k]);
    }
    return seen;
  }

  /// Shares times what the open plane has: open(unit normal out of the side).
  template <class Open>
  std::vector<float> light_of_shares(const std::vector<float>& share, const Open& open) const {
    std::vector<float> light(share.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, s_.size(), 256), [&](const auto& range) {
      for (std::size_t t = range.begin(); t < range.end(); ++t) {
        if (s_.split[t] == 0) continue;
        const Vec3 normal{s_.normal[0][t], s_.normal[1][t], s_.normal[2][t]};
        const float sides[2] = {static_cast<float>(open(normal)), static_cast<float>(open(-normal))};
        for (std::size_t i = 2 * std::size_t{s_.first_cell[t]}; i < 2 * std::size_t{s_.first_cell[t + 1]}; ++i)
          light[i] = sides[i % 2] * share[i];
      }
    });
    return light;
  }

  /// Of the plane that a periodic scene repeats along, over its horizontal area.
  double slope_area() const {
    if (!s_.periodic) return 1.0;
    return glm::length(Vec3{s_.periodic->slope_x, s_.periodic->slope_y, 1.0});
  }

  /// In a periodic cell all light ends on plants or ground: `per_area` of the cell.
  void conserve(std::vector<float>& light, double per_area) const {
    if (!s_.periodic || !scene_.ground) return;
    double sum = 0.0;
    for (std::size_t c = 0; c < s_.cells(); ++c) sum += cell_area(e_, c) * (static_cast<double>(light[2 * c]) + light[2 * c + 1]);
    if (!(sum > 0.0)) return;
    const auto factor = static_cast<float>(per_area * s_.periodic->area() / sum);
    for (auto& value : light) value *= factor;
  }

  void sun(const Sun& sun) {
    const auto& density = settings_.density;
    const std::size_t cells = s_.cells();
    auto& lit = out_.sunlit.emplace_back();
    out_.wide_sun.emplace_back();
    auto& cosine = out_.sun_cosine.emplace_back(s_.size());
    for (std::size_t t = 0; t < s_.size(); ++t)
      cosine[t] =
          static_cast<float>(s_.normal[0][t] * sun.direction.x + s_.normal[1][t] * sun.direction.y + s_.normal[2][t] * sun.direction.z);
    if (sun.angular_diameter_deg > widest_narrow_sun_deg) return wide_sun(sun);
    const auto samples = sun_samples(sun, s_, e_.patch_area, density);
    const double pitch = pitch_for(e_.patch_area, density.sun_lines_per_organ / samples);
    const auto seed = mix(settings_.seed, sun_stream);
    const auto disc = sun_disc(sun, samples, seed);
    // a few samples at a time, for memory's sake; sums in the samples' order
    constexpr std::uint32_t batch = 4;
    std::vector<VisibleCounts> counts(std::min(batch, samples));
    std::vector<float> all(cells, 0.0f), visible(cells, 0.0f);
    double line_area = 0;  // mean over the samples
    std::vector<double> line_areas(counts.size());
    const auto share = [&](const Vec3& d) {
      return s_.periodic ? static_cast<float>(share_of_level_light(s_.periodic->levelled(d), least_sun_slope)) : 1.0f;
    };
    for (std::uint32_t first = 0; first < samples; first += batch) {
      const std::uint32_t n = std::min(batch, samples - first);
      tbb::parallel_for(std::uint32_t{0}, n, [&](std::uint32_t k) {
        const std::uint32_t i = first + k;
        Vec3 d = disc[i];
        if (s_.periodic) d = lifted(*s_.periodic, d, least_sun_slope);
        clear(counts[k], cells);
        const auto p = project_set_member(s_, d, i, pitch, mix(seed, 1));
        line_areas[k] = p.line_area;
        count_visible(s_, p, false, counts[k]);
      });
      for (std::uint32_t k = 0; k < n; ++k) line_area += line_areas[k] / samples;
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells, 8192), [&](const auto& range) {
        for (std::uint32_t k = 0; k < n; ++k)
          for (std::size_t c = range.begin(); c < range.end(); ++c) {
            all[c] += counts[k].all[c];
            visible[c] += share(disc[first + k]) * counts[k].visible[c];
          }
      });
    }
    counts = {};
    lit.assign(2 * cells, 0.0f);
    std::vector<bool> unsampled(cells);
    Conservation conservation;
    const auto shadow = [&](std::size_t c) { return cell_area(e_, c) * std::fabs(cosine[e_.row_of_cell[c]]); };
    const AreaOfLine per_line(facets_, e_, all, line_area / samples, shadow);
    double total = 0;
    for (std::size_t c = 0; c < cells; ++c) {
      const bool ground = is_ground(facets_, e_, c);
      conservation.add(ground, visible[c] * per_line.of[ground], 0.0);
      total += all[c];
      unsampled[c] = all[c] == 0.0f;
      if (all[c] > 0.0f) lit[2 * c + (cosine[e_.row_of_cell[c]] > 0.0f ? 0 : 1)] = visible[c] / all[c];
    }
    // an unsampled cell's lit side may be the other one than its element's mean says: keep the fraction, move it to the side that faces the
    // sun
    fill_unsampled(e_, unsampled, lit);
    for (std::size_t c = 0; c < cells; ++c)
      if (unsampled[c]) {
        const float fraction = std::min(1.0f, lit[2 * c] + lit[2 * c + 1]);
        const bool front = cosine[e_.row_of_cell[c]] > 0.0f;
        lit[2 * c] = front ? fraction : 0.0f;
        lit[2 * c + 1] = front ? 0.0f : fraction;
      }
    out_.fragments += static_cast<std::uint64_t>(total);
    for (std::size_t c = 0; c < cells; ++c)
      conservation.add(is_ground(facets_, e_, c), 0.0, shadow(c) * (static_cast<double>(lit[2 * c]) + lit[2 * c + 1]));
    for (std::size_t c = 0; c < cells; ++c)
      for (int side = 0; side < 2; ++side)
        lit[2 * c + side] = std::min(1.0f, lit[2 * c + side] * conservation.factor(is_ground(facets_, e_, c)));
  }

  static void clear(VisibleCounts& counts, std::size_t cells) {
    counts.all.assign(cells, 0.0f);
    counts.visible.assign(cells, 0.0f);
  }

  const Scene& scene_;
  const FacetScene& facets_;
  const Elements& e_;
  const Surface& s_;
  const RadiositySettings& settings_;
  Timings& timings_;
  Progress& progress_;
  std::vector<const Sky*> skies_;
  std::vector<const Sun*> suns_;
  DirectLight out_;
};

}  // namespace

std::size_t DirectLight::bytes() const {
  std::size_t total = bytes_of(sky_seen);
  for (const auto* list : {&sky, &sunlit, &sun_cosine, &wide_sun})
    for (const auto& v : *list) total += bytes_of(v);
  return total;
}

void sky_from_lines(const FacetScene& facets, const Elements& e, const SkySums& sums, double area_of_line, DirectLight& direct) {
  const std::size_t cells = sums.cells();
  std::vector<bool> unsampled(cells);
  std::vector<float> all(cells);
  for (std::size_t c = 0; c < cells; ++c) {
    all[c] = sums.all(c);
    unsampled[c] = all[c] == 0.0f;
  }
  const auto mean = [&](std::size_t row) {
    std::vector<float> value(2 * cells);
    for (std::size_t i = 0; i < value.size(); ++i) value[i] = sums.seen(i, row);
    normalise(facets, e, all, unsampled, area_of_line, value);
    return value;
  };
  direct.sky_seen = mean(0);
  for (std::size_t k = 0; k < sums.skies(); ++k) direct.sky.push_back(mean(1 + k));
  for (std::size_t i = 0; i < 2 * cells; ++i)
    if (const float seen = direct.sky_seen[i]; seen > 1.0f) {
      direct.sky_seen[i] = 1.0f;
      for (auto& sky : direct.sky) sky[i] /= seen;
    }
}

DirectLight direct_light(const Scene& scene, const FacetScene& facets, const Elements& elements, const RadiositySettings& settings,
                         Timings& timings, Progress& progress) {
  return DirectLightSolver(scene, facets, elements, settings, timings, progress).run();
}

}  // namespace sunfleck
