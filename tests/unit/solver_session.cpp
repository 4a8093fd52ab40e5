// Sessions: what is reused, and that results do not depend on it.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>

#include <sunfleck/core/error.hpp>
#include <sunfleck/solver/session.hpp>

#include "radiosity_runs.hpp"
#include "scratch_folder.hpp"

using namespace sunfleck;
using radiosity_runs::leaves;

namespace {

/// Two kinds of crowns, several copies each, on open ground.
Scene stand() {
  auto scene = reference_runs::scene_with({"PAR", "NIR"}, {uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40})});
  scene.ground = flat_ground({6, 6}, {2, 2}, {3, 3}, {0.12, 0.2});
  reference_runs::sky(scene, SkyModel::standard_overcast, 100);
  scene.states[0].sun = Sun{glm::normalize(Vec3{0.5, 0.1, 0.8}), {400, 400}, 0.53};
  reference_runs::add(scene, "small", leaves(60, 0.12, {0.8, 0.8, 0.8}, 3), 0);
  reference_runs::add(scene, "large", leaves(90, 0.15, {1, 1, 1.5}, 4), 0);
  scene.plants[0].placements.push_back({Affine::translate({2, 0, 0})});
  scene.plants[1].placements = {{Affine::translate({0, 2, 0})}, {Affine::translate({2, 2.5, 0})}};
  return scene;
}

RunSettings quick() {
  RunSettings run;
  run.method = "instantiation";
  run.quality = Quality::draft;
  run.certificate = false;
  return run;
}

std::uint64_t count(const std::vector<std::pair<std::string, std::uint64_t>>& list, const std::string& name) {
  for (const auto& [n, value] : list)
    if (n == name) return value;
  return 0;
}

/// Of a session that has solved nothing else.
Solution fresh(const Scene& scene, const RunSettings& run = quick()) {
  return Session(run).solve(scene);
}

}  // namespace

TEST_CASE("session: the same scene gives the same solution again", "[solver][session]") {
  Session session(quick());
  const auto first = session.solve(stand());
  CHECK_FALSE(session.reused().everything);
  CHECK(count(session.reused().made, "operators") == 4);  // two originals, coarse and fine
  const auto second = session.solve(stand());
  CHECK(session.reused().everything);
  CHECK(session.reused().saved_seconds > 0);
  CHECK(second.facets.irradiance == first.facets.irradiance);
  session.run.seed = 2;
  CHECK(session.solve(stand()).facets.irradiance != first.facets.irradiance);
  CHECK_FALSE(session.reused().everything);
}

TEST_CASE("session: changed light reuses all operators, moved plants their insides, to the bit", "[solver][session]") {
  Session session(quick());
  auto scene = stand();
  session.solve(scene);
  scene.states[0].sun->direction = glm::normalize(Vec3{-0.6, 0.3, 0.4});
  scene.states[0].sky->model = SkyModel::uniform;
  scene.states.push_back(scene.states[0]);
  scene.states[1].sun.reset();
  const auto lit = session.solve(scene);
  CHECK(session.reused().geometry);
  CHECK(count(session.reused().reused, "operators") == 4);
  CHECK(session.reused().made.empty());
  CHECK(lit.facets.irradiance == fresh(scene).facets.irradiance);

  scene.plants[0].placements[1].map = Affine::translate({2.2, -0.4, 0.1}) * Affine::turn(1.0);
  scene.plants[1].placements.push_back({Affine::translate({4, 0, 0})});
  const auto moved = session.solve(scene);
  CHECK_FALSE(session.reused().geometry);
  CHECK(count(session.reused().reused, "operators") == 4);
  CHECK(moved.facets.irradiance == fresh(scene).facets.irradiance);
}

TEST_CASE("session: a plant that grew is traced again, the other is not", "[solver][session]") {
  Session session(quick());
  auto scene = stand();
  session.solve(scene);
  scene.plants[1].plant = std::make_shared<const Plant>(make_plant(leaves(91, 0.15, {1, 1, 1.5}, 4), "large"));
  scene.plants[1].shape_optics.assign(91, 0);
  const auto grown = session.solve(scene);
  CHECK(count(session.reused().reused, "operators") == 2);
  CHECK(count(session.reused().made, "operators") == 2);
  CHECK(grown.facets.irradiance == fresh(scene).facets.irradiance);
  scene.optics[0].transmittance[1] = 0.3f;  // other optics, other shades
  session.solve(scene);
  CHECK(count(session.reused().reused, "operators") == 0);
}

TEST_CASE("session: operators on disk serve a later session, and damaged ones are made anew", "[solver][session]") {
  const ScratchFolder folder;
  const auto scene = stand();
  Solution first;
  {
    Session session(quick(), {std::uint64_t{1} << 28, folder.path});
    first = session.solve(scene);
  }
  {
    Session session(quick(), {std::uint64_t{1} << 28, folder.path});
    CHECK(session.solve(scene).facets.irradiance == first.facets.irradiance);
    CHECK(count(session.reused().reused, "operators_read") == 4);
    CHECK(session.reused().saved_seconds > 0);
  }
  int damaged = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path))
    if (damaged++ % 2 == 0) std::filesystem::resize_file(entry.path(), std::filesystem::file_size(entry.path()) / 2);
  Session session(quick(), {std::uint64_t{1} << 28, folder.path});
  CHECK(session.solve(scene).facets.irradiance == first.facets.irradiance);
  CHECK(count(session.reused().reused, "operators_read") == 2);
  CHECK(count(session.reused().made, "operators") == 2);
}

TEST_CASE("session: a store too small holds what it can, and results are the same", "[solver][session]") {
  const auto scene = stand();
  Session small(quick(), {200'000, {}});
  small.solve(scene);
  auto other = scene;
  other.states[0].sun.reset();
  const auto solved = small.solve(other);
  const auto reference = fresh(other);
  REQUIRE(solved.facets.irradiance.size() == reference.facets.irradiance.size());
  double worst = 0, mean = 0;  // what is not kept is gathered while it is traced: other roundings
  for (std::size_t i = 0; i < solved.facets.irradiance.size(); ++i) {
    worst = std::max(worst, std::abs(double{solved.facets.irradiance[i]} - reference.facets.irradiance[i]));
    mean += reference.facets.irradiance[i] / static_cast<double>(reference.facets.irradiance.size());
  }
  CHECK(worst < 1e-5 * mean);
}

TEST_CASE("session: agrees with a solve without one to rounding, and goes on after a stop", "[solver][session]") {
  class Stop final : public Progress {
    bool cancelled() const override { return true; }
  } stop;
  Session session(quick());
  const auto scene = stand();
  CHECK_THROWS_AS(session.solve(scene, stop), Stopped);
  const auto a = session.solve(scene);
  const auto b = solve(scene, quick());
  double worst = 0, mean = 0;
  for (std::size_t i = 0; i < a.facets.irradiance.size(); ++i) {
    worst = std::max(worst, std::abs(double{a.facets.irradiance[i]} - b.facets.irradiance[i]));
    mean += b.facets.irradiance[i] / static_cast<double>(a.facets.irradiance.size());
  }
  CHECK(worst < 1e-5 * mean);
}

TEST_CASE("session: changed light reuses the transport of clustering and flat, to the bit", "[solver][session]") {
  for (const char* method : {"clustering", "flat"}) {
    CAPTURE(method);
    RunSettings run = quick();
    run.method = method;
    auto scene = stand();
    scene.ground = flat_ground({60, 60}, {2, 2}, {30, 30}, {0.12, 0.2});  // much of it far from all
    Session session(run);
    session.solve(scene);
    CHECK(count(session.reused().made, "transport") == 1);
    scene.states[0].sun->direction = glm::normalize(Vec3{-0.6, 0.3, 0.4});
    scene.states[0].sky->model = SkyModel::sphere;  // from below as well
    scene.states.push_back(scene.states[0]);
    scene.states[1].sun.reset();
    scene.states[1].sky->model = SkyModel::uniform;
    const auto lit = session.solve(scene);
    CHECK(count(session.reused().reused, "transport") == 1);
    CHECK(session.reused().saved_seconds > 0);
    CHECK(lit.facets.irradiance == fresh(scene, run).facets.irradiance);
    const auto plain = solve(scene, run);
    double worst = 0, mean = 0;
    for (std::size_t i = 0; i < plain.facets.irradiance.size(); ++i) {
      worst = std::max(worst, std::abs(double{lit.facets.irradiance[i]} - plain.facets.irradiance[i]));
      mean += plain.facets.irradiance[i] / static_cast<double>(plain.facets.irradiance.size());
    }
    CHECK(worst < 1e-4 * mean);
    for (std::size_t b = 0; b < 2; ++b) CHECK(lit.report.balance[0][b].escaped == Approx(plain.report.balance[0][b].escaped).epsilon(1e-5));
    scene.plants[0].placements[1].map = Affine::translate({2.2, -0.4, 0.1});
    session.solve(scene);
    CHECK(count(session.reused().reused, "transport") == 0);
  }
}

TEST_CASE("session: organs that stick in others are in the dark with a session too", "[solver][session]") {
  RunSettings run = quick();
  run.method = "clustering";
  run.quality = Quality::standard;
  auto scene = reference_runs::scene_with({"NIR"}, {uniform_optics("leaf", {0.45}, {0.40})});
  reference_runs::point_sun(scene, {0.3, 0.1, 1}, 400);
  reference_runs::sky(scene, SkyModel::uniform, 100);
  const auto tube = [](double radius, double low, double high) {
    Mesh mesh;
    constexpr std::uint32_t n = 12;
    for (std::uint32_t i = 0; i < n; ++i)
      for (const double z : {low, high})
        mesh.vertices.push_back({radius * std::cos(2 * std::numbers::pi * i / n), radius * std::sin(2 * std::numbers::pi * i / n), z});
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
    return mesh;
  };
  reference_runs::add(scene, "stem", {tube(0.1, 0, 1), Mesh{{{0, 0, 0.5}, {0.4, -0.1, 0.6}, {0.4, 0.1, 0.6}}, {{0, 1, 2}}}}, 0);
  Session session(run);
  const auto a = session.solve(scene), b = solve(scene, run);
  for (std::size_t o = 0; o < a.organs.count; ++o) CHECK(a.organs.absorbed_in(o) == Approx(b.organs.absorbed_in(o)).epsilon(1e-4));
}

TEST_CASE("session: the first solve is certified, the others where that is asked for or needed", "[solver][session]") {
  RunSettings run = quick();
  run.certificate.reset();
  run.certificate_rays = 20'000;
  auto scene = stand();
  Session session(run);
  CHECK(session.solve(scene).certificate);
  scene.states[0].sun->direction = glm::normalize(Vec3{-0.6, 0.3, 0.4});
  CHECK_FALSE(session.solve(scene).certificate);
  session.run.certificate = true;
  CHECK(session.solve(scene).certificate);
  Session never(quick());
  CHECK_FALSE(never.solve(scene).certificate);
}
