// Policies derived from tables.
#include <catch2/catch.hpp>

#include <format_files.hpp>
#include <original/partition.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/original/suggest.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/scene/build.hpp>

using namespace sunfleck;

namespace {

/// `leaves` random leaves of a branch that stands at `at`; flat (all normals up) or in all directions.
Mesh branch_mesh(std::uint64_t seed, int leaves, bool flat, const Vec3& at) {
  RandomStream random(seed);
  Mesh mesh;
  for (int i = 0; i < leaves; ++i) {
    const Vec3 p = at + Vec3{random.next(), random.next(), random.next()};
    for (int k = 0; k < 3; ++k) {
      Vec3 d{random.next(), random.next(), random.next()};
      if (flat) d.z = 0;
      mesh.vertices.push_back(p + 0.2 * d);
    }
    const auto v = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({v, v + 1, v + 2});
  }
  return mesh;
}

/// Every second branch is flat, and has a "vigour" below 16.
Scene two_kinds() {
  Plant plant = empty_plant("p", "p.h5");
  const auto material = plant.material_index("");
  for (int i = 0; i < 24; ++i) {
    const auto branch = add_structure(plant, 0, "branch", "branch_" + std::to_string(i));
    const bool flat = i % 2 == 0;
    set_attribute(plant, branch, "vigour", static_cast<std::int64_t>(flat ? 4 + i % 12 : 15 + i));
    Mesh mesh = branch_mesh(static_cast<std::uint64_t>(i), 40, flat, {2.0 * i, 0, 0});
    const std::size_t count = mesh.triangles.size();
    add_mesh(plant, std::move(mesh), std::vector(count, branch), std::vector(count, material));
  }
  Scene scene;
  scene.bands = {"PAR"};
  scene.optics.push_back(uniform_optics("leaf", {0.1}, {0.05}));
  scene.plants.push_back(plant_entry("p", std::move(plant), 0, {placed({})}));
  return scene;
}

}  // namespace

TEST_CASE("Cuts fall where the tables change", "[original][policy]") {
  std::vector<Specimen> all;
  for (int i = 0; i < 30; ++i)
    all.push_back({{i < 10 ? 0.0 : i < 20 ? 1.0 : 2.0, 0.01 * (i % 3)}, {static_cast<double>((7 * i) % 11), static_cast<double>(i)}});
  const auto cuts = best_cuts(all, 2, 0.001, 3);
  REQUIRE(cuts.size() == 1);
  CHECK(cuts[0].parameter == 1);
  CHECK(cuts[0].bounds == std::vector<double>{0, 10, 20});
  CHECK(within_classes(all, cuts) < 1e-4 + 0.001);
  CHECK(best_cuts(all, 1, 0.001, 16).empty());  // no class may be that large
}

TEST_CASE("A suggested policy tells the kinds apart, and can be read again", "[original][policy]") {
  const auto suggestion = suggest_policy(two_kinds(), {.measured = 24, .likeness = 0.3, .error = 0.05}, silent());
  REQUIRE(suggestion.policy.types.size() == 1);
  const auto& type = suggestion.policy.types[0];
  CHECK(type.type == "branch");
  CHECK_FALSE(type.parameters.empty());
  CHECK(suggestion.remarks.size() == 1);
  const TextFile file("p.toml", policy_text(suggestion.policy));
  CHECK(policy_text(read_policy(file.path)) == policy_text(suggestion.policy));

  Scene scene = two_kinds();
  scene.plants[0].policy_file = "p.toml";
  PolicySet set;
  set.emplace("p.toml", read_policy(file.path));
  std::size_t members = 0;
  for (const auto& c : classify(scene, set).classes) {
    for (const auto& m : c.members) CHECK(m.structure.structure % 2 == c.members[0].structure.structure % 2);  // one kind in a class
    members += c.members.size();
  }
  CHECK(members >= 20);
}

TEST_CASE("Members of one kind are nearer to their representative than of two", "[original][policy]") {
  Scene scene = two_kinds();
  scene.plants[0].policy_file = "p.toml";
  const auto spread = [&](const std::string& text) {
    const TextFile file("p.toml", text);
    PolicySet set;
    set.emplace("p.toml", read_policy(file.path));
    const auto classes = classify(scene, set).classes;
    double worst = 0;
    for (const auto& c : classes) worst = std::max(worst, class_spread(scene, c, 6, 0.03, silent()).phase[0]);
    return worst;
  };
  CHECK(spread("[type.branch]\nparameters = { vigour = [1, 16] }\n") < 0.5 * spread("[type.branch]\n"));
}

TEST_CASE("Nothing to suggest from is an error", "[original][policy][hostile]") {
  Scene scene = two_kinds();
  scene.file = "scene.toml";
  CHECK_THROWS_WITH(
      suggest_policy(scene, {.most_facets = 8}, silent()),
      "scene.toml: found no structure type with 6 structures or more that are no exact copies; expected plants whose structures repeat");
}
