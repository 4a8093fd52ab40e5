// One call of the system fails, once, wherever that is: what existed is as it was or the new file is whole, nothing else is left, and the
// program ends by itself with a message. A sample by default; SUNFLECK_FAULTS=N takes N calls of each kind in each run, spread evenly over
// all that there are (a large N: every call), and prints a table.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/result/result_reader.hpp>

#include "places.hpp"
#include "run_program.hpp"
#include "sanitized.hpp"

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> kinds{"open", "read", "write", "rename", "fsync", "malloc"};

struct Work {
  std::string name;
  std::vector<std::string> arguments, outputs;  ///< outputs: names in the folder
};

/// Inputs, older outputs of all works, and what each work makes of them where nothing fails.
class Bench {
 public:
  Bench() {
    const std::string species = SUNFLECK_SOURCE_DIR "/plants/wheat.toml";
    folder_.file("leaf.obj", "mtllib leaf.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    folder_.file("leaf.mtl", "newmtl green\n");
    folder_.file("plants.can", "p 1 100001001000 3 0 0 1 1 0 1 0 1 1\n");
    const std::string scene = folder_.file(
        "scene.toml",
        "bands = [\"PAR\"]\n[sun]\ndirection = [0, 0.3, 0.9]\nirradiance = { PAR = 100 }\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = "
        "100 }\n[optics.leaf]\nreflectance = { PAR = 0.1 }\n[ground]\nsize = [2, 2]\ncells = [2, 2]\nreflectance = { PAR = 0.1 }\n"
        "[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\noptics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 0.5] } ]\n");
    const std::string old = at("old.h5");
    REQUIRE(run_sunfleck({"solve", scene, "-o", old, "--method", "clustering", "--quality", "draft", "--threads", "1", "--no-certificate"})
                .exit_code == 0);
    works_ = {
        {"solve",
         {"solve", scene, "-o", at("r.h5"), "--method", "clustering", "--quality", "draft", "--no-certificate", "--threads", "1"},
         {"r.h5"}},
        {"solve by copies",
         {"solve", scene, "-o", at("r.h5"), "--method", "instantiation", "--quality", "draft", "--certificate-rays", "1000", "--threads",
          "1"},
         {"r.h5"}},
        {"generate .h5", {"generate", species, "-o", at("w.h5"), "--age", "5"}, {"w.h5"}},
        {"generate .obj", {"generate", species, "-o", at("w.obj"), "--age", "5"}, {"w.obj", "w.mtl"}},
        {"import", {"import", at("plants.can"), "-o", at("new.toml")}, {"new.toml"}},
        {"originals", {"originals", scene, "--cache", at("cache"), "--threads", "1"}, {}},
        {"render .png", {"render", old, "-o", at("p.png"), "--width", "40", "--height", "30", "--samples", "1"}, {"p.png"}},
        {"render .exr", {"render", old, "-o", at("p.exr"), "--width", "40", "--height", "30", "--samples", "1"}, {"p.exr"}},
    };
    for (const std::string name : {"m.ply", "m.glb", "m.vtkhdf", "o.csv", "o.opf"})
      works_.push_back({"export " + fs::path(name).extension().string(), {"export", old, "-o", at(name)}, {name}});
    works_.push_back({"export .obj", {"export", old, "-o", at("m.obj")}, {"m.obj", "m.mtl"}});
    works_.push_back({"export .xdmf", {"export", old, "-o", at("m.xdmf")}, {"m.xdmf", "m.xdmf.h5"}});
    for (auto& work : works_) {
      const auto run = run_sunfleck(work.arguments);
      INFO(work.name << "\n" << run.err);
      REQUIRE(run.exit_code == 0);
      for (const auto& output : work.outputs) whole_[output] = text_of(at(output));
    }
    restore();
    inputs_ = snapshot();
  }

  const std::vector<Work>& works() const { return works_; }

  /// How many calls of a kind a run makes.
  long count(const Work& work, const std::string& kind) {
    restore();
    const std::string file = at("count");
    ProgramFate fate = with(kind, 0);
    fate.environment.push_back("SUNFLECK_FAULT_COUNT=" + file);
    run_sunfleck(work.arguments, fate);
    const long calls = std::atol(text_of(file).c_str());
    fs::remove(file);
    return calls;
  }

  /// Empty, or what is wrong after the Nth call of a kind has failed.
  std::string trouble(const Work& work, const std::string& kind, long n) {
    restore();
    const auto run = run_sunfleck(work.arguments, with(kind, n));
    last_code = run.exit_code;
    // HDF5 1.10 does not survive every refusal of its own memory: then files must be as they were, beside what the next run removes
    const bool killed = kind == "malloc" && run.exit_code >= 128;
    if (run.exit_code >= 128 && !killed) return fmt::format("ended by signal {}: {}", run.exit_code - 128, run.err);
    if (!killed && run.exit_code != 0 && run.exit_code != 1 && run.exit_code != 2 && run.exit_code != 5)
      return fmt::format("exit code {}: {}", run.exit_code, run.err);
    if (!killed && run.exit_code != 0 && run.err.find("sunfleck") == std::string::npos) return "no message: " + run.err;
    auto now = snapshot();
    for (const auto& [name, bytes] : inputs_) {
      if (!now.count(name)) return name + " is gone: " + run.err;
      if (now[name] == bytes) continue;
      if (!whole_.count(name)) return name + " is another: " + run.err;
    }
    for (const auto& [name, bytes] : now) {
      if (!inputs_.count(name) && run.exit_code != 0 && kind == "malloc" && name.find(".partial-") != std::string::npos) continue;
      if (!inputs_.count(name)) return name + " is left: " + run.err;
      if (!whole_.count(name) || bytes == inputs_[name]) continue;
      if (const auto why = broken(name, bytes); !why.empty()) return name + " " + why + ": " + run.err;
    }
    for (const auto& name : work.outputs)
      if (run.exit_code == 0 && now[name] == inputs_[name] && now[name] != whole_[name])
        return name + " is the older one though the exit code is 0: " + run.err;
    return {};
  }

  int last_code = 0;

 private:
  std::string at(const std::string& name) const { return folder_.path(name); }

  ProgramFate with(const std::string& kind, long n) const {
    ProgramFate fate;
    fate.environment = {"LD_PRELOAD=" SUNFLECK_FAULTS_LIBRARY, fmt::format("SUNFLECK_FAULT={}:{}", kind, n)};
    fate.seconds = 120;
    return fate;
  }

  /// Outputs as of a day before, and no cache.
  void restore() const {
    for (const auto& name : folder_.listing())
      if (name.find(".partial-") != std::string::npos) fs::remove(at(name));
    for (const auto& [name, bytes] : whole_) {
      const bool beside = name == "w.mtl" || name == "m.mtl";
      if (name == "m.xdmf.h5")
        folder_.file(name, bytes + "older");  // HDF5 minds nothing beyond its end
      else if (name == "new.toml")
        fs::remove(at(name)), folder_.file(name, bytes);
      else
        folder_.file(name, beside ? bytes + "# older\n" : "older " + name);
    }
    fs::remove_all(at("cache"));
  }

  std::map<std::string, std::string> snapshot() const {
    std::map<std::string, std::string> files;
    for (const auto& name : folder_.listing())
      if (name != "cache") files[name] = text_of(at(name));
    if (fs::exists(at("cache")))
      for (const auto& entry : fs::directory_iterator(at("cache")))
        if (entry.path().filename().string()[0] == '.') files["cache/" + entry.path().filename().string()] = "left";
    return files;
  }

  /// Why a file that is not the older one is not the new one.
  std::string broken(const std::string& name, const std::string& bytes) const {
    if (name != "r.h5") return bytes == whole_.at(name) ? "" : "is neither the older one nor whole";
    try {  // times differ: all that is asked of it is read
      const sunfleck::Result result(at(name));
      if (result.all<float>("facets/irradiance").empty() || result.all<float>("organs/absorbed").empty()) return "is empty";
      result.geometry();
      return "";
    } catch (const std::exception& error) {
      return std::string("cannot be read: ") + error.what();
    }
  }

  TemporaryFolder folder_;
  std::vector<Work> works_;
  std::map<std::string, std::string> whole_, inputs_;
};

}  // namespace

TEST_CASE("one call of the system that fails costs no file and no order", "[faults]") {
  if (sanitized) return;  // its own allocator comes first
  const char* wish = std::getenv("SUNFLECK_FAULTS");
  const long per_kind = wish ? std::atol(wish) : 1;
  Bench bench;
  std::size_t turn = 0;  // by default each work meets a third of the kinds
  for (const auto& work : bench.works()) {
    ++turn;
    for (const auto& kind : kinds) {
      if (!wish && turn++ % 3 != 0) continue;
      const long calls = bench.count(work, kind), tried = std::min(calls, per_kind);
      std::map<int, long> codes;
      for (long i = 0; i < tried; ++i) {
        const long n =
            tried == calls
                ? i + 1
                : 1 + static_cast<long>((static_cast<double>(i) + 0.5) / static_cast<double>(tried) * static_cast<double>(calls));
        const std::string trouble = bench.trouble(work, kind, n);
        ++codes[bench.last_code];
        INFO(work.name << ", " << kind << " " << n << " of " << calls);
        CHECK(trouble == "");
      }
      if (wish) {
        std::string text;
        for (const auto& [code, times] : codes) text += fmt::format(" {} x exit {}", times, code);
        fmt::print("| {} | {} | {} | {} |{} |\n", work.name, kind, calls, tried, text);
      }
    }
  }
}
