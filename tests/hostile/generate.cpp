// `sunfleck generate` as its user runs it: what it writes reads back, and what cannot be leaves nothing behind.
#include <catch2/catch.hpp>

#include <cmath>

#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/species_toml.hpp>

#include "places.hpp"
#include "run_program.hpp"

using namespace sunfleck;

namespace {

const std::string wheat = std::string(SUNFLECK_SOURCE_DIR) + "/plants/wheat.toml";

/// Largest distance between corners of the facets of two plants, in their order.
double largest_distance(const Plant& a, const Plant& b) {
  REQUIRE(a.facet_count() == b.facet_count());
  const auto corners = [](const Plant& plant) {
    std::vector<Vec3> all;
    for (const auto& shape : plant.shapes)
      for (std::uint32_t t = 0; t < shape.triangle_count; ++t)
        for (const auto& p : shape_triangle(plant, shape, t)) all.push_back(p);
    return all;
  };
  const auto p = corners(a), q = corners(b);
  double most = 0;
  for (std::size_t i = 0; i < p.size(); ++i) most = std::max(most, glm::length(p[i] - q[i]));
  return most;
}

}  // namespace

TEST_CASE("generated plants read back", "[generate]") {
  const TemporaryFolder folder;
  const Plant grown = read_species_plant(wheat, 60, 3);

  const std::string h5 = folder.path("wheat.h5");
  const auto run = run_sunfleck({"generate", wheat, "-o", h5, "--age", "60", "--seed", "3"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(run.out.find("wheat at 60 days, seed 3\n") != std::string::npos);
  CHECK(run.out.find("  facets      " + std::to_string(grown.facet_count()) + "\n") != std::string::npos);
  const Plant kept = read_plant(h5);
  CHECK(largest_distance(kept, grown) == 0);
  CHECK(kept.structures.size() == grown.structures.size());
  CHECK(kept.types == grown.types);
  CHECK(std::get<std::int64_t>(*kept.attribute(0, "leaf_count")) == static_cast<std::int64_t>(leaf_totals(grown).leaves));

  const std::string obj = folder.path("wheat.obj");
  REQUIRE(run_sunfleck({"generate", wheat, "-o", obj, "--age", "60", "--seed", "3"}).exit_code == 0);
  const Plant drawn = read_plant(obj);
  CHECK(largest_distance(drawn, grown) < 1e-8);          // 9 significant digits of coordinates below 1 m
  for (std::size_t i = 0; i < grown.shapes.size(); ++i)  // an organ with one shape is a group
    REQUIRE(drawn.materials[drawn.shapes[i].material] == grown.materials[grown.shapes[i].material]);
  CHECK(folder.listing() == std::vector<std::string>{"wheat.h5", "wheat.mtl", "wheat.obj"});
}

TEST_CASE("what cannot be generated leaves nothing behind", "[generate]") {
  const TemporaryFolder folder;
  const auto fails = [&](const std::vector<std::string>& arguments, int exit_code, const std::string& message) {
    const auto run = run_sunfleck(arguments);
    INFO(run.err);
    CHECK(run.exit_code == exit_code);
    CHECK(run.err.find(message) != std::string::npos);
  };
  const std::string h5 = folder.path("p.h5");
  fails({"generate", wheat, "-o", h5, "--age", "1000"}, 2, "wheat.toml: found age 1000 days; expected 5 to 150 days");
  fails({"generate", wheat, "-o", folder.path("p.stl")}, 2, "found suffix '.stl'; expected .h5, .obj");
  fails({"generate", folder.path("none.toml"), "-o", h5}, 2, "none.toml: found");
  CHECK(folder.listing().empty());
  const std::string broken = folder.file("broken.toml", "name = \"b\"\nprogram = \"cereal\"\nages = [1, 9]\nage = 2\n[stem]\nsides = 2\n");
  fails({"generate", broken, "-o", h5}, 2, "broken.toml:6: stem.sides: found 2; expected a whole number from 3 to 24");
  CHECK(folder.listing() == std::vector<std::string>{"broken.toml"});
}

TEST_CASE("a full disk leaves the old OBJ as it was", "[generate]") {
  const TemporaryFolder folder;
  const std::string obj = folder.file("wheat.obj", "# old\n");
  ProgramFate full;
  full.disk_bytes = 2000;
  const auto run = run_sunfleck({"generate", wheat, "-o", obj}, full);
  CHECK(run.exit_code == 1);
  CHECK(text_of(obj) == "# old\n");
}
