// Tables of originals: closed forms, energy, reciprocity, invariances, and an independent path tracer.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <tbb/task_arena.h>

#include <original/harmonics.hpp>
#include <original/octahedron.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/original/measure.hpp>
#include <sunfleck/scene/build.hpp>

#include <reference_runs.hpp>

using namespace sunfleck;

namespace {

constexpr double pi = std::numbers::pi;

Optics optics(float front, float back, float through) {
  return {"leaf", {front}, {back}, {through}};
}

/// A unit square leaf in the plane z = 0, front upwards.
OriginalGeometry leaf(const Optics& o) {
  return {{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}}, {Vec3{0, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}},
          {0, 0},
          {o},
          static_cast<std::uint32_t>(o.transmittance.size())};
}

/// n random leaves in a unit box.
OriginalGeometry tuft(std::uint64_t seed, int n, std::vector<Optics> materials) {
  OriginalGeometry g;
  g.bands = static_cast<std::uint32_t>(materials[0].transmittance.size());
  RandomStream random(seed);
  for (int i = 0; i < n; ++i) {
    Triangle t;
    const Vec3 at{random.next(), random.next(), random.next()};
    for (auto& p : t) p = at + 0.5 * Vec3{random.next(), random.next(), random.next()};
    g.corners.push_back(t);
    g.optics.push_back(static_cast<std::uint32_t>(i) % static_cast<std::uint32_t>(materials.size()));
  }
  g.materials = std::move(materials);
  return g;
}

MeasureSettings settings(double error, std::uint32_t order = 2, TableSettings::Basis basis = TableSettings::Basis::harmonics) {
  MeasureSettings s;
  s.tables.error = error;
  s.tables.order = order;
  s.tables.basis = basis;
  s.fit = false;
  return s;
}

Vec3 direction(int i, int count) {
  const double z = 1.0 - (2.0 * i + 1.0) / count, r = std::sqrt(1.0 - z * z), phi = 2.399963229728653 * i;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Integral of S(a, b) over b, which a product rule of Gauss-Legendre in z and even steps in azimuth does exactly for harmonics to order 6.
double integrated(const OriginalTables& t, const Vec3& a, std::uint32_t band) {
  static constexpr double nodes[] = {0.1252334085114689, 0.3678314989981802, 0.5873179542866175,
                                     0.7699026741943047, 0.9041172563704749, 0.9815606342467193};
  static constexpr double weights[] = {0.2491470458134028, 0.2334925365383548, 0.2031674267230659,
                                       0.1600783285433462, 0.1069393259953184, 0.0471753363865118};
  double sum = 0;
  for (int k = 0; k < 6; ++k)
    for (const double sign : {-1.0, 1.0})
      for (int j = 0; j < 13; ++j) {
        const double z = sign * nodes[k], r = std::sqrt(1 - z * z), phi = 2 * pi * j / 13;
        sum += weights[k] * 2 * pi / 13 * t.scattered(a, {r * std::cos(phi), r * std::sin(phi), z}, band);
      }
  return sum;
}

/// sigma as S's basis holds it.
double intercepted(const OriginalTables& t, const Vec3& w) {
  double y[49];
  harmonics(w, t.order, y);
  double sum = 0;
  for (std::size_t i = 0; i < t.size(); ++i) sum += y[i] * t.intercepted[i];
  return sum;
}

}  // namespace

TEST_CASE("Harmonics are orthonormal and turn into each other", "[original]") {
  // 26 x 13 product rule: exact for products of harmonics to order 6.
  double y[49], worst = 0;
  std::vector<double> gram(49 * 49, 0.0);
  static constexpr double nodes[] = {0.1252334085114689, 0.3678314989981802, 0.5873179542866175,
                                     0.7699026741943047, 0.9041172563704749, 0.9815606342467193};
  static constexpr double weights[] = {0.2491470458134028, 0.2334925365383548, 0.2031674267230659,
                                       0.1600783285433462, 0.1069393259953184, 0.0471753363865118};
  for (int k = 0; k < 12; ++k)
    for (int j = 0; j < 13; ++j) {
      const double z = (k % 2 ? 1 : -1) * nodes[k / 2], r = std::sqrt(1 - z * z), phi = 2 * pi * j / 13;
      harmonics({r * std::cos(phi), r * std::sin(phi), z}, 6, y);
      for (std::size_t a = 0; a < 49; ++a)
        for (std::size_t b = 0; b < 49; ++b) gram[a * 49 + b] += weights[k / 2] * 2 * pi / 13 * y[a] * y[b];
    }
  for (std::size_t a = 0; a < 49; ++a)
    for (std::size_t b = 0; b < 49; ++b) worst = std::max(worst, std::abs(gram[a * 49 + b] - (a == b ? 1.0 : 0.0)));
  CHECK(worst < 1e-12);
  harmonics({0, 0, 1}, 1, y);
  CHECK(y[0] == Approx(std::sqrt(0.25 / pi)));
  CHECK(y[2] == Approx(std::sqrt(0.75 / pi)));

  const Mat3 turn = placed({.turn_deg = 50, .tilt_deg = 70, .tilt_azimuth_deg = 20, .mirror = true}).map.linear;
  const auto rotation = harmonic_rotation(turn, 6);
  double turned[49];
  for (int i = 0; i < 20; ++i) {
    const Vec3 d = direction(i, 20);
    harmonics(d, 6, y);
    harmonics(glm::transpose(turn) * d, 6, turned);
    for (std::size_t a = 0; a < 49; ++a) {
      double sum = 0;
      for (std::size_t b = 0; b < 49; ++b) sum += rotation[a * 49 + b] * y[b];
      REQUIRE(std::abs(sum - turned[a]) < 1e-11);
    }
  }
}

TEST_CASE("The 66 directions: spread evenly, interpolation linear and complete", "[original]") {
  const auto& o = octahedron();
  REQUIRE(o.directions.size() == 66);
  CHECK(o.faces.size() == 128);
  double sum = 0;
  for (const double w : o.weights) sum += w;
  CHECK(sum == Approx(4 * pi));
  for (std::uint32_t i = 0; i < 66; ++i) {
    const auto at = interpolate(o.directions[i]);
    double share = 0;
    for (std::size_t k = 0; k < 3; ++k) share += at.row[k] == i ? at.share[k] : 0.0;
    CHECK(share == Approx(1.0));
    bool opposite = false;
    for (const auto& d : o.directions) opposite = opposite || glm::length(d + o.directions[i]) < 1e-12;
    CHECK(opposite);
  }
  for (int i = 0; i < 300; ++i) {
    const Vec3 d = direction(i, 300);
    const auto at = interpolate(d);
    Vec3 mean{0.0};
    for (std::size_t k = 0; k < 3; ++k) {
      REQUIRE(at.share[k] >= -1e-12);
      const Vec3& n = o.directions[at.row[k]];
      mean += at.share[k] * n / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    }
    CHECK(glm::length(glm::normalize(mean) - d) < 1e-12);
  }
}

TEST_CASE("One Lambertian leaf: sigma and S in closed form", "[original]") {
  const auto t = measure_original(leaf(optics(0.3f, 0.2f, 0.4f)), settings(0.002), silent());
  CHECK(t.reached);
  // A clamped cosine about n has coefficients pi/4 (l = 2), 2 pi/3 (l = 1), pi (l = 0) times Y(n) (Ramamoorthi & Hanrahan 2001).
  const double clamped[] = {pi, 2 * pi / 3, pi / 4};
  double y[9];
  harmonics({0, 0, 1}, 2, y);
  double front[9], back[9], norm = 0, wrong = 0, wrong_sigma = 0, norm_sigma = 0;
  for (int l = 0; l <= 2; ++l)
    for (int m = -l; m <= l; ++m) {
      front[l * l + l + m] = clamped[l] * y[l * l + l + m];
      back[l * l + l + m] = (l % 2 ? -1 : 1) * front[l * l + l + m];
    }
  for (std::size_t i = 0; i < 9; ++i) {
    wrong_sigma += std::pow(t.intercepted[i] - front[i] - back[i], 2);
    norm_sigma += std::pow(front[i] + back[i], 2);
    for (std::size_t j = 0; j < 9; ++j) {
      const double exact = (0.3 * front[i] * front[j] + 0.2 * back[i] * back[j] + 0.4 * (front[i] * back[j] + back[i] * front[j])) / pi;
      wrong += std::pow(t.phase[i * 9 + j] - exact, 2);
      norm += exact * exact;
    }
  }
  // Three times the standard errors that the measurement states of itself.
  CHECK(std::sqrt(wrong / norm) < 3 * 0.002);
  CHECK(std::sqrt(wrong_sigma / norm_sigma) < 3 * 0.002);
  CHECK(t.albedo(0) == Approx(0.65).epsilon(3 * 0.002));
  CHECK(t.sigma_error < 0.002);
  // |cos| in Legendre polynomials to order 6, at the pole: 1/2 + 5/8 - 3/16 + 13/128.
  CHECK(t.intercepted_area({0, 0, 1}) == Approx(1.0390625).epsilon(3 * 0.002));
  CHECK(t.transmittance({0, 0, 1}) < 0.03);  // the hull is the leaf itself
  CHECK(projected_area(t.hull, {0, 0, 1}) == Approx(1.0).epsilon(1e-5));
  CHECK(projected_area(t.hull, {1, 0, 0}) < 1e-5);
}

TEST_CASE("One Lambertian leaf in 66 directions is exact at them", "[original]") {
  const auto t = measure_original(leaf(optics(0.3f, 0.2f, 0.4f)), settings(0.01, 2, TableSettings::Basis::directions), silent());
  const auto& d = octahedron().directions;
  for (std::size_t i = 0; i < 66; ++i) {
    CHECK(t.intercepted[i] == Approx(std::abs(d[i].z)).margin(1e-12));
    CHECK(t.absorbed[i] == Approx(d[i].z > 0 ? 0.3 * d[i].z : -0.4 * d[i].z).margin(1e-6));  // optics in single precision
    for (std::size_t j = 0; j < 66; ++j) {
      const double f = std::max(d[i].z, 0.0), b = std::max(-d[i].z, 0.0), f2 = std::max(d[j].z, 0.0), b2 = std::max(-d[j].z, 0.0);
      const double exact = (0.3 * f * f2 + 0.2 * b * b2 + 0.4 * (f * b2 + b * f2)) / pi;
      // The scaling D S D makes up for the 66 directions' quadrature of the cosine.
      REQUIRE(t.phase[i * 66 + j] == Approx(exact).epsilon(0.03).margin(1e-12));
    }
  }
}

TEST_CASE("Tables conserve energy and are reciprocal within 1e-6", "[original]") {
  const auto geometry = tuft(5, 40, {{"a", {0.1f, 0.5f}, {0.15f, 0.45f}, {0.05f, 0.4f}}, {"wood", {0.2f, 0.4f}, {0.2f, 0.4f}, {0, 0}}});
  for (const std::uint32_t order : {2u, 4u}) {
    const auto t = measure_original(geometry, settings(0.01, order), silent());
    for (std::uint32_t band = 0; band < 2; ++band)
      for (int i = 0; i < 30; ++i) {
        const Vec3 a = direction(i, 30), b = direction((7 * i + 3) % 30, 30);
        const double scattered = intercepted(t, a) - t.absorbed_area(a, band);
        REQUIRE(std::abs(integrated(t, a, band) - scattered) < 1e-6 * t.albedo(band) * t.area_m2);
        REQUIRE(std::abs(t.scattered(a, b, band) - t.scattered(b, a, band)) < 1e-6 * t.area_m2);
      }
    // Before: sampling noise only.
    CHECK(t.errors[1].energy < 0.05);
    CHECK(t.errors[1].reciprocity < 0.05);
  }
  const auto t = measure_original(geometry, settings(0.03, 2, TableSettings::Basis::directions), silent());
  const auto& weights = octahedron().weights;
  for (std::uint32_t band = 0; band < 2; ++band)
    for (std::size_t i = 0; i < 66; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < 66; ++j) {
        sum += weights[j] * t.phase[(band * 66 + i) * 66 + j];
        REQUIRE(t.phase[(band * 66 + i) * 66 + j] == t.phase[(band * 66 + j) * 66 + i]);
      }
      const double scattered = t.intercepted[i] - t.absorbed[band * 66 + i];
      REQUIRE(std::abs(sum - scattered) < 1e-6 * scattered);
    }
}

TEST_CASE("Furnace: leaves that absorb nothing scatter all that they intercept", "[original]") {
  const auto t = measure_original(tuft(6, 60, {optics(0.6f, 0.5f, 0.4f), optics(0.3f, 0.3f, 0.7f)}), settings(0.01), silent());
  // The back of the first material keeps .1; make it white:
  const auto white = measure_original(tuft(6, 60, {optics(0.6f, 0.6f, 0.4f), optics(0.3f, 0.3f, 0.7f)}), settings(0.01), silent());
  CHECK(t.albedo(0) < 0.99);
  CHECK(white.albedo(0) == Approx(1.0).epsilon(1e-6));  // optics in single precision
  for (int i = 0; i < 20; ++i) {
    const Vec3 a = direction(i, 20);
    CHECK(std::abs(integrated(white, a, 0) - intercepted(white, a)) < 1e-6 * white.area_m2);
  }
}

TEST_CASE("What an original absorbs is what path tracing from its facets finds", "[original]") {
  // Dense, so that most light bounces within: 60 leaves in a box, the sphere sky of radiance 1/pi all round.
  const auto geometry = tuft(9, 60, {optics(0.45f, 0.35f, 0.4f), optics(0.4f, 0.4f, 0.0f)});
  const auto t = measure_original(geometry, settings(0.005), silent());
  Mesh mesh;
  for (const auto& c : geometry.corners) {
    const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), c.begin(), c.end());
    mesh.triangles.push_back({v, v + 1, v + 2});
  }
  Scene scene;
  scene.bands = {"NIR"};
  scene.band_units = {"W m^-2"};
  scene.optics = geometry.materials;
  LightState state;
  state.sky.emplace();
  state.sky->model = SkyModel::sphere;
  state.sky->irradiance = {1.0};
  scene.states.push_back(state);
  std::vector<Mesh> organs;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    organs.push_back({{mesh.vertices[3 * i], mesh.vertices[3 * i + 1], mesh.vertices[3 * i + 2]}, {{0, 1, 2}}});
  scene.plants.push_back(plant_entry("tuft", make_plant(organs), 0, {placed({})}));
  scene.plants[0].shape_optics = geometry.optics;
  const auto run = reference_runs::trace(scene, 512);
  double power = 0, variance = 0;
  for (std::size_t f = 0; f < run.facets.size(); ++f) {
    power += run.absorbed(f) * run.facets.area[f];
    variance += std::pow(run.standard_error(f) * run.facets.area[f], 2);
  }
  // Mean of absorbed(a) over directions times 4 pi times 1 / pi.
  const double predicted = 4.0 * (1.0 - t.albedo(0)) * t.intercepted[0] / std::sqrt(4 * pi);
  const double error = std::sqrt(variance) + 0.005 * predicted;
  INFO("scattering " << t.albedo(0) << ", standard error " << error / power);
  CHECK(std::abs(predicted - power) < 3 * error);
  CHECK(error < 0.015 * power);
}

TEST_CASE("Turning, mirroring and scaling tables is measuring the turned, mirrored, scaled original", "[original]") {
  const auto geometry = tuft(7, 25, {optics(0.3f, 0.1f, 0.4f), optics(0.6f, 0.5f, 0.0f)});
  const Mat3 linear = placed({.turn_deg = 35, .scale = 0.02, .tilt_deg = 60, .tilt_azimuth_deg = 130, .mirror = true}).map.linear;
  auto moved = geometry;
  for (auto& t : moved.corners) {
    for (auto& p : t) p = linear * p + Vec3{1, 2, 3};
    std::swap(t[1], t[2]);
  }
  for (const auto basis : {TableSettings::Basis::harmonics, TableSettings::Basis::directions}) {
    const bool harmonic = basis == TableSettings::Basis::harmonics;
    const double error = harmonic ? 0.005 : 0.02;
    const auto turned = transformed(measure_original(geometry, settings(error, 2, basis), silent()), linear);
    const auto measured = measure_original(moved, settings(error, 2, basis), silent());
    CHECK(turned.area_m2 == Approx(measured.area_m2));
    // Two standard errors of each; with the directions also what reading between them blurs [method: 2 to 2.5 %].
    CHECK(phase_difference(turned, measured, 0) < (harmonic ? 4 * error : 4 * error + 0.1));
    for (int i = 0; i < 10; ++i) {
      const Vec3 w = direction(i, 10);
      CHECK(turned.intercepted_area(w) == Approx(measured.intercepted_area(w)).epsilon(8 * error));
      CHECK(projected_area(turned.hull, w) == Approx(projected_area(measured.hull, w)).epsilon(1e-9));
    }
  }
  Mat3 shear{1.0};
  shear[1] += 0.1 * shear[0];
  const auto tables = measure_original(geometry, settings(0.05), silent());
  CHECK_THROWS_WITH(transformed(tables, shear), "a copy that shears or stretches its original: it needs an original of its own");
}

TEST_CASE("Tables do not depend on the number of threads or on where the original stands", "[original]") {
  const auto geometry = tuft(8, 10, {optics(0.4f, 0.4f, 0.4f)});
  OriginalTables a, b;
  tbb::task_arena(1).execute([&] { a = measure_original(geometry, settings(0.03), silent()); });
  tbb::task_arena(2).execute([&] { b = measure_original(geometry, settings(0.03), silent()); });
  CHECK(a.phase == b.phase);
  CHECK(a.absorbed == b.absorbed);
  auto far = geometry;
  for (auto& t : far.corners)
    for (auto& p : t) p += Vec3{1e6, 1e6, 0};
  const auto c = measure_original(far, settings(0.03), silent());
  CHECK(phase_difference(a, c, 0) < 0.01);  // coordinates of 1e6 m are known to 1e-10 m; a few rays at edges change
  for (const double scale : {1e-6, 1e6}) {
    auto scaled = geometry;
    for (auto& t : scaled.corners)
      for (auto& p : t) p *= scale;
    auto d = measure_original(scaled, settings(0.03), silent());
    for (auto& v : d.phase) v /= scale * scale;
    CHECK(phase_difference(a, d, 0) < 0.01);
  }
}
