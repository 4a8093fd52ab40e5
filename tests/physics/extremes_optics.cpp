// Extremes of optics: a leaf plane over soil has a closed form for any of them.
#include <catch2/catch.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

struct Case {
  const char* name;
  double front, back, through, soil;
};

// rho of both sides, tau, and the soil's rho
const Case cases[] = {
    {"black", 0, 0, 0, 0},
    {"black over white soil", 0, 0, 0, 1},
    {"rho = tau", 0.5, 0.5, 0.5, 0.2},
    {"rho = tau, white soil", 0.5, 0.5, 0.5, 1},
    {"all is let through", 0, 0, 1, 0.3},
    {"all is let through, white soil", 0, 0, 1, 1},
    {"opaque and white", 1, 1, 0, 0.5},
    {"opaque and white over white soil", 1, 1, 0, 1},
    {"opaque", 0.4, 0.4, 0, 0.2},
    {"sides differ", 0.1, 0.6, 0.3, 0.2},
    {"black above, white below", 0, 1, 0, 0.9},
    {"white above, black below", 1, 0, 0, 0.9},
    {"nearly white", 0.5, 0.5, 0.5 - 1e-6, 1 - 1e-6},
};

}  // namespace

TEST_CASE("extremes: a leaf plane of any optics over soil of any", "[extremes]") {
  // With 1 W m^-2 from above: on the soil E_s = tau / (1 - back soil), below the plane soil E_s. Where back = soil = 1 no light gets
  // between (tau = 0) and 0/0 is 0: nothing shines there.
  for (const auto& c : cases)
    for (const auto method : both_methods)
      for (const bool sun : {false, true}) {
        auto scene =
            scene_with({"a"}, {{"leaf", {static_cast<float>(c.front)}, {static_cast<float>(c.back)}, {static_cast<float>(c.through)}}});
        scene.periodic = PeriodicCell{0, 0, 1, 1};
        scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {2, 2}, {c.soil});
        if (sun)
          point_sun(scene, {0, 0, 1}, 1);
        else
          sky(scene, SkyModel::uniform, 1);
        add(scene, "plane", {square(0.2)}, 0);
        const auto run = solve(scene, method, Quality::draft);
        CAPTURE(c.name, name_of(method), sun);
        CHECK(run.report.status == SolveStatus::converged);
        const double on_soil = c.through > 0 ? c.through / (1 - c.back * c.soil) : 0.0, below = c.soil * on_soil;
        // counts decide, not samples: single precision and the residual of 1e-5 are left, which the trapped light makes larger
        const double tolerance = 3e-5 / (1 - c.back * c.soil + 1e-9);
        const auto near = [&](double value) { return Approx(value).epsilon(std::min(tolerance, 1e-3)).margin(1e-6); };
        for (const std::size_t f : {0, 1}) {
          CHECK(run.kept.on(f, 0) == near(1));
          CHECK(run.kept.on(f, 1) == near(below));
          CHECK(run.absorbed(f) == near((1 - c.front - c.through) + (1 - c.back - c.through) * below));
        }
        for (std::size_t f = 2; f < run.facets.size(); ++f) CHECK(run.kept.on(f, 0) == near(on_soil));
        const auto& b = run.report.balance[0][0];
        CHECK(b.incident == near(1));
        // the sun's first reflection goes line by line, and the lines of draft sample areas to some thousandths
        CHECK(b.escaped == Approx(c.front + c.through * below).epsilon(sun ? 5e-3 : std::min(tolerance, 1e-3)).margin(1e-6));
        CHECK(std::abs(b.residual()) < (sun ? 5e-3 : 1e-3));
      }
}

TEST_CASE("extremes: two hundred bands at once, each as if it were alone", "[extremes]") {
  constexpr std::size_t bands = 200;
  std::vector<std::string> names;
  std::vector<double> rho, tau, soil;
  for (std::size_t b = 0; b < bands; ++b) {
    names.push_back("band " + std::to_string(b));
    rho.push_back(0.5 * static_cast<double>(b) / bands);
    tau.push_back(0.45 * static_cast<double>(b) / bands);
    soil.push_back(0.3);
  }
  const auto scene_of = [&](std::size_t first, std::size_t count) {
    const auto part = [&](const auto& all) {
      return std::vector(all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(first + count));
    };
    auto scene = scene_with(part(names), {uniform_optics("leaf", part(rho), part(tau))});
    scene.periodic = PeriodicCell{0, 0, 1, 1};
    scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {3, 3}, part(soil));
    sky(scene, SkyModel::uniform, 100);
    point_sun(scene, {0.3, 0.2, 0.8}, 500);
    add(scene, "canopy", leaves(60, 0.15, {1, 1, 0.6}, 9), 0);
    return scene;
  };
  const auto settings = settings_of(RadiosityMethod::flat, Quality::draft);
  const auto all = solve(scene_of(0, bands), settings);
  CHECK(all.report.status == SolveStatus::converged);
  REQUIRE(all.report.spectral_radius.size() == bands);
  for (const std::size_t b : {std::size_t{0}, std::size_t{1}, bands / 2, bands - 1}) {
    const auto alone = solve(scene_of(b, 1), settings);
    CAPTURE(b);
    CHECK(relative_rms(organ_power(all, b), organ_power(alone)) < 1e-4);  // each stops at its own residual of 1e-5 or below
  }
}
