// Intensities of photometric files: normalisation, interpolation, symmetry.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/light/photometry.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/lamp.hpp>

using namespace sunfleck;

namespace {

constexpr double pi = std::numbers::pi;

Photometry made(std::vector<double> vertical, std::vector<double> horizontal, std::vector<double> candela) {
  Photometry p;
  p.vertical_deg = std::move(vertical);
  p.horizontal_deg = std::move(horizontal);
  p.candela = std::move(candela);
  prepare_photometry(p, "photometry");
  return p;
}

Vec3 towards(double vertical_deg, double horizontal_deg) {
  const double t = vertical_deg * pi / 180, h = horizontal_deg * pi / 180;
  return {std::sin(t) * std::cos(h), std::sin(t) * std::sin(h), -std::cos(t)};
}

/// Integral over the sphere by quasi-random directions.
double integral(const Photometry& p) {
  double sum = 0;
  constexpr int n = 1 << 16;
  for (int i = 0; i < n; ++i) {
    const auto x = r2_point(static_cast<std::uint64_t>(i), 0.5, 0.5);
    const double z = 2 * x[0] - 1, r = std::sqrt(1 - z * z);
    sum += p.intensity({r * std::cos(2 * pi * x[1]), r * std::sin(2 * pi * x[1]), z});
  }
  return 4 * pi * sum / n;
}

}  // namespace

TEST_CASE("Equal intensities all round are 1 / 4 pi", "[light][photometry]") {
  const auto p = made({0, 90, 180}, {0}, {7, 7, 7});
  for (const auto& d : {towards(0, 0), towards(77, 200), towards(180, 0)}) CHECK(p.intensity(d) == Approx(1 / (4 * pi)));
}

TEST_CASE("A Lambertian table comes near cos / pi", "[light][photometry]") {
  std::vector<double> angles, values;
  for (int a = 0; a <= 90; ++a) angles.push_back(a), values.push_back(std::cos(a * pi / 180));
  const auto p = made(angles, {0}, values);
  for (const double a : {0.0, 30.5, 60.0, 89.0})
    CHECK(p.intensity(towards(a, 10)) == Approx(std::cos(a * pi / 180) / pi).epsilon(1e-3).margin(1e-5));
  CHECK(p.intensity(towards(91, 0)) == 0.0);  // beyond the table there is no light
}

TEST_CASE("Every symmetry integrates to one and mirrors as it should", "[light][photometry]") {
  const std::vector<double> vertical{0, 60, 120};
  const auto quadrant = made(vertical, {0, 45, 90}, {3, 2, 0, 3, 4, 1, 3, 1, 0});
  CHECK(integral(quadrant) == Approx(1).epsilon(1e-3));
  for (const double h : {20.0, 160.0, 200.0, 340.0})
    CHECK(quadrant.intensity(towards(50, h)) == Approx(quadrant.intensity(towards(50, 20))));
  const auto half = made(vertical, {0, 90, 180}, {3, 2, 0, 3, 4, 1, 3, 1, 0});
  CHECK(integral(half) == Approx(1).epsilon(1e-3));
  CHECK(half.intensity(towards(50, 130)) == Approx(half.intensity(towards(50, 230))));
  CHECK(half.intensity(towards(60, 0)) == Approx(2 * half.intensity(towards(60, 180))));
  const auto other = made(vertical, {90, 180, 270}, {3, 2, 0, 3, 4, 1, 3, 1, 0});
  CHECK(integral(other) == Approx(1).epsilon(1e-3));
  CHECK(other.intensity(towards(50, 40)) == Approx(other.intensity(towards(50, 140))));
  CHECK(other.intensity(towards(50, 320)) == Approx(other.intensity(towards(50, 220))));
  const auto full = made(vertical, {0, 90, 180, 270, 360}, {3, 2, 0, 3, 4, 1, 3, 1, 0, 3, 6, 2, 3, 2, 0});
  CHECK(integral(full) == Approx(1).epsilon(1e-3));
  CHECK(full.intensity(towards(60, 270)) == Approx(6.0 / 4.0 * full.intensity(towards(60, 90))));
  CHECK(full.intensity(towards(60, 45)) == Approx(3 * full.per_candela));
}

TEST_CASE("Emission draws the power that the lamps have", "[light][lamps]") {
  Scene scene;
  scene.bands = {"PAR"};
  scene.states.resize(1);
  LampEntry panel, bulb;
  panel.mesh = Mesh{{{0, 0, 1}, {0, 1, 1}, {2, 0, 1}}, {{0, 1, 2}}};  // 1 m2
  panel.strength = {3.0};
  panel.placements = {placed({}), placed({.position = {0, 0, 1}, .scale = 2})};  // 1 and 4 m2
  bulb.photometry = std::make_shared<const Photometry>(made({0, 90}, {0}, {1, 0}));
  bulb.by_power = true;
  bulb.strength = {5.0};
  bulb.placements = {placed({.tilt_deg = 90})};  // its nadir points to the side
  scene.lamps = {panel, bulb};
  const Lamps lamps = place_lamps(scene);
  CHECK(lamps.units[0].power[0] == Approx(3));
  CHECK(lamps.units[1].power[0] == Approx(12));
  const LampEmission emission(lamps);
  CHECK(emission.power() == Approx(1));  // the shares of one band
  double power[3] = {0, 0, 0};
  Vec3 mean{0.0};
  constexpr std::uint32_t n = 1 << 16;
  for (std::uint32_t i = 0; i < n; ++i) {
    double x[5];
    for (unsigned k = 0; k < 5; ++k) x[k] = sobol_owen(i, k, 1);
    const auto particle = emission.draw(x);
    const double w = particle.weight * lamps.units[particle.unit].power[0] / n;
    power[particle.unit] += w;
    if (particle.unit == 2) mean += w * particle.direction;
    if (particle.unit < 2) CHECK_FALSE(particle.direction.z > 0.0);
  }
  CHECK(power[0] == Approx(3).epsilon(0.002));
  CHECK(power[1] == Approx(12).epsilon(0.002));
  CHECK(power[2] == Approx(5).epsilon(0.01));
  CHECK(std::abs(mean.z) < 0.05);  // the beam lies level
  CHECK(glm::length(mean) > 3.0);
}
