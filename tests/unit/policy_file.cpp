// Policy files: what they may say, and what is said about those that are wrong.
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include <format_files.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/policy/policy_toml.hpp>

#include "places.hpp"

using namespace sunfleck;

namespace {

Policy read(const std::string& text) {
  const TextFile file("p.toml", text);
  return read_policy(file.path);
}

std::string message(const std::string& text) {
  const TextFile file("p.toml", text);
  return message_of(file, [&] { read_policy(file.path); });
}

}  // namespace

TEST_CASE("A policy file says what its keys mean", "[policy]") {
  const Policy policy = read(R"([type.branch]
parameters = { leaf_count = [1, 4, 16], order = "each", cultivar = ["a", "b"], area = [[0.5, 1], [2, 3.5]] }
converged = { parameter = "leaf_count", above = 248 }
representative = "largest"
scale = "size"
align = "frame"
least_members = 5
[type."*"]
[tables]
basis = "directions"
error = 0.01
field_pixels = 1
)");
  REQUIRE(policy.types.size() == 2);
  CHECK(policy.types[0].type == "*");
  CHECK(policy.types[0].least_members == 3);
  CHECK(policy.types[0].representative == Representative::medoid);
  CHECK(policy.types[0].scale == StandIn::area);
  const PolicyType& branch = policy.types[1];
  CHECK(branch.representative == Representative::largest);
  CHECK(branch.scale == StandIn::size);
  CHECK(branch.align == Alignment::frame);
  CHECK(branch.least_members == 5);
  CHECK(branch.converged->parameter == "leaf_count");
  CHECK(branch.converged->above == 248);
  REQUIRE(branch.parameters.size() == 4);  // by name
  const auto& area = branch.parameters[0].intervals;
  REQUIRE(area.size() == 2);
  CHECK(area[0].holds(0.5));  // half-open
  CHECK_FALSE(area[0].holds(1.0));
  CHECK(area[1].high == 3.5);
  CHECK(branch.parameters[1].values == std::vector<std::string>{"a", "b"});
  const auto& leaves = branch.parameters[2].intervals;
  REQUIRE(leaves.size() == 3);
  CHECK(leaves[1].low == 4);
  CHECK(leaves[1].high == 16);
  CHECK(std::isinf(leaves[2].high));
  CHECK(branch.parameters[3].each);
  CHECK(policy.tables.basis == TableSettings::Basis::directions);
  CHECK(policy.tables.error == 0.01);
  CHECK(policy.tables.field_pixels == 1);
}

TEST_CASE("A policy written out reads back to the same", "[policy]") {
  const Policy policy = read(R"([type."long shoot"]
parameters = { leaf_count = [1, 4, 16], order = "each", cultivar = ["a \"b\"", "true"], area = [[0.5, 1], [2, 3.5]] }
converged = { parameter = "leaf count", above = 248.5 }
representative = "first"
[tables]
order = 4
)");
  const std::string text = policy_text(policy);
  CHECK(policy_text(read(text)) == text);
  CHECK(text == R"([type."long shoot"]
parameters = { area = [[0.5, 1], [2, 3.5]], cultivar = ["a \"b\"", "true"], leaf_count = [1, 4, 16], order = "each" }
converged = { parameter = "leaf count", above = 248.5 }
representative = "first"
scale = "area"
align = "upright"
least_members = 3

[tables]
basis = "sh"
order = 4
error = 0.002
field_pixels = 8
)");
}

TEST_CASE("The policies that come with the program can be read", "[policy]") {
  std::size_t read_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SUNFLECK_SOURCE_DIR "/policies")) {
    INFO(entry.path());
    const Policy policy = read_policy(entry.path().string());
    CHECK_FALSE(policy.types.empty());
    ++read_files;
  }
  CHECK(read_files == 6);
}

TEST_CASE("Errors of policy files name line, key, what was found and what was expected", "[policy][hostile]") {
  CHECK(message("[type.branch]\nparameters = { leaf_count = [1, 4, 4] }\n") ==
        "p.toml:2: type.branch.parameters.leaf_count[2]: found 4 after 4; expected bounds that rise: each begins the interval that ends at "
        "the next");
  CHECK(message("[type.branch]\nparameters = { leaf_count = [[1, 4], [3, 8]] }\n") ==
        "p.toml:2: type.branch.parameters.leaf_count[1]: found [3, 8) after [1, 4); expected intervals that rise and do not overlap");
  CHECK(message("[type.branch]\nparameters = { leaf_count = [[4, 1]] }\n") ==
        "p.toml:2: type.branch.parameters.leaf_count[0]: found [4, 1); expected a low end below the high end");
  CHECK(message("[type.branch]\nparameters = { leaf_count = 4 }\n") ==
        "p.toml:2: type.branch.parameters.leaf_count: found 4; expected rising bounds like [1, 4, 16], intervals like [[1, 4], [4, 16]], "
        "values like [\"a\", \"b\"], or \"each\"");
  CHECK(message("[type.branch]\nparameters = { leaf_count = [1, \"many\"] }\n") ==
        "p.toml:2: type.branch.parameters.leaf_count[1]: found \"many\"; expected a number");
  CHECK(message("[type.branch]\nparameters = { kind = [\"a\", \"a\"] }\n") ==
        "p.toml:2: type.branch.parameters.kind[1]: found \"a\" twice; expected each value once");
  CHECK(message("[type.branch]\nconverged = { parameter = \"order\" }\n") ==
        "p.toml:2: type.branch.converged.above: found nothing; expected the value above which all structures are one class");
  CHECK(message("[type.branch]\nrepresentative = \"medioid\"\n") ==
        "p.toml:2: type.branch.representative: found \"medioid\"; expected one of medoid, first, largest; did you mean \"medoid\"?");
  CHECK(message("[type.branch]\nalign = \"up\"\n") == "p.toml:2: type.branch.align: found \"up\"; expected one of upright, frame");
  CHECK(message("[type.branch]\nleast_members = 0\n") ==
        "p.toml:2: type.branch.least_members: found 0; expected a whole number from 1 to 1000000000");
  CHECK(message("[tables]\nbasis = \"directions\"\norder = 2\n") ==
        "p.toml:3: tables.order: found `order` beside basis = \"directions\"; expected it with basis = \"sh\" only");
  CHECK(message("[tables]\norder = 7\n") == "p.toml:2: tables.order: found 7; expected a whole number from 1 to 6");
  CHECK(message("[tables]\nerror = 0\n") == "p.toml:2: tables.error: found 0; expected a number from 0.0001 to 0.1");
  CHECK(message("[tables]\nfield_pixels = 65\n") == "p.toml:2: tables.field_pixels: found 65; expected a whole number from 1 to 64");
  // All unknown keys at once.
  CHECK(message("[type.branch]\nparameter = {}\n[tables]\nbase = 1\n") ==
        "p.toml:2: type.branch.parameter: unknown key; did you mean \"parameters\"?\np.toml:4: tables.base: unknown key; did you mean "
        "\"basis\"?");
  CHECK(message("[types.branch]\n") == "p.toml:1: types: unknown key; did you mean \"type\"?");
}
