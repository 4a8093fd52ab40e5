// Broken species files: each message names file, line and key, what was found and what was expected.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <limits>

#include <unistd.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/format/species_toml.hpp>

using namespace sunfleck;

namespace {

struct File {
  std::string path = (std::filesystem::temp_directory_path() / ("sunfleck_species_" + std::to_string(getpid()) + ".toml")).string();
  explicit File(const std::string& text) { std::ofstream(path) << text; }
  ~File() { std::filesystem::remove(path); }
};

const std::string tree = "name = \"t\"\nprogram = \"tree\"\nages = [1, 9]\nage = 2\n";
const std::string cereal = "name = \"c\"\nprogram = \"cereal\"\nages = [1, 90]\nage = 20\n";

/// What the error says after the file's name.
std::string message(const std::string& text) {
  const File file(text);
  try {
    read_species_plant(file.path);
  } catch (const InputError& error) {
    const std::string what = error.what();
    REQUIRE(what.rfind(file.path, 0) == 0);
    return what.substr(file.path.size());
  }
  return "no error";
}

}  // namespace

TEST_CASE("species files that cannot be right") {
  CHECK(message(tree + "[[axis]]\n") == "no error");
  CHECK(message(cereal) == "no error");
  CHECK(message("name = \"t\"\n") == ":1: program: found nothing; expected \"tree\" or \"cereal\"");
  CHECK(message("name = \"t\"\nprogram = \"cereals\"\n") ==
        ":2: program: found \"cereals\"; expected one of tree, cereal; did you mean \"cereal\"?");
  CHECK(message(tree) == ":1: axis: found nothing; expected [[axis]] tables, one for each physiological age, the trunk first");
  CHECK(message(tree + "axis = []\n") == ":5: axis: found an empty array; expected at least one [[axis]], the trunk");
  CHECK(message(tree + "[[axis]]\nnode = 3\n[leaf]\nhinges = 4\n[maize]\n") ==
        ":6: axis[0].node: unknown key; did you mean \"nodes\"?\n" + (File("").path) +
            ":8: leaf.hinges: unknown key; did you mean \"hinge\"?\n" + File("").path +
            ":9: maize: unknown key; known here: name, program, ages, age, seed, tree, leaf, axis");
  CHECK(message(tree + "[[axis]]\nnodes = -3\n") == ":6: axis[0].nodes: found -3; expected a number from 0.5 to 200");
  CHECK(message(tree + "[[axis]]\nnodes = nan\n") == ":6: axis[0].nodes: found nan; expected a finite number");
  CHECK(message(tree + "[[axis]]\nnodes = \"many\"\n") == ":6: axis[0].nodes: found \"many\"; expected a number");
  CHECK(message(tree + "[[axis]]\ninternode_length = 5\n") ==
        ":6: axis[0].internode_length: found 5; expected a number from 0.0001 to 1 m");
  CHECK(message(tree + "[[axis]]\nsides = 2.5\n") == ":6: axis[0].sides: found 2.5; expected a whole number from 3 to 24");
  CHECK(message(tree + "[[axis]]\nweak_probability = 0.5\nweak_class = 2\n") ==
        ":5: axis[0].weak_class: found 2; expected a physiological age from 1 to 1, the number of [[axis]] tables");
  CHECK(message(tree + "[[axis]]\n[leaf]\nleaflets_low = 4\nleaflets_high = 7\n") ==
        ":7: leaf.leaflets_low: found 4; expected an odd number: pairs and one at the end");
  CHECK(message(tree + "[[axis]]\n[leaf]\noutline = [[0, 0], [0.5, 0], [1, 0]]\n") ==
        ":7: leaf.outline[1]: found two half-widths of zero in a row; expected some width between any two points");
  CHECK(message(tree + "[[axis]]\n[leaf]\noutline = [[0, 0], [0.5, 1], [0.5, 0]]\n") ==
        ":7: leaf.outline[2]: found position 0.500000; expected positions that rise");
  CHECK(message(tree + "[[axis]\n").rfind(":5: not valid TOML: ", 0) == 0);
  CHECK(message("name = \"t\"\nprogram = \"tree\"\nages = [3, 2]\nage = 2\n[[axis]]\n") ==
        ":3: ages: found 3.000000 to 2.000000; expected two rising ages, above 0 and at most 200 years");
}

TEST_CASE("ages outside the species' range, and growth without end") {
  const File file(tree + "[tree]\nhighest_order = 8\n[[axis]]\nnodes = 100\nstrong_branches = 50\nstrong_class = 1\nbasal_vigour = 1\n");
  const auto what = [](const auto& call) {
    try {
      call();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  CHECK(what([&] { read_species_plant(file.path, 10); }) == file.path + ": found age 10 years; expected 1 to 9 years");
  CHECK(what([&] { read_species_plant(file.path, std::numeric_limits<double>::quiet_NaN()); }) ==
        file.path + ": found age nan years; expected 1 to 9 years");
  CHECK(what([&] { read_species_plant(file.path, 9); }) ==
        file.path + ": found more than 4000000 nodes at age 9 years; expected fewer branches, or a lower age");
  CHECK(what([] { read_species("no/such/species.toml"); }).rfind("no/such/species.toml: found ", 0) == 0);
}
