// What a quality aims at, and when a certificate contradicts it.
#include <catch2/catch.hpp>

#include <sunfleck/audit/verdict.hpp>
#include <sunfleck/scene/build.hpp>

#include "places.hpp"
#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

Certificate certificate(std::vector<double> rmse, std::vector<double> low, std::vector<double> bias, std::vector<double> bias_error) {
  Certificate c;
  c.rmse = std::move(rmse), c.rmse_low = std::move(low), c.bias = std::move(bias), c.bias_standard_error = std::move(bias_error);
  c.rmse_high = c.rmse;
  return c;
}

}  // namespace

TEST_CASE("aims by fineness and by how strongly a band scatters", "[audit][verdict]") {
  CHECK(aimed_error(0, 0.15) == 0.04);
  CHECK(aimed_error(1, 0.15) == 0.01);
  CHECK(aimed_error(2, 0.15) == Approx(0.007));
  CHECK(aimed_error(0, 0.85) == 0.06);
  CHECK(aimed_error(1, 0.85) == 0.02);
  CHECK(aimed_error(2, 0.85) == Approx(0.012));
  CHECK(aimed_error(3, 0.85) == Approx(0.012));
  CHECK(aimed_error(0.5, 0.15) == Approx(0.02));
}

TEST_CASE("aims go by the optics of what is certified, not by the bands' names", "[audit][verdict]") {
  auto scene = scene_with({"800", "red"}, {uniform_optics("leaf", {0.45, 0.09}, {0.4, 0.05}), uniform_optics("wall", {0.0, 0.9}, {0, 0})});
  add(scene, "leaves", leaves(20, 0.1, {1, 1, 1}, 1), 0);
  add(scene, "walls", leaves(20, 0.1, {1, 1, 1}, 2), 1);
  const auto placed = place(scene);
  const FacetRows rows(scene, placed);
  const std::vector<ChosenOrgan> leaf{{0, 1.0, 1.0, true}},
      mostly_wall{{0, 0.2, 1.0, true}, {placed.copies[1].first_organ, 0.8, 1.0, true}};
  CHECK(aimed_errors(rows, leaf, 1.0) == std::vector<double>{0.02, 0.01});
  CHECK(aimed_errors(rows, mostly_wall, 1.0) == std::vector<double>{0.01, 0.02});
}

TEST_CASE("a certificate contradicts where chance does not explain more than three times the aim", "[audit][verdict]") {
  const std::vector<double> aims{0.01, 0.02};
  CHECK_FALSE(contradiction(certificate({0.05, 0.05}, {0.029, 0.05}, {0, 0}, {0.01, 0.01}), aims));
  const auto rms = contradiction(certificate({0.05, 0.2}, {0.031, 0.15}, {0, 0}, {0.01, 0.01}), aims);
  REQUIRE(rms);
  CHECK(rms->band == 1);
  CHECK_FALSE(rms->bias);
  CHECK(rms->found == 0.2);
  CHECK(rms->at_least == 0.15);
  CHECK(rms->aim == 0.02);
  const auto bias = contradiction(certificate({0.05, 0.05}, {0.0, 0.0}, {-0.05, 0.05}, {0.005, 0.005}), aims);
  REQUIRE(bias);
  CHECK(bias->band == 0);
  CHECK(bias->bias);
  CHECK_FALSE(contradiction(certificate({0.05, 0.05}, {0.0, 0.0}, {-0.05, 0.05}, {0.01, 0.01}), aims));
  CHECK_FALSE(contradiction(certificate({0.9, 0.9}, {0.9, 0.9}, {0, 0}, {}), {0.0, 0.0}));  // nothing is asked
}
