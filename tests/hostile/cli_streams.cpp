// Standard output and error that cannot be written: data that are lost are an error, messages that are lost are not.
#include <catch2/catch.hpp>

#include <filesystem>

#include "places.hpp"
#include "run_program.hpp"

namespace {

const std::string species = SUNFLECK_SOURCE_DIR "/plants/wheat.toml";

ProgramFate with(const std::string& out, const std::string& err) {
  ProgramFate fate;
  fate.out = out, fate.err = err;
  return fate;
}

}  // namespace

TEST_CASE("Messages that cannot be written change neither the work nor the exit code", "[cli]") {
  const TemporaryFolder folder;
  for (const char* err : {"/dev/full", "closed"}) {
    INFO(err);
    CHECK(run_sunfleck({}, with("", err)).exit_code == 2);
    CHECK(run_sunfleck({"solv"}, with("", err)).exit_code == 2);
    CHECK(run_sunfleck({"solve", "--qualty", "draft"}, with("", err)).exit_code == 2);
    CHECK(run_sunfleck({"info", folder.path("none.opf")}, with("", err)).exit_code == 2);
    const std::string plant = folder.path("wheat.h5");
    CHECK(run_sunfleck({"generate", species, "-o", plant}, with("", err)).exit_code == 0);
    // no message has found its way into a file of ours
    CHECK(run_sunfleck({"info", plant}).exit_code == 0);
    std::filesystem::remove(plant);
  }
}

TEST_CASE("Data that cannot be written to standard output are an error", "[cli]") {
  const std::string lost = "sunfleck: standard output could not be written: what it was to hold is lost\n";
  for (const char* out : {"/dev/full", "closed"}) {
    INFO(out);
    for (const auto& arguments : {std::vector<std::string>{"info", species}, {"--help"}, {"solve", "--help"}, {"--version"}}) {
      INFO(arguments[0]);
      const auto run = run_sunfleck(arguments, with(out, ""));
      CHECK(run.exit_code == 1);
      CHECK(run.err == lost);
    }
    CHECK(run_sunfleck({"info", species}, with(out, "closed")).exit_code == 1);
    CHECK(run_sunfleck({"info", "none.opf"}, with(out, "")).exit_code == 2);
  }
}
