// Which structures share an original.
#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include <format_files.hpp>
#include <policy/similarity.hpp>
#include <policy/subtrees.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/species_toml.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/policy/classes.hpp>
#include <sunfleck/scene/build.hpp>

#include "places.hpp"

using namespace sunfleck;

namespace {

/// n random triangles in a unit box, some large, some small.
Mesh tuft(std::uint64_t seed, int n = 20) {
  RandomStream random(seed);
  Mesh mesh;
  for (int i = 0; i < n; ++i) {
    const Vec3 at{random.next(), random.next(), random.next()};
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(at + 0.3 * Vec3{random.next(), random.next(), random.next()});
    const auto v = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({v, v + 1, v + 2});
  }
  return mesh;
}

Affine stance(const Vec3& position, double turn, double scale, double tilt, bool mirror = false) {
  return placed({position, turn, scale, tilt, 30.0, mirror}).map;
}

/// A plant with one branch per map, each with a tuft as a leaf.
Plant branches(const std::vector<Affine>& maps, const std::vector<Mesh>& meshes, const std::vector<std::int64_t>& leaf_counts) {
  Plant plant = empty_plant("p", "p.h5");
  plant.material_index("");
  for (const auto& mesh : meshes) plant.meshes.push_back(mesh);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const auto branch = add_structure(plant, 0, "branch", "branch_" + std::to_string(i + 1));
    plant.structures[branch].frame = maps[i];
    set_attribute(plant, branch, "leaf_count", leaf_counts[i]);
    const auto mesh = static_cast<std::uint32_t>(i % meshes.size());
    plant.shapes.push_back({branch, mesh, 0, static_cast<std::uint32_t>(plant.meshes[mesh].triangles.size()), 0, maps[i]});
  }
  return plant;
}

Scene scene_of(Plant plant, const std::string& policy = {}, std::size_t copies = 1) {
  Scene scene;
  scene.bands = {"PAR"};
  scene.optics.push_back(uniform_optics("leaf", {0.1}, {0.05}));
  std::vector<Placement> placements;
  for (std::size_t i = 0; i < copies; ++i) placements.push_back(placed({.position = {10.0 * static_cast<double>(i), 0, 0}}));
  scene.plants.push_back(plant_entry("p", std::move(plant), 0, placements));
  scene.plants[0].policy_file = policy;
  return scene;
}

PolicySet policy_set(const std::string& text) {
  const TextFile file("p.toml", text);
  Policy policy = read_policy(file.path);
  policy.file = "p.toml";
  PolicySet set;
  set.emplace("p.toml", policy);
  return set;
}

double worst_corner(const Scene& scene, const OriginalClass& c, const ClassMember& m) {
  const auto& r = c.members[c.representative];
  const auto from = Subtrees(scene.plants[r.structure.index]).facets(r.structure.structure);
  const auto to = Subtrees(scene.plants[m.structure.index]).facets(m.structure.structure);
  double worst = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    auto t = from[i];
    for (auto& p : t) p = m.from_representative.point(p);
    if (m.from_representative.mirrors()) std::swap(t[1], t[2]);
    for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, glm::length(t[k] - to[i][k]));
  }
  return worst;
}

std::string refusal(const Plant& plant, const std::string& policy) {
  try {
    classify(scene_of(plant, "p.toml"), policy_set(policy));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("Turned, mirrored and scaled copies are one exact class; stretched ones are not", "[policy]") {
  Affine stretched = stance({9, 9, 9}, 10, 1, 0);
  stretched.linear[0] *= 1.01;
  const std::vector<Affine> maps{stance({0, 0, 0}, 0, 1, 0), stance({5, 1, 2}, 77, 0.3, 40), stance({1, 8, 0}, 130, 2.5, 100, true),
                                 stretched};
  const Scene scene = scene_of(branches(maps, {tuft(1)}, {1, 1, 1, 1}));
  const auto result = classify(scene, {});
  REQUIRE(result.classes.size() == 1);
  const auto& c = result.classes[0];
  CHECK(c.name == "branch: copies of branch_1");
  CHECK(c.likeness == Likeness::exact);
  CHECK(c.facets == 20);
  REQUIRE(c.members.size() == 3);
  CHECK(c.members[1].scale == Approx(0.3));
  CHECK(c.members[2].from_representative.mirrors());
  // Rounding of coordinates of some ten metres.
  for (const auto& m : c.members) CHECK(worst_corner(scene, c, m) < 1e-12);
  CHECK(result.of_structure[0] == std::vector<std::uint32_t>{no_class, 0, 0, 0, no_class});
  CHECK(result.of({false, 0, 2}) == 0);
}

TEST_CASE("Copies with other optics are no copies", "[policy]") {
  Scene scene = scene_of(branches({stance({0, 0, 0}, 0, 1, 0), stance({5, 1, 2}, 77, 1, 40)}, {tuft(1)}, {1, 1}));
  CHECK(classify(scene, {}).classes.size() == 1);
  scene.optics.push_back(uniform_optics("bark", {0.2}, {0.0}));
  scene.plants[0].shape_optics[1] = 1;
  CHECK(classify(scene, {}).classes.empty());
}

TEST_CASE("A plant placed twice is a class without any policy; so is a group", "[policy]") {
  Scene scene = scene_of(make_plant(tuft(3), "p"), {}, 2);
  auto result = classify(scene, {});
  REQUIRE(result.classes.size() == 1);
  CHECK(result.classes[0].name == "plant: all copies of \"p\"");
  CHECK(result.classes[0].copies == 2);
  CHECK(result.of_structure[0][0] == 0);

  scene.plants[0].placements.clear();
  GroupEntry tile{"tile", {{false, 0, placed({})}, {false, 0, placed({.position = {1, 0, 0}})}}, {}};
  GroupEntry stand{"stand", {{true, 0, placed({})}, {true, 0, placed({.position = {9, 0, 0}})}}, {placed({})}};
  scene.groups = {tile, stand};
  result = classify(scene, {});
  REQUIRE(result.classes.size() == 2);
  CHECK(result.classes[0].copies == 4);
  CHECK(result.classes[1].name == "group: all copies of \"tile\"");
  CHECK(result.classes[1].copies == 2);
  CHECK(result.classes[1].facets == 40);
  CHECK(result.of_group == std::vector<std::uint32_t>{1, no_class});
}

TEST_CASE("Copies that are placed with a shear have originals of their own", "[policy]") {
  Scene scene = scene_of(make_plant(tuft(3), "p"), {}, 2);
  Affine sheared = stance({0, 4, 0}, 0, 1, 0);
  sheared.linear[1] += 0.2 * sheared.linear[0];
  scene.plants[0].placements.push_back({sheared});
  scene.plants[0].placements.push_back({stance({0, 8, 0}, 55, 2, 20) * sheared});  // the same shear, turned and scaled
  const auto result = classify(scene, {});
  REQUIRE(result.classes.size() == 2);
  CHECK(result.classes[1].name == "plant: stretched copies of \"p\"");
  CHECK(result.classes[1].copies == 2);
  CHECK(result.classes[1].stretch == sheared.linear);
}

TEST_CASE("A policy groups structures by half-open intervals, and large ones converge", "[policy]") {
  std::vector<Affine> maps;
  std::vector<Mesh> meshes;
  const std::vector<std::int64_t> counts{1, 3, 4, 5, 15, 16, 50, 70, 300};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    maps.push_back(stance({2.0 * static_cast<double>(i), 0, 0}, 40.0 * static_cast<double>(i), 1, 5.0 * static_cast<double>(i)));
    meshes.push_back(tuft(10 + i));
  }
  const Plant plant = branches(maps, meshes, counts);
  const auto result = classify(scene_of(plant, "p.toml"), policy_set(R"([type.branch]
parameters = { leaf_count = [2, 4, 16] }
converged = { parameter = "leaf_count", above = 50 }
align = "frame"
least_members = 1
)"));
  std::vector<std::string> names;
  for (const auto& c : result.classes) names.push_back(c.name);
  CHECK(names == std::vector<std::string>{"branch: leaf_count [2, 4)", "branch: leaf_count [4, 16)", "branch: leaf_count [16, ...)",
                                          "branch: leaf_count above 50"});
  CHECK(result.of_structure[0] == std::vector<std::uint32_t>{no_class, no_class, 0, 1, 1, 1, 2, 2, 3, 3});
  CHECK(result.classes[1].likeness == Likeness::policy);

  SECTION("a representative stands in with the member's area, centre and frame") {
    const auto& c = result.classes[1];
    const Subtrees subtrees(scene_of(plant).plants[0]);
    const auto& r = c.members[c.representative];
    for (const auto& m : c.members) {
      CHECK(m.scale * m.scale * r.area_m2 == Approx(m.area_m2));
      const auto &from = subtrees.moments(r.structure.structure), &to = subtrees.moments(m.structure.structure);
      CHECK(glm::length(m.from_representative.point(from.centroid()) - to.centroid()) < 1e-12);
      const Mat3 turn = m.from_representative.linear / m.scale;
      const Mat3 expected = subtrees.frame(m.structure.structure).linear * glm::transpose(subtrees.frame(r.structure.structure).linear);
      for (int k = 0; k < 3; ++k) CHECK(glm::length(turn[k] - expected[k]) < 1e-12);
    }
  }
  SECTION("or upright: turned about the vertical only, axis over axis") {
    const auto upright = classify(scene_of(plant, "p.toml"), policy_set("[type.branch]\n")).classes.at(0);
    const Subtrees subtrees(scene_of(plant).plants[0]);
    for (const auto& m : upright.members) {
      const Mat3 turn = m.from_representative.linear / m.scale;
      CHECK(glm::length(turn[2] - Vec3{0, 0, 1}) < 1e-12);
      const Vec3 axis = turn * subtrees.frame(upright.members[upright.representative].structure.structure).linear[2];
      const Vec3 wanted = subtrees.frame(m.structure.structure).linear[2];
      if (m.structure.structure == 1) continue;  // this one stands upright: its x counts
      if (upright.members[upright.representative].structure.structure != 1) CHECK(std::abs(axis.x * wanted.y - axis.y * wanted.x) < 1e-12);
    }
  }
  SECTION("classes with too few members are left out, and copies below two are none") {
    const auto few = classify(scene_of(plant, "p.toml"), policy_set("[type.branch]\nparameters = { leaf_count = [2, 4, 16] }\n"));
    REQUIRE(few.classes.size() == 2);
    CHECK(few.classes[0].members.size() == 3);
    CHECK(few.classes[1].members.size() == 4);
  }
  SECTION("the largest, the first") {
    const auto by = [&](const std::string& rule) {
      return classify(scene_of(plant, "p.toml"), policy_set("[type.branch]\nrepresentative = \"" + rule + "\"\n")).classes.at(0);
    };
    CHECK(by("first").representative == 0);
    const auto largest = by("largest");
    for (const auto& m : largest.members) CHECK(m.area_m2 <= largest.members[largest.representative].area_m2);
    const auto medoid = by("medoid");  // nearer to the others than the largest
    CHECK(medoid.members[medoid.representative].area_m2 < largest.members[largest.representative].area_m2);
  }
  SECTION("plants with the same policy share classes") {
    Scene two = scene_of(plant, "p.toml");
    two.plants.push_back(two.plants[0]);
    two.plants[1].plant = std::make_shared<const Plant>(branches({stance({0, 0, 0}, 0, 1, 0)}, {tuft(99)}, {7}));
    two.plants[1].shape_optics = {0};
    const auto shared = classify(two, policy_set("[type.branch]\nparameters = { leaf_count = [4, 16] }\nleast_members = 4\n"));
    REQUIRE(shared.classes.size() == 2);
    CHECK(shared.of_structure[1] == std::vector<std::uint32_t>{no_class, 0});
    CHECK(shared.of_structure[0][3] == 0);
  }
}

TEST_CASE("Parameters that a file does not have are derived", "[policy]") {
  Plant plant = empty_plant("p", "p.obj", "Individual");
  plant.material_index("");
  plant.meshes.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 0, 2}}, {{0, 1, 2}}});
  const auto axis = add_structure(plant, 0, "Axis", "a");
  const auto metamer = add_structure(plant, axis, "Metamer", "m");
  const auto side = add_structure(plant, metamer, "Axis", "b");
  for (const auto owner : {metamer, side})
    for (int i = 0; i < 2; ++i)
      plant.shapes.push_back({add_structure(plant, owner, "Leaf", ""), 0, 0, 1, 0, Affine::translate({0, 0, 3.0 * i + owner})});
  const auto count = [&](const std::string& parameter, const std::string& bound) {
    const auto result = classify(scene_of(plant, "p.toml"),
                                 policy_set("[type.Axis]\nleast_members = 1\nparameters = { " + parameter + " = " + bound + " }\n"));
    std::string names;
    for (const auto& c : result.classes) names += c.name + ";";
    return names;
  };
  CHECK(count("leaf_count", "\"each\"") == "Axis: leaf_count 4;Axis: leaf_count 2;");
  CHECK(count("order", "\"each\"") == "Axis: order 1;Axis: order 2;");
  CHECK(count("area", "[1.9, 2.1, 3.9, 4.1]") == "Axis: area [3.9, 4.1);Axis: area [1.9, 2.1);");
  CHECK(count("height", "[4.99, 5.01, 5.99, 6.01]") == "Axis: height [5.99, 6.01);Axis: height [4.99, 5.01);");
  CHECK(count("length", "[4.99, 5.01, 5.99, 6.01]") == "Axis: length [5.99, 6.01);Axis: length [4.99, 5.01);");
  CHECK(count("type", "[\"Axis\"]") == "Axis: type Axis;");
}

TEST_CASE("A policy that does not fit its plants is refused, with its line", "[policy][hostile]") {
  Plant plant = branches({stance({0, 0, 0}, 0, 1, 0), stance({5, 1, 2}, 77, 1, 40)}, {tuft(1), tuft(2)}, {1, 2});
  set_attribute(plant, 1, "vigour", 0.5);
  set_attribute(plant, 2, "vigour", 1.5);
  set_attribute(plant, 1, "kind", std::string("long"));
  set_attribute(plant, 2, "kind", std::string("short"));
  CHECK(refusal(plant, "[type.branch]\nparameters = { leafcount = [1, 2] }\n") ==
        "p.toml:2: type.branch.parameters.leafcount: found \"leafcount\", which no structure of type branch of \"p\" has; expected one of "
        "area, "
        "height, kind, leaf_count, length, order, type, vigour; did you mean \"leaf_count\"?");
  CHECK(refusal(plant, "[type.branch]\nconverged = { parameter = \"nodes\", above = 3 }\n") ==
        "p.toml:2: type.branch.converged.parameter: found \"nodes\", which no structure of type branch of \"p\" has; expected one of area, "
        "height, kind, leaf_count, length, order, type, vigour");
  CHECK(refusal(plant, "[type.brunch]\n") ==
        "p.toml:1: type.brunch: found a structure type that \"p\" does not have; expected one that it has; did you mean \"branch\"?");
  CHECK(refusal(plant, "[type.branch]\nparameters = { vigour = \"each\" }\n") ==
        "p.toml:2: type.branch.parameters.vigour: found \"each\" for a parameter with fractions such as 0.5; expected bounds or intervals");
  CHECK(refusal(plant, "[type.branch]\nparameters = { vigour = [\"a\"] }\n") ==
        "p.toml:2: type.branch.parameters.vigour: found a list of texts for a parameter that holds numbers such as 0.5; expected bounds or "
        "intervals");
  CHECK(refusal(plant, "[type.branch]\nparameters = { kind = [1, 2] }\n") ==
        "p.toml:2: type.branch.parameters.kind: found numbers for a parameter that holds texts such as \"long\"; expected a list of such "
        "texts, "
        "or \"each\"");
  CHECK(refusal(plant, "[type.branch]\nconverged = { parameter = \"kind\", above = 3 }\n") ==
        "p.toml:2: type.branch.converged.parameter: found \"kind\", which holds texts such as \"long\"; expected a parameter that holds "
        "numbers");
  const auto noted = classify(scene_of(plant, "p.toml"), policy_set("[type.tiller]\n"));
  CHECK(noted.notes == std::vector<std::string>{"p.toml:1: type.tiller: \"p\" has no structure of this type"});
  plant.structures[2].attributes.pop_back();
  const auto lacking = classify(scene_of(plant, "p.toml"), policy_set("[type.branch]\nparameters = { kind = \"each\" }\n"));
  CHECK(lacking.notes ==
        std::vector<std::string>{"p.toml: 1 of type branch of \"p\" lack a parameter of the policy: opened with their parents"});
}

TEST_CASE("Similarities of flat and symmetric facets keep fronts", "[policy]") {
  const std::vector<Triangle> from{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}, {Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}};
  for (const bool mirror : {false, true}) {
    const Affine map = stance({1, 2, 3}, 200, 0.01, 70, mirror);
    auto to = from;
    for (auto& t : to) {
      for (auto& p : t) p = map.point(p);
      if (mirror) std::swap(t[1], t[2]);
    }
    const auto found = find_similarity(from, to, 1e-9);
    REQUIRE(found);
    CHECK(found->scale == Approx(0.01));
    for (std::size_t i = 0; i < from.size(); ++i) {
      // A flat mirrored copy is also a turned one: either answer must map fronts to fronts.
      const Vec3 normal = area_vector(to[i]);
      Triangle image = from[i];
      for (auto& p : image) p = found->point(p);
      if (found->affine().mirrors()) std::swap(image[1], image[2]);
      CHECK(glm::length(area_vector(image) - normal) < 1e-12);
    }
  }
  CHECK_FALSE(find_similarity(from, {from[0]}, 1e-9));
  CHECK(uniform_scale(stance({0, 0, 0}, 20, 3, 40, true).linear) == Approx(3.0));
  CHECK_FALSE(uniform_scale(Mat3{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1.001}}));
}

TEST_CASE("Locust: compound leaves are copies of a few, branches differ", "[policy]") {
  Plant plant = read_species_plant(SUNFLECK_SOURCE_DIR "/plants/locust.toml", 3.0, 1);
  const std::size_t leaves = leaf_totals(plant).leaves;
  PolicySet set;
  set.emplace("locust", read_policy(SUNFLECK_SOURCE_DIR "/policies/locust.toml"));
  const Scene scene = scene_of(std::move(plant), "locust");
  const auto result = classify(scene, set);
  std::size_t exact_leaves = 0, leaf_classes = 0, branches_in_classes = 0;
  for (const auto& c : result.classes) {
    if (c.name.rfind("leaf: copies", 0) == 0) {
      ++leaf_classes, exact_leaves += c.members.size();
      CHECK(c.likeness == Likeness::exact);
      for (std::size_t i = 0; i < c.members.size(); i += 40) CHECK(worst_corner(scene, c, c.members[i]) < 1e-5);
    }
    if (c.name.rfind("branch: leaf_count", 0) == 0) branches_in_classes += c.members.size();
  }
  CHECK(leaf_classes == 5);
  CHECK(exact_leaves == leaves);
  CHECK(branches_in_classes == 15);
}

TEST_CASE("Coffee: classes of the plant that was digitised", "[policy]") {
  const auto file = extra_data("plants/coffee.opf");
  if (file.empty()) {
    WARN("skipped: SUNFLECK_EXTRA_DATA has no plants/coffee.opf");
    return;
  }
  PolicySet set;
  set.emplace("coffee", read_policy(SUNFLECK_SOURCE_DIR "/policies/coffee.toml"));
  const Scene scene = scene_of(read_plant(file, 0.01), "coffee");
  const auto result = classify(scene, set);
  std::map<std::string, std::pair<std::size_t, std::size_t>> totals;  // classes, members
  for (const auto& c : result.classes) {
    auto& t = totals[c.name.substr(0, c.name.find(':')) + (c.likeness == Likeness::exact ? " exact" : "")];
    ++t.first, t.second += c.members.size();
  }
  // Of 158 axes 5 are copies of one another; of 2179 leaves, all stretched, each falls into one of nine classes by area.
  CHECK(totals["Axis exact"] == std::pair<std::size_t, std::size_t>{1, 5});
  CHECK(totals["Leaf"] == std::pair<std::size_t, std::size_t>{9, 2179});
  CHECK(totals["Leaf exact"].first == 0);
  CHECK(totals["Axis"] == std::pair<std::size_t, std::size_t>{14, 129});
  CHECK(result.notes.empty());
}
