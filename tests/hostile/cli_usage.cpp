// What the program says to bad usage: exit code 2, the nearest name, nothing on standard output.
#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "run_program.hpp"

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("every verb explains itself", "[cli]") {
  const ProgramRun program = run_sunfleck({"--help"});
  CHECK(program.exit_code == 0);
  CHECK(program.err.empty());
  for (const std::string verb :
       {"solve", "plan", "compare", "export", "import", "render", "generate", "view", "info", "originals", "policy"}) {
    INFO(verb);
    CHECK(contains(program.out, "\n  " + verb + " "));
    const ProgramRun run = run_sunfleck({verb, "--help"});
    CHECK(run.exit_code == 0);
    CHECK(run.err.empty());
    CHECK(contains(run.out, "Usage: sunfleck " + verb));
    CHECK(contains(run.out, "Example"));
    CHECK(contains(run.out, "  sunfleck " + verb + " "));
  }
}

TEST_CASE("the version is one line on standard output", "[cli]") {
  const ProgramRun run = run_sunfleck({"--version"});
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());
  CHECK(run.out.rfind("sunfleck ", 0) == 0);
  CHECK(std::count(run.out.begin(), run.out.end(), '\n') == 1);
}

TEST_CASE("without a verb the help goes to standard error", "[cli]") {
  const ProgramRun run = run_sunfleck({});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK(contains(run.err, "Usage: sunfleck"));
}
