// What the program chooses by itself on mixed scenes, against path tracing: tools/mixtures as its user runs it.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <string>

#include "places.hpp"
#include "run_program.hpp"

// 95 % of them within 1.5 times the aim, none beyond three times without a word.
TEST_CASE("mixtures: of small mixed scenes the default is right, or says that it is not", "[mixtures]") {
  if (std::system("/usr/bin/python3 -c 'import h5py, numpy' 2> /dev/null") != 0) {
    WARN("skipped: python3-h5py is not installed");
    return;
  }
  const TemporaryFolder folder;
  const std::string command = SUNFLECK_SOURCE_DIR "/tools/mixtures --program " SUNFLECK_PROGRAM " --work " + folder.path("work") + " > " +
                              folder.path("table") + " 2> " + folder.path("log");
  const int status = std::system(command.c_str());
  INFO(text_of(folder.path("table")) << text_of(folder.path("log")));
  CHECK(status == 0);
}
