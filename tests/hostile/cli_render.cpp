// What `sunfleck render` does with options and files that cannot be: exit code 2, one message, no picture.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "result_scene.hpp"
#include "run_program.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

void write_result(const std::string& file, bool with_irradiance = true) {
  Scene scene = small_scene();
  OutputChoice output;
  if (!with_irradiance) output.fields = {"facets/absorbed", "geometry"};
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const Values values(facets);
  ResultWriter writer(file, scene, placed, output, "0.1.0", "flat");
  values.send(writer, 1000);
  writer.finish(small_report());
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("render refuses what cannot be and writes nothing", "[cli][view]") {
  const TemporaryFolder folder;
  const std::string result = folder.path("r.h5"), picture = folder.path("p.png");
  write_result(result);
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"--quantity", "absorbd"}, "(did you mean 'absorbed'?)"},
      {{"--quantity", "absorbed", "--band", "PAT"},
       "--band: found 'PAT'; expected one of those in " + result + ": PAR, NIR (did you mean 'PAR'?)"},
      {{"--state", "nooon"}, "(did you mean 'noon'?)"},
      {{"--colormap", "virdis"}, "(did you mean 'viridis'?)"},
      {{"--quantity", "absorbed", "--range", "5", "1"}, "--range: found 5 1; expected two finite numbers, the lower first"},
      {{"--quantity", "absorbed", "--log", "--range", "0", "1"}, "--range: found 0 with --log; expected numbers above zero"},
      {{"--width", "0"}, "--width: found '0'"},
      {{"--eye", "1", "1", "1", "--target", "1", "1", "1"}, "camera: found the same point as eye and target"},
      {{"--elevation", "nan"}, "--elevation: found 'nan'"},
      {{"--views", "front,tpo"},
       "--views: found 'tpo'; expected some of camera, front, back, left, right, top, bottom (did you mean 'top'?)"},
      {{"--cut", "q=1"}, "--cut: found 'q=1'; expected x, y or z, '=' and a number in metres, or six numbers x,y,z,nx,ny,nz"},
      {{"--cut", "x=one"}, "--cut: found 'x=one'"},
      {{"--cut", "0,0,0,0,0,0"}, "--cut: found '0,0,0,0,0,0'"},
      {{"--cut", "0,0,0,1,0"}, "--cut: found '0,0,0,1,0'"},
      {{"--scale-bar"}, "--scale-bar: found no parallel projection"},
      {{"--rgb", "NIR", "PAR", "UV"}, "--rgb: found 'UV'; expected three of the bands in " + result + ": PAR, NIR"},
      {{"--background", "black"}, "--background: found 'black'"},
      {{"--quantity", "organ_error"}, "--quantity organ_error: found no reference; expected --reference RESULT.h5"},
      {{"--quantity", "error", "--reference", folder.path("none.h5")}, "none.h5"},
      {{"--quantity", "error", "--log", "--reference", result}, "--log: found with --quantity error, which has both signs"},
  };
  for (const auto& [options, message] : wrong) {
    std::vector<std::string> arguments{"render", result, "-o", picture};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto run = run_sunfleck(arguments);
    INFO(message << "\n" << run.err);
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err, message));
  }
  CHECK(run_sunfleck({"render", result, "-o", folder.path("p.jpg")}).exit_code == 2);
  CHECK(run_sunfleck({"render", result, "-o", result}).exit_code == 2);
  CHECK(run_sunfleck({"render", folder.path("none.h5"), "-o", picture}).exit_code == 2);
  CHECK(run_sunfleck({"render", folder.file("text.h5", "not HDF5"), "-o", picture}).exit_code == 2);
  write_result(folder.path("bare.h5"), false);
  const auto bare = run_sunfleck({"render", folder.path("bare.h5"), "-o", picture});
  CHECK(bare.exit_code == 2);
  CHECK(contains(bare.err, "facets/irradiance: found nothing; expected irradiance of facets or organs"));
  CHECK(folder.listing() == std::vector<std::string>{"bare.h5", "r.h5", "text.h5"});
}

TEST_CASE("render draws, and keeps the old picture on a full disk", "[cli][view]") {
  const TemporaryFolder folder;
  const std::string result = folder.path("r.h5"), picture = folder.file("p.png", "old");
  write_result(result);
  ProgramFate fate;
  fate.disk_bytes = 256;  // less than any picture
  const auto full = run_sunfleck({"render", result, "-o", picture, "--width", "64", "--height", "48"}, fate);
  CHECK(full.exit_code == 1);
  CHECK(text_of(picture) == "old");
  const auto good = run_sunfleck({"render", result, "-o", picture, "--width", "64", "--height", "48", "--quantity", "type"});
  INFO(good.err);
  CHECK(good.exit_code == 0);
  CHECK(text_of(picture).substr(1, 3) == "PNG");
  const std::string layers = folder.file("p.exr", "old");
  CHECK(run_sunfleck({"render", result, "-o", layers, "--width", "64", "--height", "48"}, fate).exit_code == 1);
  CHECK(text_of(layers) == "old");
  CHECK(run_sunfleck({"render", result, "-o", layers, "--width", "64", "--height", "48", "--views", "camera,top", "--cut", "y=1"})
            .exit_code == 0);
  CHECK(text_of(layers).substr(0, 4) == "v/1\x01");
  CHECK(folder.listing() == std::vector<std::string>{"p.exr", "p.png", "r.h5"});
}
