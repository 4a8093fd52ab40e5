// Form factors from global lines against form factors from rays, on one scene: the same elements, the same direct light, the same
// system and its solver; only where the counts come from differs. docs/lines-against-rays.md holds its table.
//
//     bench_lines_against_rays [SCENE.toml] [most lines and rays per side]
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/core/timer.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/visibility/rays.hpp>

#include "places.hpp"
#include "radiosity/direct_light.hpp"
#include <sunfleck/radiosity/elements.hpp>
#include "radiosity/gmres.hpp"
#include "radiosity/line_links.hpp"
#include "radiosity/transport.hpp"

using namespace sunfleck;

namespace {

constexpr std::uint64_t ray_stream = 0x6a09e667f3bcc909ULL;

double cpu_seconds() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}

/// Wall and CPU seconds since it was made.
struct Clock {
  Stopwatch wall;
  double cpu_begin = cpu_seconds();
  double cpu() const { return cpu_seconds() - cpu_begin; }
};

/// What is the same for every row of the table.
struct Problem {
  Scene scene;
  FacetScene facets;
  RadiositySettings settings;  ///< method flat: links between elements only
  Elements elements;
  DirectLight direct;
  std::vector<float> rest;  ///< [sides] fraction of the hemisphere that is not open sky
  Field source;             ///< [sides][bands] direct irradiance
};

double area_of(const Elements& e, std::uint32_t cell) {
  const auto t = e.row_of_cell[cell];
  return e.surface.split[t] > 0 ? static_cast<double>(e.surface.cell_area[t]) : 0.0;
}

/// Direct irradiance of a side of a cell, first lighting state.
double direct_on(const Problem& p, std::uint32_t cell, std::uint32_t side, std::size_t band) {
  const auto& d = p.direct;
  const std::size_t cell_side = 2 * std::size_t{cell} + side;
  double e = 0;
  if (const auto k = d.sky_of_state[0]; k != DirectLight::none)
    e += p.scene.states[0].sky->irradiance[band] * static_cast<double>(d.sky[k][cell_side]);
  if (const auto k = d.sun_of_state[0]; k != DirectLight::none) {
    const double cosine = static_cast<double>(d.sun_cosine[k][p.elements.row_of_cell[cell]]) * (side == 0 ? 1.0 : -1.0);
    e += p.scene.states[0].sun->irradiance[band] * std::max(0.0, cosine) * static_cast<double>(d.sunlit[k][cell_side]);
  }
  return e;
}

double rest_on(const Problem& p, std::uint32_t cell, std::uint32_t side) {
  return p.direct.sky_seen.empty() ? 1.0 : 1.0 - static_cast<double>(p.direct.sky_seen[2 * std::size_t{cell} + side]);
}

Problem make_problem(const std::string& file) {
  Problem p;
  p.scene = read_scene(file);
  p.facets = expand(p.scene);
  p.elements = make_elements(p.scene, p.facets, p.settings);
  Timings timings;
  p.settings.method = RadiosityMethod::direct;  // the sky from projections of its own: the same for lines and rays
  p.direct = direct_light(p.scene, p.facets, p.elements, p.settings, timings, silent());
  p.settings.method = RadiosityMethod::flat;
  const auto& e = p.elements;
  const std::size_t bands = p.facets.bands;
  p.rest.assign(2 * e.size(), 1.0f);
  p.source.assign(2 * e.size() * bands, 0.0f);
  for (std::uint32_t i = 0; i < e.size(); ++i)
    for (std::uint32_t side = 0; side < 2; ++side) {
      double area = 0, rest = 0;
      std::vector<double> sum(bands, 0.0);
      for (std::uint32_t k = e.first_cell[i]; k < e.first_cell[i + 1]; ++k) {
        const double a = area_of(e, e.cells[k]);
        area += a;
        rest += a * rest_on(p, e.cells[k], side);
        for (std::size_t b = 0; b < bands; ++b) sum[b] += a * direct_on(p, e.cells[k], side, b);
      }
      if (area == 0.0) continue;
      p.rest[2 * i + side] = static_cast<float>(rest / area);
      for (std::size_t b = 0; b < bands; ++b) p.source[(2 * i + side) * bands + b] = static_cast<float>(sum[b] / area);
    }
  return p;
}

/// A point of area `target` into an element: the cell in which it falls, spread evenly over the cell's triangle.
Vec3 point_on(const Problem& p, std::uint32_t element, double target, double u, double v, std::uint32_t& facet) {
  const auto& e = p.elements;
  std::uint32_t k = e.first_cell[element];
  for (; k + 1 < e.first_cell[element + 1] && target >= area_of(e, e.cells[k]); ++k) target -= area_of(e, e.cells[k]);
  const auto cell = e.cells[k];
  const auto t = e.row_of_cell[cell];
  const int split = std::max<int>(1, e.surface.split[t]);
  // the inverse of cell_of(): which row, and where in it
  int index = static_cast<int>(cell - e.surface.first_cell[t]), j = 0;
  for (; index >= 2 * (split - j) - 1; ++j) index -= 2 * (split - j) - 1;
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  const int i = index / 2;
  const bool upper = index % 2 != 0;
  const double a = (i + (upper ? 1.0 - u : u)) / split, b = (j + (upper ? 1.0 - v : v)) / split;
  facet = e.order[t];
  const auto& c = p.facets.corners[facet];
  return c[0] + a * (c[1] - c[0]) + b * (c[2] - c[0]);
}

/// Counts from `rays` rays per side of every element, cosine distributed; odd and even ones make the two halves.
std::array<HalfLinks, 2> ray_links(const Problem& p, const RayScene& rays, std::uint32_t per_side, std::uint64_t seed) {
  const auto& e = p.elements;
  std::vector<std::uint32_t> row_of_facet(p.facets.size());
  for (std::uint32_t t = 0; t < e.order.size(); ++t) row_of_facet[e.order[t]] = t;
  const std::size_t sides = 2 * e.size();
  constexpr std::uint32_t up = 0xfffffffeu, down = 0xffffffffu;
  std::array<HalfLinks, 2> out;
  std::vector<std::uint32_t> met[2];
  for (auto& m : met) m.assign(sides * (per_side / 2), down);
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(e.size()), 64), [&](const auto& range) {
    for (std::uint32_t i = range.begin(); i < range.end(); ++i) {
      double area = 0;
      for (std::uint32_t k = e.first_cell[i]; k < e.first_cell[i + 1]; ++k) area += area_of(e, e.cells[k]);
      if (area == 0.0) continue;
      for (std::uint32_t side = 0; side < 2; ++side)
        for (std::uint32_t r = 0; r < per_side; ++r) {
          const auto key = static_cast<std::uint32_t>(mix(seed ^ ray_stream, 2 * i + side));
          std::uint32_t facet = 0;
          const Vec3 origin = point_on(p, i, area * sobol_owen(r, 0, key), sobol_owen(r, 1, key), sobol_owen(r, 2, key), facet);
          const auto& c = p.facets.corners[facet];
          Vec3 u, v, w = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
          if (side == 1) w = -w;
          orthonormal_frame(w, u, v);
          const double sine = std::sqrt(sobol_owen(r, 3, key)), turn = 2.0 * std::numbers::pi * sobol_owen(r, 4, key);
          const Vec3 d = glm::normalize(sine * (std::cos(turn) * u + std::sin(turn) * v) + std::sqrt(1.0 - sine * sine) * w);
          const RayHit hit = rays.first_hit(origin, d, facet);
          std::uint32_t end = d.z > 0.0 ? up : down;
          if (hit) {
            const auto t = row_of_facet[hit.facet];
            const auto cell = e.surface.first_cell[t] +
                              cell_of(static_cast<float>(hit.u), static_cast<float>(hit.v), std::max<int>(1, e.surface.split[t]));
            end = 2 * e.element_of_cell[cell] + (hit.front ? 0 : 1);
          }
          met[r % 2][(2 * std::size_t{i} + side) * (per_side / 2) + r / 2] = end;
        }
    }
  });
  tbb::parallel_for(0, 2, [&](int h) {
    auto& half = out[h];
    half.lines.assign(sides, static_cast<float>(per_side / 2));
    half.open_up.assign(sides, 0.0f);
    half.open_down.assign(sides, 0.0f);
    NearBuilder near(sides);
    for (std::size_t i = 0; i < sides; ++i) {
      const auto begin = met[h].begin() + static_cast<std::ptrdiff_t>(i * (per_side / 2)), end = begin + per_side / 2;
      for (auto k = begin; k != end; ++k) {
        if (*k == up)
          half.open_up[i] += 1.0f;
        else if (*k == down)
          half.open_down[i] += 1.0f;
        else
          near.add_end(static_cast<std::uint32_t>(i), *k);
      }
    }
    std::vector<float> lines(sides, 0.0f);  // known already
    half.near = near.finish(sides, lines);
  });
  return out;
}

/// Absorbed power per area of every organ of a plant, [organs][bands] and the organs' areas.
struct Absorbed {
  std::vector<double> power;
  std::vector<double> area;
};

/// E_a = E0 + (1 - u) S_a B_b, E_b = E0 + (1 - u) S_b B_a, as the program solves it.
Absorbed solve(const Problem& p, const std::array<HalfLinks, 2>& half) {
  const auto& e = p.elements;
  const std::size_t bands = p.facets.bands, sides = 2 * e.size(), values = sides * bands;
  ClusterFields unused;  // there are no clusters
  std::vector<Gather> gather;
  for (const auto& h : half)
    gather.emplace_back(h, nullptr, p.direct.sky_seen.empty() ? std::vector<float>(sides, 0.0f) : h.open_up, bands, unused);
  const Reflection reflection(p.facets, e.material, 1);
  Field b(values), source = p.source;
  source.insert(source.end(), p.source.begin(), p.source.end());
  Field x = source;
  std::vector<float> weight(2 * sides);
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = e.area[(i % sides) / 2];
  const auto apply = [&](const Field& in, Field& out) {
    for (std::size_t h = 0; h < 2; ++h) {
      reflection.apply(in.data() + (1 - h) * values, b.data());
      gather[h].gather(b.data(), out.data() + h * values);
      for (std::size_t i = 0; i < values; ++i) out[h * values + i] *= p.rest[i / bands];
    }
  };
  gmres(apply, source, weight, norms(source, weight, bands), 1e-5, 100, x, silent());
  Field gathered(values, 0.0f), one(values);
  for (std::size_t h = 0; h < 2; ++h) {
    reflection.apply(x.data() + (1 - h) * values, b.data());
    gather[h].gather(b.data(), one.data());
    for (std::size_t i = 0; i < values; ++i) gathered[i] += 0.5f * one[i];
  }
  Absorbed out;
  out.power.assign(p.facets.organs.size() * bands, 0.0);
  out.area.assign(p.facets.organs.size(), 0.0);
  for (std::uint32_t cell = 0; cell < e.row_of_cell.size(); ++cell) {
    const auto t = e.row_of_cell[cell];
    if (e.order[t] >= p.facets.plant_facets) continue;
    const double a = area_of(e, cell);
    const auto& m = p.facets.materials[p.facets.optics[e.order[t]]];
    out.area[e.patch_of_row[t]] += a;
    for (std::uint32_t side = 0; side < 2; ++side)
      for (std::size_t band = 0; band < bands; ++band) {
        const double kept = 1.0 - static_cast<double>(side == 0 ? m.reflectance_front[band] : m.reflectance_back[band]) -
                            static_cast<double>(m.transmittance[band]);
        const double light = direct_on(p, cell, side, band) +
                             rest_on(p, cell, side) * static_cast<double>(gathered[(2 * e.element_of_cell[cell] + side) * bands + band]);
        out.power[e.patch_of_row[t] * bands + band] += a * kept * light;
      }
  }
  return out;
}

struct Error {
  double rmse = 0, bias = 0;  ///< over the mean [%]
};

Error error_of(const Absorbed& x, const Absorbed& r, std::size_t bands, std::size_t band) {
  double square = 0, difference = 0, mean = 0, area = 0;
  for (std::size_t o = 0; o < x.area.size(); ++o) {
    if (x.area[o] == 0.0) continue;
    const double d = x.power[o * bands + band] - r.power[o * bands + band];
    square += d * d / x.area[o];
    difference += d;
    mean += r.power[o * bands + band];
    area += x.area[o];
  }
  return {100.0 * std::sqrt(square * area) / mean, 100.0 * difference / mean};
}

void row(const Problem& p, const std::string& name, double samples, const Clock& counting, const std::array<HalfLinks, 2>& half,
         const Absorbed& truth) {
  const double cpu = counting.cpu(), wall = counting.wall.seconds();
  const Clock solving;
  const auto x = solve(p, half);
  const std::size_t bands = p.facets.bands;
  std::string errors;
  for (std::size_t b = 0; b < bands; ++b) {
    const auto error = error_of(x, truth, bands, b);
    errors += fmt::format(" {:.2f} ({:+.2f}) |", error.rmse, error.bias);
  }
  const std::size_t links = half[0].near.size() + half[1].near.size();
  fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} | {:.2f} |{}\n", name, 1e-6 * samples, cpu, wall, 1e-6 * samples / cpu,
             1e-6 * static_cast<double>(links), solving.cpu(), errors);
  std::fflush(stdout);
}

std::array<HalfLinks, 2> traced(const Problem& p, std::uint32_t directions, std::uint64_t seed, double& samples) {
  RadiositySettings settings = p.settings;
  settings.density.directions = directions;
  settings.seed = seed;
  auto links = line_links(p.elements, nullptr, {}, {}, settings, false, silent());
  samples = 2.0 * static_cast<double>(links.fragments);
  return std::move(links.half);
}

void run(const std::string& file, std::uint32_t most) {
  const Problem p = make_problem(file);
  fmt::print("{}: {} facets, {} organs, {} elements\n\n", file, p.facets.size(), p.facets.organs.size(), p.elements.size());
  double samples = 0;
  const Absorbed truth = solve(p, traced(p, 16 * most, 77, samples));
  std::string heads, rule;
  for (const auto& band : p.scene.bands) {
    heads += fmt::format(" {} error (bias) % |", band);
    rule += "---|";
  }
  fmt::print(
      "| factors from | 10^6 samples | CPU s | wall s | 10^6 samples per CPU s | 10^6 links | solve CPU s "
      "|{}\n|---|---|---|---|---|---|---|{}\n",
      heads, rule);
  for (std::uint32_t directions = 8; directions <= 2 * most; directions *= 2) {
    const Clock clock;
    const auto half = traced(p, directions, 1, samples);
    row(p, fmt::format("lines, {} directions", directions), samples, clock, half, truth);
  }
  const Clock building;
  const RayScene rays(p.facets);
  const double build_cpu = building.cpu();
  for (std::uint32_t per_side = 8; per_side <= most; per_side *= 2) {
    const Clock clock;
    const auto half = ray_links(p, rays, per_side, 1);
    row(p, fmt::format("rays, {} per side", per_side), 2.0 * per_side * static_cast<double>(p.elements.size()), clock, half, truth);
  }
  fmt::print("\nbuilding Embree's tree, in no row: {:.2f} CPU s\n", build_cpu);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc > 1 ? argv[1] : SUNFLECK_SOURCE_DIR "/plants/poplar_scene.toml",
        argc > 2 ? static_cast<std::uint32_t>(std::atoi(argv[2])) : 128);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_lines_against_rays: {}\n", error.what());
    return 2;
  }
}
