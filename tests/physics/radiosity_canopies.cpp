// Radiosity: random canopies against Beer-Lambert and the turbid layer.
#include <catch2/catch.hpp>

#include <numbers>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

/// Leaf angles: spherical; or densities per zenith angle of the normal 2/pi (1 +- cos 2 theta) (de Wit 1965).
enum class Angles { uniform, planophile, erectophile };

double normal_zenith(Angles angles, RandomStream& random) {
  if (angles == Angles::uniform) return std::acos(random.next());
  const double sign = angles == Angles::planophile ? 1 : -1;
  for (;;) {
    const double theta = 0.5 * std::numbers::pi * random.next();
    if (2 * random.next() < 1 + sign * std::cos(2 * theta)) return theta;
  }
}

/// Square leaves in a periodic column of height 1, one organ each. They keep within it: centres are even between side / 2 and 1 - side / 2.
std::vector<Mesh> canopy(double leaf_area_index, double side, double width, Angles angles, std::uint64_t seed) {
  RandomStream random(mix(seed, 77));
  std::vector<Mesh> out;
  const auto n = static_cast<int>(std::lround(leaf_area_index * width * width / (side * side)));
  const double margin = side / std::numbers::sqrt2;
  for (int i = 0; i < n; ++i) {
    const Vec3 c{random.next() * width, random.next() * width, margin + random.next() * (1 - 2 * margin)};
    const double theta = normal_zenith(angles, random), azimuth = 2 * std::numbers::pi * random.next(),
                 turn = 2 * std::numbers::pi * random.next();
    Vec3 u, v;
    orthonormal_frame({std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)}, u, v);
    const Vec3 a = 0.5 * side * (std::cos(turn) * u + std::sin(turn) * v), b = 0.5 * side * (std::cos(turn) * v - std::sin(turn) * u);
    out.push_back({{c - a - b, c + a - b, c + a + b, c - a + b}, {{0, 1, 2}, {0, 2, 3}}});
  }
  return out;
}

Scene canopy_scene(std::vector<Mesh> leaves_of, double width, std::vector<Optics> leaf, const std::vector<double>& soil) {
  auto scene = scene_with(std::vector<std::string>(soil.size(), "band"), std::move(leaf));
  for (std::size_t b = 0; b < soil.size(); ++b) scene.bands[b] += std::to_string(b);
  scene.periodic = PeriodicCell{0, 0, width, width};
  scene.ground = flat_ground({width, width}, {0.5 * width, 0.5 * width}, {4, 4}, soil);
  add(scene, "canopy", std::move(leaves_of), 0);
  return scene;
}

/// A state that gives 1 W m^-2 on the horizontal: beam from a zenith angle, or the uniform sky for -1.
LightState unit_light(double zenith_deg, double azimuth_deg, std::size_t bands) {
  LightState state;
  if (zenith_deg < 0) {
    state.sky.emplace();
    state.sky->irradiance.assign(bands, 1.0);
  } else {
    const double z = zenith_deg * std::numbers::pi / 180;
    state.sun = Sun{direction_from_angles(90 - zenith_deg, azimuth_deg), std::vector<double>(bands, 1 / std::cos(z)), 0};
  }
  return state;
}

double ground_irradiance(const Run& run, std::size_t band, std::size_t state) {
  double power = 0, area = 0;
  for (std::size_t f = run.facets.plant_facets; f < run.facets.size(); ++f) {
    power += run.facets.area[f] * run.kept.on(f, 0, band, state);
    area += run.facets.area[f];
  }
  return power / area;
}

struct Mean {
  double sum = 0, square = 0;
  int n = 0;
  void add(double x) { sum += x, square += x * x, ++n; }
  double mean() const { return sum / n; }
  double standard_error() const { return std::sqrt(std::max(0.0, square / n - mean() * mean()) / (n - 1)); }
};

/// Mean transmission of a beam by n black leaves placed and turned independently in a cell: each stops it with a probability of
/// a G / (A cos z), so Beer-Lambert's exponential becomes this power, for leaves of any size.
double transmission(double leaf_area_index, double leaf_over_cell, double cosine) {
  const double stop = std::min(1.0, 0.5 * leaf_over_cell / cosine);
  return std::pow(1 - stop, leaf_area_index / leaf_over_cell);
}
double diffuse_transmission(double leaf_area_index, double leaf_over_cell) {
  constexpr int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += 2 * (i + 0.5) / steps * transmission(leaf_area_index, leaf_over_cell, (i + 0.5) / steps) / steps;
  return sum;
}

}  // namespace

TEST_CASE("radiosity: black leaves of all angles transmit as Beer and Lambert say") {
  // closed forms of the mean over canopies tend to the exponential as leaves get small
  CHECK(transmission(2, 1e-7, 0.5) == Approx(std::exp(-2.0)).epsilon(1e-6));
  const double diffuse[] = {0.443209, 0.219384, 0.113479, 0.032591}, index[] = {1, 2, 3, 5};
  for (int i = 0; i < 4; ++i) CHECK(diffuse_transmission(index[i], 1e-7) == Approx(diffuse[i]).margin(2e-6));

  constexpr double side = 0.04, width = 0.8, zeniths[] = {0, 30, 60, 75, -1};
  constexpr int canopies = 24;
  double z2 = 0;
  int tests = 0;
  for (const double leaf_area_index : {1.0, 2.0, 3.0, 5.0}) {
    std::vector<Mean> seen(std::size(zeniths));
    for (int k = 0; k < canopies; ++k) {
      auto scene = canopy_scene(canopy(leaf_area_index, side, width, Angles::uniform, static_cast<std::uint64_t>(k)), width,
                                {uniform_optics("leaf", {0}, {0})}, {0});
      scene.states.clear();
      for (const double zenith : zeniths) scene.states.push_back(unit_light(zenith, 40.0 * k, 1));
      const auto method = k % 2 ? RadiosityMethod::flat : RadiosityMethod::clustering;  // both give direct light alike
      const auto run = solve(scene, method, Quality::draft, static_cast<std::uint64_t>(k));
      for (std::size_t s = 0; s < std::size(zeniths); ++s) {
        seen[s].add(ground_irradiance(run, 0, s));
        // what leaves do not absorb reaches the black soil, nothing comes back
        const auto& balance = run.report.balance[s][0];
        CHECK(
            balance.leaves ==
            Approx(width * width * (1 - ground_irradiance(run, 0, s))).epsilon(1e-3));  // a low sun: full cells cannot take the last .0002
        CHECK(balance.escaped == 0.0);
      }
    }
    for (std::size_t s = 0; s < std::size(zeniths); ++s) {
      const double over_cell = side * side / (width * width);
      const double expected = zeniths[s] < 0 ? diffuse_transmission(leaf_area_index, over_cell)
                                             : transmission(leaf_area_index, over_cell, std::cos(zeniths[s] * std::numbers::pi / 180));
      const double error = seen[s].mean() - expected;
      CAPTURE(leaf_area_index, zeniths[s], expected, seen[s].mean(), seen[s].standard_error());
      CHECK(std::abs(error) < 4 * seen[s].standard_error());  // t with 23 degrees of freedom: 1 in 2000, 20 of them
      CHECK(seen[s].standard_error() < 0.02 * expected + 0.002);
      z2 += error * error / (seen[s].standard_error() * seen[s].standard_error());
      ++tests;
    }
  }
  CHECK(z2 / tests < 2.2);  // 20 values, some correlated
}

namespace {

struct LayerRow {
  Angles angles;
  int optics;
  double zenith, reflected, transmitted, absorbed;
};
// Reflectance and transmittance of leaves, reflectance of soil; LAI 3. Exact discrete ordinates for infinitely small leaves (adding
// and doubling, stable to 1e-6), checked against an unrelated Monte Carlo to 4e-4.
constexpr double layer_rho[] = {0.0546, 0.4957}, layer_tau[] = {0.0149, 0.4409}, layer_soil[] = {0.127, 0.159};
const LayerRow layer_rows[] = {
    {Angles::uniform, 0, 20, 0.019702, 0.206886, 0.799687},     {Angles::uniform, 1, 20, 0.413188, 0.505301, 0.161854},
    {Angles::uniform, 0, 50, 0.019903, 0.101386, 0.891587},     {Angles::uniform, 1, 50, 0.479850, 0.404813, 0.179702},
    {Angles::uniform, 0, -1, 0.020532, 0.117672, 0.876741},     {Angles::uniform, 1, -1, 0.480982, 0.409317, 0.174782},
    {Angles::planophile, 0, 20, 0.025011, 0.081372, 0.903952},  {Angles::planophile, 1, 20, 0.504684, 0.382175, 0.173907},
    {Angles::planophile, 0, 50, 0.025088, 0.073496, 0.910750},  {Angles::planophile, 1, 50, 0.511369, 0.372859, 0.175057},
    {Angles::planophile, 0, -1, 0.025329, 0.066919, 0.916251},  {Angles::planophile, 1, -1, 0.520561, 0.361628, 0.175309},
    {Angles::erectophile, 0, 20, 0.018750, 0.252269, 0.761019}, {Angles::erectophile, 1, 20, 0.386587, 0.542655, 0.157040},
    {Angles::erectophile, 0, 50, 0.018779, 0.106597, 0.888162}, {Angles::erectophile, 1, 50, 0.473758, 0.409556, 0.181805},
    {Angles::erectophile, 0, -1, 0.019567, 0.134628, 0.862903}, {Angles::erectophile, 1, -1, 0.469937, 0.422769, 0.174514},
};
constexpr double layer_zeniths[] = {20, 50, -1};

struct LayerMean {
  Mean reflected, transmitted, absorbed;
};
/// [zenith][optics] over canopies of leaves of this side.
std::vector<std::vector<LayerMean>> layer_means(Angles angles, double side, double width, int canopies, RadiosityMethod method) {
  std::vector<std::vector<LayerMean>> means(std::size(layer_zeniths), std::vector<LayerMean>(2));
  const std::vector<double> rho(layer_rho, layer_rho + 2), tau(layer_tau, layer_tau + 2), soil(layer_soil, layer_soil + 2);
  for (int k = 0; k < canopies; ++k) {
    auto scene =
        canopy_scene(canopy(3, side, width, angles, static_cast<std::uint64_t>(k)), width, {uniform_optics("leaf", rho, tau)}, soil);
    scene.states.clear();
    for (const double zenith : layer_zeniths) scene.states.push_back(unit_light(zenith, 137.5 * k, 2));
    const auto run = solve(scene, method, Quality::draft, static_cast<std::uint64_t>(k));
    const double area = width * width;
    for (std::size_t s = 0; s < std::size(layer_zeniths); ++s)
      for (std::size_t b = 0; b < 2; ++b) {
        const auto& balance = run.report.balance[s][b];
        means[s][b].reflected.add(balance.escaped / area);
        means[s][b].transmitted.add(ground_irradiance(run, b, s));
        means[s][b].absorbed.add(balance.leaves / area);
      }
  }
  return means;
}

/// Squared error of all rows of these angles, summed, and their number.
void add_squares(Angles angles, const std::vector<std::vector<LayerMean>>& means, double& sum, int& n) {
  for (const auto& row : layer_rows)
    for (std::size_t s = 0; s < std::size(layer_zeniths); ++s) {
      if (row.angles != angles || row.zenith != layer_zeniths[s]) continue;
      const auto& m = means[s][static_cast<std::size_t>(row.optics)];
      for (const double d :
           {m.reflected.mean() - row.reflected, m.transmitted.mean() - row.transmitted, m.absorbed.mean() - row.absorbed}) {
        sum += d * d;
        ++n;
      }
    }
}

double worst_error(Angles angles, const std::vector<std::vector<LayerMean>>& means) {
  double worst = 0;
  for (const auto& row : layer_rows)
    for (std::size_t s = 0; s < std::size(layer_zeniths); ++s) {
      if (row.angles != angles || row.zenith != layer_zeniths[s]) continue;
      const auto& m = means[s][static_cast<std::size_t>(row.optics)];
      worst = std::max({worst, std::abs(m.reflected.mean() - row.reflected), std::abs(m.transmitted.mean() - row.transmitted),
                        std::abs(m.absorbed.mean() - row.absorbed)});
    }
  return worst;
}

}  // namespace

TEST_CASE("radiosity: a layer of small leaves is nearly turbid") {
  // Means of 8 canopies of leaves 1/50 of the height, in fractions of the incident light: their size tells by .001 to .002 (under the
  // sky, where canopies scatter little), and canopies scatter by up to .0025 (standard error of T under the sun).
  for (const auto angles : {Angles::uniform, Angles::planophile, Angles::erectophile})
    for (const auto method : both_methods) {
      const auto means = layer_means(angles, 0.02, 0.4, 8, method);
      CAPTURE(static_cast<int>(angles), name_of(method));
      CHECK(worst_error(angles, means) < 0.01);
    }
}

TEST_CASE("radiosity: a layer comes the closer to a turbid one the smaller its leaves are") {
  // Means of 8 canopies of leaves 1/6, 1/16 and 1/50 of the height, in cells 20 leaves wide: as many leaves, and so as much chance, in
  // each. Over 18 rows of three figures, the root of the mean square tells the size of the leaves apart from chance.
  std::vector<double> error;
  for (const double side : {1.0 / 6, 1.0 / 16, 1.0 / 50}) {
    double sum = 0;
    int n = 0;
    for (const auto angles : {Angles::uniform, Angles::planophile, Angles::erectophile})
      add_squares(angles, layer_means(angles, side, 20 * side, 8, RadiosityMethod::clustering), sum, n);
    REQUIRE(n == 54);
    error.push_back(std::sqrt(sum / n));
  }
  CAPTURE(error[0], error[1], error[2]);
  CHECK(error[1] < 0.8 * error[0]);
  CHECK(error[2] < 0.8 * error[1]);
  CHECK(error[2] < 0.003);
}
