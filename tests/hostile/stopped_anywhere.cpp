// Whatever the program is doing when it is asked to stop: it ends soon, says so, and leaves nothing behind.
#include <catch2/catch.hpp>

#include <csignal>
#include <string>
#include <vector>

#include <sunfleck/core/sampling.hpp>

#include "run_program.hpp"

namespace {

/// A crown of small leaves, from a hash: enough to keep every method busy for a second or two.
std::string crown(int leaves) {
  std::string text;
  const auto random = [](std::uint64_t i) { return sunfleck::unit_interval(sunfleck::mix(i)); };
  for (int i = 0; i < leaves; ++i) {
    const double x = random(5 * i), y = random(5 * i + 1), z = random(5 * i + 2), a = 0.05 * random(5 * i + 3),
                 b = 0.05 * random(5 * i + 4);
    const auto vertex = [&](double u, double v, double w) {
      text += "v " + std::to_string(x + u) + " " + std::to_string(y + v) + " " + std::to_string(z + w) + "\n";
    };
    text += "g leaf_" + std::to_string(i) + "\n";
    vertex(0, 0, 0), vertex(a, 0.02, b - a), vertex(a - b, 0.05, a);
    text += "f -3 -2 -1\n";
  }
  return text;
}

std::string stand(const std::string& rest) {
  return "bands = [\"PAR\", \"NIR\"]\n[domain]\nperiodic = [0, 0, 5, 5]\n[sun]\nelevation = 40.0\nazimuth = 100.0\nirradiance = { PAR = "
         "400.0, NIR "
         "= 400.0 }\n[sky]\nmodel = \"standard_overcast\"\nirradiance = { PAR = 100.0, NIR = 80.0 }\n[optics.leaf]\nreflectance = { PAR = "
         "0.1, NIR "
         "= 0.45 }\ntransmittance = { PAR = 0.05, NIR = 0.45 }\n[ground]\ncells = [40, 40]\nreflectance = { PAR = 0.1, NIR = 0.2 "
         "}\n[[plant]]\nname "
         "= \"crown\"\nfile = \"crown.obj\"\noptics = { \"*\" = \"leaf\" }\nplace = [ { grid = { origin = [0, 0], step = [1.0, 1.0], count "
         "= [5, "
         "5], turn = \"random\" } } ]\n" +
         rest;
}

}  // namespace

TEST_CASE("A stop is heard wherever it comes", "[stop]") {
  const TemporaryFolder folder;
  folder.file("crown.obj", crown(2000));
  const std::string plain = folder.file("plain.toml", stand("")),
                    sensors = folder.file("sensors.toml", stand("[[sensor]]\nname = \"s\"\ngrid = { z = 0.5, cells = [200, 200] }\n")),
                    result = folder.path("r.h5");
  const auto before = folder.listing();
  const std::vector<std::vector<std::string>> runs{
      {"solve", plain, "-o", result, "--method", "clustering"},
      {"solve", plain, "-o", result, "--method", "instantiation"},
      {"solve", plain, "-o", result, "--method", "reference"},
      {"solve", sensors, "-o", result},
      {"plan", plain},
  };
  std::uint64_t moment = 0;
  for (const auto& arguments : runs)
    for (int i = 0; i < 3; ++i) {
      ProgramFate fate;
      fate.signal = SIGINT;
      fate.stop_after_s = 0.02 + 1.2 * sunfleck::unit_interval(sunfleck::mix(moment++));
      const auto run = run_sunfleck(arguments, fate);
      INFO(arguments[0] << " " << arguments[1] << " " << arguments.back() << " after " << fate.stop_after_s << " s: " << run.err);
      if (run.exit_code == 128 + SIGINT) continue;  // before the program had begun to listen
      if (run.exit_code == 0) {                     // done before
        std::remove(result.c_str());
        continue;
      }
      CHECK(run.exit_code == 4);
      CHECK(run.err.find("sunfleck: stopped") != std::string::npos);
      CHECK(run.seconds_to_stop < 2);  // half a second, and what a machine that does other things adds
      CHECK(folder.listing() == before);
    }
}
