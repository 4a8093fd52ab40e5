// View factors by the path tracer: a plate that lets the sun's light through emits evenly on its back; what a black plate receives from
// it, over the emitted, is the view factor. Closed forms: Howell's catalogue C-11 and C-14.
#include <catch2/catch.hpp>

#include <cmath>

#include "reference_runs.hpp"

using namespace sunfleck;
using namespace reference_runs;

namespace {

/// Irradiance of the front of a black plate over the exitance of a plate [0, a] x [0, b] at height z lit by the sun overhead.
struct Received {
  double factor = 0, standard_error = 0;
};
Received from_plate(double a, double b, double z, const Mesh& plate) {
  auto scene = scene_with({"PAR"}, {uniform_optics("lamp", {0.0}, {0.5}), uniform_optics("black", {0.0}, {0.0})});
  point_sun(scene, {0, 0, 1}, 2);  // emits 1
  add(scene, "lamp", {Mesh{{{0, 0, z}, {a, 0, z}, {a, b, z}, {0, b, z}}, {{0, 1, 2}, {0, 2, 3}}}}, 0);
  add(scene, "plate", {plate}, 1);
  const auto run = trace(scene, 32768);
  Received out;
  double area = 0;
  for (std::size_t f = 2; f < run.facets.size(); ++f) {
    const double w = run.facets.area[f];
    area += w;
    out.factor += w * run.kept.on(f, 0);
    out.standard_error += w * w * run.kept.variance_of(f);
  }
  out.factor /= area;
  out.standard_error = std::sqrt(out.standard_error) / area;
  return out;
}

Mesh rectangle(double a, double b) {
  return {{{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

}  // namespace

TEST_CASE("reference: view factors of facing and of joined rectangles") {
  const auto check = [](const Received& r, double expected) {
    CAPTURE(r.factor, r.standard_error, expected);
    CHECK(std::abs(r.factor - expected) < 5 * r.standard_error);
    CHECK(r.standard_error < 0.003 * expected);
  };
  check(from_plate(1, 1, 1, rectangle(1, 1)), 0.19982490);
  check(from_plate(1, 2, 0.5, rectangle(1, 2)), 0.50898867);
  check(from_plate(1, 1, 0.1, rectangle(1, 1)), 0.82699452);
  // upright below an edge of the emitter, front towards it
  check(from_plate(1, 1, 0, Mesh{{{0, 0, 0}, {0, 0, -1}, {0, 1, -1}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}), 0.20004378);
}

TEST_CASE("reference: a plate sees nothing through another that hides all of it") {
  auto scene = scene_with({"PAR"}, {uniform_optics("lamp", {0.0}, {0.5}), uniform_optics("black", {0.0}, {0.0})});
  point_sun(scene, {0, 0, 1}, 2);
  add(scene, "lamp", {square(1)}, 0);
  add(scene, "screen", {Mesh{{{-9, -9, 0.5}, {9, -9, 0.5}, {9, 9, 0.5}, {-9, 9, 0.5}}, {{0, 1, 2}, {0, 2, 3}}}}, 1);
  add(scene, "plate", {square(0)}, 1);
  const auto run = trace(scene, 1024);
  for (std::size_t f = 4; f < 6; ++f) CHECK(run.kept.on(f, 0) == 0.0);
}
