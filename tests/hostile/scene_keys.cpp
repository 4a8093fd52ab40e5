// Scene files with broken TOML, unknown keys and wrong types.
#include <catch2/catch.hpp>

#include <scene_files.hpp>

using namespace sunfleck;

namespace {

std::string message(const std::string& scene) {
  return SceneFiles(scene, {{"two.obj", two_organs}}).message();
}

const std::string light = "bands = [\"PAR\", \"NIR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 1.0, NIR = 1.0 }\n";  // 4 lines

}  // namespace

TEST_CASE("Broken TOML is named with its line", "[hostile][scene]") {
  CHECK(message("bands = [\"PAR\"]\n[sky\nmodel = 1\n") ==
        "scene.toml:2: not valid TOML: Error while parsing table header: expected ']', saw '\\n'");
  CHECK(message("bands = [\"PAR\"]\nbands = [\"NIR\"]\n") ==
        "scene.toml:2: not valid TOML: Error while parsing key-value pair: cannot redefine existing array 'bands'");
  CHECK(message("a = [0, }, 0]\n") == "scene.toml:1: not valid TOML: Error while parsing value: could not determine value type");
  CHECK(message("bands = \n") == "scene.toml:1: not valid TOML: Error while parsing key-value pair: expected value, saw '\\n'");
  CHECK(message("bands = [\"P\xff\"]\n") == "scene.toml:1: not valid TOML: Encountered invalid utf-8 sequence");
  CHECK(message("a = 1\n[sky]\nx = 00\n") ==
        "scene.toml:3: not valid TOML: Error while parsing decimal integer: leading zeroes are prohibited");
}

TEST_CASE("A scene that is no file says so", "[hostile][scene]") {
  const TextFile folder("other.toml", "");
  CHECK(message_of(folder, [&] { read_scene(folder.folder() + "/scene.toml"); }) ==
        "scene.toml: found no such file; expected an existing file");
  CHECK(message_of(folder, [&] { read_scene(folder.folder() + "/."); }) == ".: found a folder; expected a file");
  CHECK(message("") == "scene.toml:1: bands: found nothing; expected the names of the spectral bands, like [\"PAR\", \"NIR\"]");
}

TEST_CASE("All unknown keys are reported at once with the nearest known one", "[hostile][scene]") {
  CHECK(message("band = [\"PAR\"]\n") == "scene.toml:1: band: unknown key; did you mean \"bands\"?");
  CHECK(message(light +
                "[sun]\ndirecton = [0, 0, 1]\nirradiance = { PAR = 1, NRI = 2 }\n[optics.leaf]\nreflectence = { PAR = 0.1, NIR = 0.1 }\n"
                "[[plant]]\nname = \"p\"\nunits = \"cm\"\nplace = [ { positon = [0, 0, 0] },\n { position = [0, 0, 0], trun = 3 } ]\nzzz = "
                "1\n[snu]\nx = 1\n") ==
        "scene.toml:6: sun.directon: unknown key; did you mean \"direction\"?\n"
        "scene.toml:7: sun.irradiance.NRI: unknown key; did you mean \"NIR\"?\n"
        "scene.toml:9: optics.leaf.reflectence: unknown key; did you mean \"reflectance\"?\n"
        "scene.toml:12: plant[0].units: unknown key; did you mean \"unit\"?\n"
        "scene.toml:13: plant[0].place[0].positon: unknown key; did you mean \"position\"?\n"
        "scene.toml:14: plant[0].place[1].trun: unknown key; did you mean \"turn\"?\n"
        "scene.toml:15: plant[0].zzz: unknown key; known here: name, file, unit, age, seed, policy, optics, place, grid\n"
        "scene.toml:16: snu: unknown key; did you mean \"sun\"?");
  CHECK(message("bands = [\"PAR\"]\n[[state]]\nsky = { modell = \"uniform\", irradiance = { PAR = 1 } }\n") ==
        "scene.toml:3: state[0].sky.modell: unknown key; did you mean \"model\"?");
}

TEST_CASE("Wrong types say what was found and what was expected", "[hostile][scene]") {
  CHECK(message("bands = \"PAR\"\n") == "scene.toml:1: bands: found \"PAR\"; expected an array of names, like [\"PAR\", \"NIR\"]");
  CHECK(message("bands = []\n") == "scene.toml:1: bands: found an empty array; expected at least one band");
  CHECK(message("bands = [1]\n") == "scene.toml:1: bands[0]: found 1; expected a string");
  CHECK(message("bands = [\"\"]\n") == "scene.toml:1: bands[0]: found \"\"; expected a string that is not empty");
  CHECK(message("bands = [\"PAR\", \"PAR\"]\n") == "scene.toml:1: bands[1]: found \"PAR\" twice; expected every band once");
  CHECK(message("bands = [\"PAR\"]\nunits = { PAR = \"lux\" }\n") ==
        "scene.toml:2: units.PAR: found \"lux\"; expected one of W m^-2, W m-2, W/m2, umol m^-2 s^-1, umol m-2 s-1, umol/m2/s");
  CHECK(message("bands = [\"PAR\"]\nsky = 3\n") == "scene.toml:2: sky: found 3; expected a table");
  CHECK(message("bands = [\"PAR\"]\n[sky]\nmodel = true\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:3: sky.model: found true; expected a string");
  CHECK(message("bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = 5.0\n") ==
        "scene.toml:4: sky.irradiance: found 5; expected a value per band, like { PAR = ... }");
  CHECK(message("bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = \"1\" }\n") ==
        "scene.toml:4: sky.irradiance.PAR: found \"1\"; expected a number");
  CHECK(message("bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = nan }\n") ==
        "scene.toml:4: sky.irradiance.PAR: found nan; expected a finite number");
  CHECK(message("bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = inf }\n") ==
        "scene.toml:4: sky.irradiance.PAR: found inf; expected a finite number");
  CHECK(message("bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = -1.5 }\n") ==
        "scene.toml:4: sky.irradiance.PAR: found -1.5; expected a number of zero or more");
  CHECK(message(light + "[domain]\n") ==
        "scene.toml:5: domain.periodic: found nothing; expected [xmin, ymin, xmax, ymax] of the cell that repeats [m]");
  CHECK(message(light + "[domain]\nperiodic = [0, 0, 1]\n") ==
        "scene.toml:6: domain.periodic: found an array of 3; expected an array of 4 numbers: xmin, ymin, xmax, ymax [m]");
  CHECK(message(light + "[domain]\nperiodic = [0, 0, 0, 1]\n") ==
        "scene.toml:6: domain.periodic: found [0, 0, 0, 1]; expected xmax above xmin and ymax above ymin");
  CHECK(message(light + "[domain]\nperiodic = [0, 0, \"1\", 1]\n") == "scene.toml:6: domain.periodic[2]: found \"1\"; expected a number");
  CHECK(message(light + "[output]\nfacets = 1\n") == "scene.toml:6: output.facets: found 1; expected true or false");
  CHECK(message(light + "[output]\nfields = [\"facets/absorbd\"]\n") ==
        "scene.toml:6: output.fields[0]: found \"facets/absorbd\"; expected one of facets/irradiance, facets/absorbed, facets/sunlit, "
        "facets/area, facets/centroid, facets/organ, organs/irradiance, organs/absorbed, organs/sunlit, organs/area, variance/facets, "
        "variance/organs, geometry; did you mean "
        "\"facets/absorbed\"?");
  CHECK(message(light + "[output]\nfacets = false\nfields = [\"facets/absorbed\"]\n") ==
        "scene.toml:7: output.fields[0]: found \"facets/absorbed\"; expected a dataset of organs, since facets = false keeps no others");
  CHECK(message(light + "[solve]\nquality = \"standart\"\n") ==
        "scene.toml:6: solve.quality: found \"standart\"; expected one of draft, standard, fine; did you mean \"standard\"?");
  CHECK(message(light + "[solve]\nmethod = \"radiosity\"\n") ==
        "scene.toml:6: solve.method: found \"radiosity\"; expected one of instantiation, clustering, flat, direct, lattice, occlusion, reference");
  CHECK(message(light + "[solve]\nseed = -1\n") == "scene.toml:6: solve.seed: found -1; expected a whole number of at least 0");
  CHECK(message(light + "[solve]\nsamples = 0\n") == "scene.toml:6: solve.samples: found 0; expected a whole number from 1 to 1073741824");
  CHECK(message(light + "[solve]\nsamples = 1.5\n") ==
        "scene.toml:6: solve.samples: found 1.5; expected a whole number from 1 to 1073741824");
}
