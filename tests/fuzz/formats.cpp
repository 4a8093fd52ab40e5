#include "fuzz/formats.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>

#include <unistd.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sha256.hpp>
#include <sunfleck/format/ies.hpp>
#include <sunfleck/format/import_scene.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/format/species_toml.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/result/compare.hpp>
#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/scene/counts.hpp>

#include "fuzz/h5_recipe.hpp"
#include "original/entry.hpp"

namespace sunfleck::fuzz {

namespace {

using Bytes = std::span<const std::uint8_t>;

/// A folder in memory where there is one, for files that parsers want by name.
class Folder {
 public:
  Folder() {
    const std::filesystem::path memory = "/dev/shm";
    path_ = (std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path()) /
            ("sunfleck_fuzz_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
    put("leaf.obj", "g Leaf\nusemtl green\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put("positions.csv", "x,y\n0,0\n2,1\n");
    put("field.can", "p 1 100001000000 3 0 0 50 10 0 50 0 10 50\n");
    put("lamp.ies", "TILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 100\n0 90\n0\n1 0\n");
    put("par.opt", "s d 0.15\ne d 0.10 d 0.11 0.05 d 0.12 0.05\n");
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string put(const std::string& name, const std::string& content) const {
    const auto file = path_ / name;
    std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
    return file.string();
  }
  std::string put(const std::string& name, Bytes content) const {
    const auto file = path_ / name;
    std::ofstream(file, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
    return file.string();
  }

 private:
  std::filesystem::path path_;
};

const Folder& folder() {
  static const Folder only;
  return only;
}

void read_all_of_result(const std::string& file) {
  const Result r(file);
  (void)r.organs(), r.materials(), r.balance(), r.profile(), r.convergence(), r.spectral_radius(), r.timings(), r.counts(), r.memory();
  (void)r.certificate(), r.periodic(), r.geometry();
  for (const char* name : {"facets/irradiance", "facets/absorbed", "facets/sunlit", "organs/irradiance", "organs/absorbed"})
    if (r.has(name)) (void)r.all<float>(name);
  if (r.facet_count() > 0) (void)r.facet_organs(0, r.facet_count());
  (void)compare(r, r);
}

void read_plant_as(const char* name, Bytes bytes) {
  const Plant plant = read_plant(folder().put(name, bytes), 0.01);
  check_plant(plant);  // what a reader lets through is sound
}

/// What a photometric file lets through shines finitely, whatever the direction.
void read_lamp(Bytes bytes) {
  const Photometry lamp = read_ies(folder().put("lamp.ies", bytes));
  for (const Vec3& d : {Vec3{0, 0, -1}, Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{-0.6, 0, -0.8}, Vec3{0.48, 0.64, 0.6}})
    if (const double i = lamp.intensity(d); !(i >= 0) || !std::isfinite(i)) throw std::logic_error("a lamp that shines without measure");
}

void read_and_write_policy(Bytes bytes) {
  const std::string text = policy_text(read_policy(folder().put("policy.toml", bytes)));
  try {
    if (policy_text(read_policy(folder().put("written.toml", text))) != text) throw std::logic_error("a policy reads back as another");
  } catch (const InputError& error) {
    throw std::logic_error(std::string("written, but not read: ") + error.what());
  }
}

/// The numbers of a cache entry under a head that fits them, which random bytes do not find.
void read_original(Bytes bytes) {
  const std::string key(64, '0'), numbers(bytes.begin(), bytes.end());
  const auto tables = from_entry("sunfleck-original 1\n" + key + "\n" + sha256_hex(numbers) + "\n" + numbers, key);
  if (!tables) throw InputError("entry", "another", "one that was written");
  if (!from_entry(to_entry(*tables, key), key)) throw std::logic_error("an entry is not read back");
  (void)tables->transmittance({0, 0, 1}), (void)tables->scattered({0.6, 0, 0.8}, {0, 0.6, -0.8}, 0);
  (void)transformed(*tables, Mat3(2.0));
}

/// What an import lets through is a scene that is read.
void import_with(std::vector<std::string> files) {
  ImportChoice choice;
  choice.files = std::move(files);
  choice.output = folder().put("imported.toml", std::string());
  const ImportedScene imported = import_scene(choice);
  folder().put("imported.toml", imported.text);
  try {
    check_scene(read_scene(choice.output));
  } catch (const InputError& error) {
    throw std::logic_error(std::string("imported, but not read: ") + error.what());
  }
}

const std::map<std::string, std::function<void(Bytes)>>& readers() {
  static const std::map<std::string, std::function<void(Bytes)>> all{
      {"can", [](Bytes b) { read_plant_as("plant.can", b); }},
      {"csv",
       [](Bytes b) {
         folder().put("fuzzed.csv", b);
         static const std::string scene = folder().put(
             "with_csv.toml",
             "bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 1.0 }\n[optics.leaf]\nreflectance = { PAR = 0.1 }\n"
             "[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\noptics = { \"*\" = \"leaf\" }\nplace = [ { file = \"fuzzed.csv\" } ]\n");
         check_scene(read_scene(scene));
       }},
      {"ies", [](Bytes b) { read_lamp(b); }},
      {"light",
       [](Bytes b) {
         import_with({folder().file("field.can"), folder().file("par.opt"), folder().put("fuzzed.light", b)});
       }},
      {"obj", [](Bytes b) { read_plant_as("plant.obj", b); }},
      {"ops", [](Bytes b) { import_with({folder().put("fuzzed.ops", b)}); }},
      {"opt",
       [](Bytes b) {
         import_with({folder().file("field.can"), folder().put("fuzzed.opt", b)});
       }},
      {"opf", [](Bytes b) { read_plant_as("plant.opf", b); }},
      {"original", [](Bytes b) { read_original(b); }},
      {"pattern",
       [](Bytes b) {
         import_with({folder().file("field.can"), folder().file("par.opt"), folder().put("fuzzed.8", b)});
       }},
      {"plant_h5", [](Bytes b) { read_plant_as("plant.h5", changed_plant_file(b)); }},
      {"ply", [](Bytes b) { read_plant_as("plant.ply", b); }},
      {"policy", [](Bytes b) { read_and_write_policy(b); }},
      {"result_h5", [](Bytes b) { read_all_of_result(folder().put("result.h5", changed_result_file(b))); }},
      {"scene",
       [](Bytes b) {
         const Scene scene = read_scene(folder().put("scene.toml", b));
         check_scene(scene);
         (void)count(scene);
       }},
      {"sky",
       [](Bytes b) {
         folder().put("fuzzed_sky.csv", b);
         static const std::string scene = folder().put("with_sky.toml",
                                                       "bands = [\"PAR\"]\n[sky]\nmodel = \"file\"\nfile = \"fuzzed_sky.csv\"\nirradiance "
                                                       "= { PAR = 1.0 }\n[optics.leaf]\nreflectance = { "
                                                       "PAR = 0.1 }\n[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\noptics = { \"*\" = "
                                                       "\"leaf\" }\nplace = [ { position = [0, 0, 0] } ]\n");
         const Scene read = read_scene(scene);
         check_scene(read);
         for (const Vec3& d : {Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}, Vec3{0, -1, 1e-300}})
           if (const double r = read.states.at(0).sky->relative_radiance(d); !(r >= 0) || !std::isfinite(r))
             throw std::logic_error("a sky that shines without measure");
       }},
      {"species", [](Bytes b) { (void)read_species(folder().put("species.toml", b)); }},
  };
  return all;
}

}  // namespace

const std::vector<std::string>& formats() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, reader] : readers()) all.push_back(name);
    return all;
  }();
  return names;
}

bool feed(const std::string& format, Bytes bytes) {
  const auto reader = readers().find(format);
  if (reader == readers().end()) throw std::invalid_argument("no parser named " + format);
  try {
    reader->second(bytes);
    return true;
  } catch (const InputError&) {
    return false;
  } catch (const UsageError&) {  // a file that leaves a choice to its user: an .ops with several scenes
    return false;
  }
}

}  // namespace sunfleck::fuzz
