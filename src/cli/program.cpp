// Parses the command line (the only translation unit that pays for CLI11), runs a verb, maps errors to exit codes.
#include <sunfleck/cli/program.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <functional>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <sunfleck/cli/verbs.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/version.hpp>
#include <sunfleck/view/export.hpp>
#include <sunfleck/view/stored.hpp>

#include "cli/terminal_progress.hpp"

namespace sunfleck {

namespace {

enum ExitCode { done = 0, failed = 1, bad_input = 2, stopped = 4 };  // 3, not converged, is a verb's own answer

/// What a number may be, for the check and for the help text. CLI11's own ranges let NaN pass and do not say what they found.
CLI::Validator number_between(double low, double high, bool whole = false) {
  const bool open_above = high == std::numeric_limits<double>::infinity();
  const std::string allowed = fmt::format("a {}number {}", whole ? "whole " : "",
                                          open_above ? fmt::format("of at least {}", low) : fmt::format("from {} to {}", low, high));
  return CLI::Validator(
      [=](std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool is_number = !text.empty() && *end == '\0' && std::isfinite(value) && (!whole || value == std::floor(value));
        const bool plain = !whole || text.find_first_not_of("0123456789") == std::string::npos;  // "1e3" would not convert
        if (is_number && plain && value >= low && value <= high) return std::string();
        return fmt::format("found '{}'; expected {}", text, allowed);
      },
      "");
}
CLI::Validator count_from(double low, double high = 9007199254740992.0) {
  return number_between(low, high, true);
}

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// One of a few names; says which is nearest.
CLI::Validator one_of(std::vector<std::string> names) {
  return CLI::Validator(
      [names](std::string& text) {
        for (const auto& name : names)
          if (text == name) return std::string();
        const std::string near = nearest_name(text, names);
        return fmt::format("found '{}'; expected one of {}{}", text, joined(names), near.empty() ? "" : " (did you mean '" + near + "'?)");
      },
      "");
}

/// Options and what runs them, one per verb.
struct Verbs {
  SolveOptions solve;
  PlanOptions plan;
  CompareOptions compare;
  ExportOptions exporting;
  ImportOptions importing;
  RenderOptions render;
  ViewOptions view;
  GenerateOptions generate;
  InfoOptions info;
  OriginalsOptions originals;
  PolicyOptions policy;
};

constexpr const char* method_help =
    "how scattered light is found: 'clustering' (cluster tree and links; the default), 'flat' (every facet with every other it "
    "sees), 'direct' (no scattering) or 'reference' (path tracing)";
constexpr const char* quality_help = "accuracy against time: 'draft', 'standard' (the default) or 'fine'";
const std::vector<std::string> qualities{"draft", "standard", "fine"};

void add_solve(CLI::App& verb, SolveOptions& o) {
  verb.add_option("SCENE", o.scene, "scene file, TOML")->required()->type_name("");
  verb.add_option("-o,--output", o.result, "result to write, HDF5; replaced only when the new one is complete")
      ->required()
      ->type_name("RESULT.h5");
  verb.add_option("--method", o.method, method_help)->type_name("NAME");
  verb.add_option("--quality", o.quality, quality_help)->type_name("NAME")->check(one_of(qualities));
  verb.add_option("--error", o.error,
                  "wanted rms error of an organ's absorbed light, as a fraction of the mean (0.01 is 1 %): takes the cheapest quality "
                  "that aims at it; the certificate tells what was reached")
      ->type_name("FRACTION")
      ->check(number_between(1e-4, 0.5));
  verb.add_option("--samples", o.samples, "reference method only: paths per facet")->type_name("N")->check(count_from(16, 4294967295.0));
  verb.add_option("--threads", o.threads, "threads to use; 0 is all cores. The result has the same bits for any number")
      ->type_name("N")
      ->check(count_from(0, 4096));
  verb.add_option("--seed", o.seed, "seed of all sampling (default 1)")->type_name("N")->check(count_from(0));
  verb.add_flag_callback(
      "--no-certificate", [&o] { o.certificate = false; }, "skip the check of the result against path tracing; the result then says so");
  verb.add_option("--certificate-organs", o.certificate_organs,
                  "organs that the check path-traces (default 240): more of them narrow its interval")
      ->type_name("N")
      ->check(count_from(2, 1e6));
  verb.add_option("--certificate-rays", o.certificate_rays,
                  "rays that the check spends, about (default 0.6 to 2 million, by the size of the scene): more of them lessen its noise")
      ->type_name("N")
      ->check(count_from(1, 1e12));
  verb.footer(
      "The table on standard output holds, per lighting state and band, incident and absorbed light [W, or umol/s where the scene says "
      "so],\n"
      "the absorbed fraction, the albedo, the balance's residual and the certified error.\n\n"
      "Exit codes: 0 done, 1 the result could not be written, 2 bad usage or input, 3 not converged (result written), 4 stopped.\n\n"
      "Examples:\n"
      "  sunfleck solve plants/stand.toml -o stand.h5\n"
      "  sunfleck solve field.toml -o draft.h5 --quality draft --no-certificate\n"
      "  sunfleck solve field.toml -o truth.h5 --method reference --samples 4096");
}

void add_plan(CLI::App& verb, PlanOptions& o) {
  verb.add_option("SCENE", o.scene, "scene file, TOML")->required()->type_name("");
  verb.add_option("--method", o.method, method_help)->type_name("NAME");
  verb.add_option("--quality", o.quality, quality_help)->type_name("NAME")->check(one_of(qualities));
  verb.add_flag("--json", o.json, "print JSON instead of text");
  verb.footer(
      "Examples:\n"
      "  sunfleck plan field.toml\n"
      "  sunfleck plan field.toml --quality fine --json");
}

void add_compare(CLI::App& verb, CompareOptions& o) {
  verb.add_option("RESULT", o.result, "result to judge, HDF5")->required()->type_name("");
  verb.add_option("REFERENCE", o.reference, "result to judge it by, HDF5; where it holds variances its own noise is taken out")
      ->required()
      ->type_name("");
  verb.add_flag("--json", o.json, "print JSON instead of a table");
  verb.footer(
      "Both must be results of the same scene. Errors are of absorbed power per area, weighted by area, as fractions of the mean.\n\n"
      "Example:\n"
      "  sunfleck compare stand.h5 truth.h5");
}

void add_export(CLI::App& verb, ExportOptions& o) {
  verb.add_option("RESULT", o.result, "result of 'sunfleck solve', HDF5")->required()->type_name("");
  verb.add_option("-o,--output", o.output,
                  "file to write: .ply, .obj, .glb, .vtkhdf and .xdmf are lit meshes, .csv a table per organ, .opf a plant with its light "
                  "as attributes")
      ->required()
      ->type_name("FILE");
  verb.add_option("--quantity", o.quantity,
                  "mesh only: what colours show: 'colour' (natural, the default), or a map of one of " + joined(mesh_quantities()))
      ->type_name("NAME");
  verb.add_option("--band", o.band, "mesh only: the band of that map (default PAR, else the first)")->type_name("NAME");
  verb.add_option("--state", o.state,
                  "mesh only: the one lighting state to keep, by name or number from 1 (default all, coloured by the first)")
      ->type_name("NAME");
  verb.add_option(
          "--by", o.by,
          "table only: sums of organs by plant, placement, type, name, order, layer (or layer:DEPTH, in metres), or any attribute of the "
          "plants; several are separated by commas")
      ->type_name("KEYS");
  verb.add_option("--copy", o.copy, ".opf only: which copy of a plant, by its placement, such as 'coffee[3]' (default the only one)")
      ->type_name("PLACEMENT");
  verb.add_option("--original", o.original,
                  ".opf only: copy this OPF as it is and add the attributes (default: write the plant from the result)")
      ->type_name("PLANT.opf");
  verb.footer(
      "Units: irradiance and absorbed light of facets [W m^-2], absorbed light of organs [W], areas [m^2], lengths [m].\n\n"
      "Examples:\n"
      "  sunfleck export stand.h5 -o stand.ply\n"
      "  sunfleck export stand.h5 -o stand.glb --quantity absorbed --band NIR\n"
      "  sunfleck export stand.h5 -o organs.csv\n"
      "  sunfleck export stand.h5 -o profile.csv --by type,layer:0.5");
}

void add_import(CLI::App& verb, ImportOptions& o) {
  auto& c = o.choice;
  verb.add_option("FILE", c.files, "one .ops (AMAP); or one .can with .opt (a band each), .light and .8 (CARIBU)")
      ->required()
      ->type_name("");
  verb.add_option("-o,--output", c.output, "scene file to write; it names the files where they are")->required()->type_name("SCENE.toml");
  verb.add_option("--unit", c.unit, "length unit of .can and .8 (default m), or of an .ops' plants (default cm): m, cm, mm, inch, foot")
      ->type_name("UNIT");
  verb.add_flag("--degrees", c.degrees, ".ops only: its angles are degrees (default radians)");
  verb.add_flag("--finite", c.finite, ".ops only: the terrain does not repeat");
  verb.add_option("--scene", c.scene_id, ".ops with several scenes: the sceneId to take")->type_name("N");
  verb.add_flag("--soil", c.soil, ".can only: a soil of the pattern's size at the lowest point, with the reflectance of the .opt files");
  verb.add_flag("--light-states", c.light_states, ".light only: every direction a state of its own, also where they stand for a known sky");
  verb.footer(
      "Examples:\n"
      "  sunfleck import orchard.ops -o orchard.toml\n"
      "  sunfleck import maize.can par.opt nir.opt sky.light maize.8 --unit cm --soil -o maize.toml");
}

void add_render(CLI::App& verb, RenderOptions& o) {
  verb.add_option("RESULT", o.result, "result of 'sunfleck solve', HDF5")->required()->type_name("");
  verb.add_option("-o,--output", o.output,
                  "picture to write; .exr keeps light before tone mapping, depth, and the rows of organs and facets")
      ->required()
      ->type_name("IMAGE.png|.exr");
  verb.add_option("--quantity", o.quantity,
                  "what is drawn: 'colour' (natural colour, the default), or a map with a legend of one of " + joined(quantity_names()))
      ->type_name("NAME")
      ->check(one_of(quantity_names()));
  verb.add_option("--band", o.band, "band of a map (default PAR, else the first), or the one band that natural colour is made from")
      ->type_name("NAME");
  verb.add_option("--rgb", o.rgb,
                  "bands that natural colour takes as red, green and blue (default those named R, G, B, else PAR in leaf colours)")
      ->expected(3)
      ->type_name("RED GREEN BLUE");
  verb.add_option("--reference", o.reference, "result that 'error' and 'organ_error' compare with")->type_name("RESULT.h5");
  verb.add_option("--state", o.state, "lighting state, by name or by number from 1 (default the first)")->type_name("NAME");
  verb.add_option("--colormap", o.colormap, "colours of a map: " + joined(color_map_names()) + " (default viridis; difference for errors)")
      ->type_name("NAME")
      ->check(one_of(color_map_names()));
  verb.add_option("--range", o.range, "lowest and highest value of a map, in the quantity's unit (default from the data)")
      ->expected(2)
      ->type_name("LOW HIGH")
      ->check(number_between(-unlimited, unlimited));
  verb.add_flag("--log", o.logarithmic, "logarithmic map");
  auto* eye = verb.add_option("--eye", o.eye, "camera position [m] (default as near as all plants are in the picture)")
                  ->expected(3)
                  ->type_name("X Y Z")
                  ->check(number_between(-unlimited, unlimited));
  verb.add_option("--target", o.target, "point that the camera looks at [m] (default the middle of the plants)")
      ->expected(3)
      ->type_name("X Y Z")
      ->check(number_between(-unlimited, unlimited));
  verb.add_option("--azimuth", o.azimuth_deg, "where the camera stands [degrees from north over east] (default 150)")
      ->type_name("DEGREES")
      ->check(number_between(-360, 360))
      ->excludes(eye);
  verb.add_option("--elevation", o.elevation_deg, "height of the camera above the horizon [degrees] (default 25)")
      ->type_name("DEGREES")
      ->check(number_between(-90, 90))
      ->excludes(eye);
  verb.add_option("--fov,--field-of-view", o.field_of_view_deg, "vertical opening of the camera [degrees] (default 35)")
      ->type_name("DEGREES")
      ->check(number_between(1, 120));
  verb.add_flag("--orthographic", o.orthographic, "parallel projection instead of perspective");
  verb.add_option("--width", o.width, "pixels (default 1200)")->type_name("N")->check(count_from(16, 16384));
  verb.add_option("--height", o.height, "pixels (default 900)")->type_name("N")->check(count_from(16, 16384));
  verb.add_option("--samples", o.samples, "rays per pixel, rounded up to a square number (default 9)")
      ->type_name("N")
      ->check(count_from(1, 1024));
  verb.add_flag_callback(
      "--no-ground", [&o] { o.ground = false; }, "leave out the ground");
  verb.add_flag("--map-ground", o.map_ground, "colour the ground of a map by its values too");
  verb.add_flag("--infinite", o.infinite, "draw a periodic scene with its repetition to the horizon");
  verb.add_option("--views", o.views, "several views in one picture, separated by commas: some of " + joined(view_names()))
      ->delimiter(',')
      ->type_name("NAME,...");
  verb.add_option("--cut", o.cut,
                  "takes away the plants on the camera's side of a plane across an axis, such as y=0.5, or on the side that a normal "
                  "points to, given by a point and the normal: x,y,z,nx,ny,nz [m]")
      ->type_name("PLANE");
  verb.add_option("--background", o.background, "what is behind the scene: 'sky' (the default) or 'white'")
      ->type_name("NAME")
      ->check(one_of({"sky", "white"}));
  verb.add_option("--exposure", o.exposure_stops, "natural colour brighter or darker by so many factors of two (default 0)")
      ->type_name("STOPS")
      ->check(number_between(-20, 20));
  verb.add_flag("--scale-bar", o.scale_bar, "a bar of a round length in parallel projections");
  verb.footer(
      "Examples:\n"
      "  sunfleck render stand.h5 -o stand.png\n"
      "  sunfleck render stand.h5 -o par.png --quantity absorbed --band PAR --elevation 20 --map-ground\n"
      "  sunfleck render stand.h5 -o views.png --views camera,front,top --scale-bar --background white\n"
      "  sunfleck render stand.h5 -o cut.png --quantity sunlit --cut y=0.2\n"
      "  sunfleck render draft.h5 -o error.png --quantity organ_error --reference fine.h5");
}

void add_view(CLI::App& verb, ViewOptions& o) {
  verb.add_option("RESULT", o.result, "result of solve, .h5")->required()->type_name("");
  verb.add_option("OTHER", o.other, "a second result, to compare with the first")->type_name("");
  verb.add_option("--port", o.port, "port to serve on (default any that is free)")->type_name("N")->check(count_from(1, 65535));
  verb.add_option("--listen", o.listen, "address to serve on instead of this machine's loopback; needs --token")->type_name("ADDRESS");
  verb.add_option("--token", o.token, "what a browser must know to be answered: 16 letters and digits or more, or 'new' for a random one")
      ->type_name("TOKEN")
      ->envname("SUNFLECK_TOKEN");
  verb.footer(
      "Prints the address to open in a browser, and serves until it is stopped (Ctrl-C).\n"
      "Examples:\n"
      "  sunfleck view stand.h5\n"
      "  sunfleck view standard.h5 reference.h5\n"
      "  sunfleck view stand.h5 --port 8600        # on a remote machine; here: ssh -L 8600:localhost:8600 THAT_MACHINE");
}

void add_info(CLI::App& verb, InfoOptions& o) {
  verb.add_option("FILE", o.file, "a result, a plant (.opf .obj .ply .can .h5), a species or a scene (.toml)")->required()->type_name("");
  verb.add_flag("--json", o.json, "print JSON instead of text");
  verb.footer(
      "Examples:\n"
      "  sunfleck info stand.h5\n"
      "  sunfleck info plants/poplar.toml --json");
}

void add_generate(CLI::App& verb, GenerateOptions& o) {
  verb.add_option("SPECIES", o.species, "species file, TOML, such as those in plants/")->required()->type_name("");
  verb.add_option("-o,--output", o.output, "plant to write: .h5 keeps its hierarchy of structures, .obj its organs as groups")
      ->required()
      ->type_name("PLANT.h5|.obj");
  verb.add_option("--age", o.age, "age of the plant, in the unit that the species file states (default the file's own)")
      ->type_name("AGE")
      ->check(number_between(0, unlimited));
  verb.add_option("--seed", o.seed, "seed of its chance events (default the file's own)")->type_name("N")->check(count_from(0));
  verb.footer(
      "Example:\n"
      "  sunfleck generate plants/poplar.toml -o poplar.h5 --age 8 --seed 3");
}

void add_originals(CLI::App& verb, OriginalsOptions& o) {
  verb.add_option("SCENE", o.scene, "scene file, TOML")->required()->type_name("");
  verb.add_option("--policy", o.policy, "policy file for all plants, in place of those that the scene names")->type_name("POLICY.toml");
  verb.add_flag_callback(
      "--no-tables", [&o] { o.tables = false; }, "classes and members only: nothing is measured");
  auto* cache = verb.add_option("--cache", o.cache, "folder that keeps tables (default $XDG_CACHE_HOME/sunfleck, else ~/.cache/sunfleck)")
                    ->type_name("FOLDER");
  verb.add_flag("--no-cache", o.no_cache, "measure everything, keep nothing")->excludes(cache);
  verb.add_option("--cache-limit", o.cache_limit_mib, "size of that folder [MiB]; what was not used for longest goes (default 256)")
      ->type_name("N")
      ->check(count_from(1, 1e9));
  verb.add_option(
          "--spread", o.spread,
          "also measure so many other members of each class of a policy, and say how far their tables are from the representative's")
      ->type_name("N")
      ->check(count_from(1, 1e6));
  verb.add_option("--threads", o.threads, "threads to use; 0 is all cores. The tables have the same bits for any number")
      ->type_name("N")
      ->check(count_from(0, 4096));
  verb.add_flag("--json", o.json, "print JSON instead of tables");
  verb.footer(
      "Per class and band: mean of the intercepted area sigma over all directions, mean transmittance T, albedo; errors in % of the rms of "
      "the\n"
      "phase function: sampling error, fit (what the basis cannot show), energy and reciprocity (before they are enforced).\n\n"
      "Examples:\n"
      "  sunfleck originals plants/stand.toml --policy policies/generic.toml --no-tables\n"
      "  sunfleck originals field.toml --cache /tmp/originals --json");
}

void add_policy(CLI::App& verb, PolicyOptions& o) {
  verb.add_option("SCENE", o.scene, "scene file, TOML")->required()->type_name("");
  verb.add_flag("--suggest", o.suggest,
                "derive a policy from the differences between the structures' own tables, instead of printing those in use");
  verb.add_option("--likeness", o.likeness, "wanted rms difference of phase functions within a class, as a fraction (default 0.1)")
      ->type_name("FRACTION")
      ->check(number_between(0.001, 10));
  verb.add_option("--measured", o.measured, "structures of each type that are measured (default 48)")
      ->type_name("N")
      ->check(count_from(8, 1e5));
  verb.add_option("--threads", o.threads, "threads to use; 0 is all cores. The policy is the same for any number")
      ->type_name("N")
      ->check(count_from(0, 4096));
  verb.footer(
      "Prints policy files in TOML: without --suggest those that the scene names, with all defaults written out.\n\n"
      "Example:\n"
      "  sunfleck policy field.toml --suggest > policies/mine.toml");
}

std::string hint(const std::string& found, const std::vector<std::string>& known) {
  const std::string near = nearest_name(found, known);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

/// Options of a verb by their long names.
std::vector<std::string> option_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

class Program {
 public:
  Program() {
    app_.set_version_flag("--version", "sunfleck " + software_version(), "print the version and exit");
    app_.require_subcommand(1);
    app_.get_formatter()->label("SUBCOMMAND", "VERB");
    app_.set_help_flag("-h,--help", "print this help and exit");
    app_.footer(
        "Each verb has its own help: sunfleck VERB --help. Data go to standard output, progress and messages to standard error.\n"
        "Exit codes: 0 done, 1 output failed, 2 bad usage or input, 3 did not converge (the result is written), 4 stopped.");
    add("solve", "the light that every facet and organ absorbs, into a result file", add_solve, verbs_.solve, verb_solve);
    add("plan", "what a solve would do and leave out, its memory and work, without solving", add_plan, verbs_.plan, verb_plan);
    add("compare", "the error of one result against another", add_compare, verbs_.compare, verb_compare);
    add("export", "a result as a lit mesh or a table", add_export, verbs_.exporting, verb_export);
    add("import", "a scene of AMAP (.ops) or CARIBU (.can, .opt, .light, .8) as a scene file", add_import, verbs_.importing, verb_import);
    add("render", "a picture of a result", add_render, verbs_.render, verb_render);
    add("view", "an interactive viewer of a result, in the browser", add_view, verbs_.view, verb_view);
    add("info", "what a result, plant, species or scene file holds", add_info, verbs_.info, verb_info);
    add("originals", "which structures share an original, and its tables", add_originals, verbs_.originals, verb_originals);
    add("policy", "the policies in use, or one derived from the plants themselves", add_policy, verbs_.policy, verb_policy);
    add("generate", "a procedural plant from a species file", add_generate, verbs_.generate, verb_generate);
  }

  int run(int argc, char** argv) {
    if (argc < 2) {
      fmt::print(stderr, "{}", app_.help());
      return bad_input;
    }
    if (argv[1][0] != '-' && std::find(names_.begin(), names_.end(), argv[1]) == names_.end()) {
      fmt::print(stderr, "sunfleck: unknown verb '{}'{}\nverbs: {}\n", argv[1], hint(argv[1], names_), joined(names_));
      return bad_input;
    }
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ExtrasError&) {
      return report_extras();
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() == 0) return app_.exit(error);  // help or version, on standard output
      fmt::print(stderr, "sunfleck{}: {}\nsee 'sunfleck{} --help'\n", verb_suffix(), error.what(), verb_suffix());
      return bad_input;
    }
    TerminalProgress progress;
    for (const auto& [verb, work] : work_)
      if (verb->parsed()) return work(progress);
    return bad_input;
  }

 private:
  template <class Options>
  void add(const std::string& name, const std::string& text, void (*declare)(CLI::App&, Options&), Options& options,
           int (*work)(const Options&, Progress&)) {
    CLI::App* verb = app_.add_subcommand(name, text);
    verb->group("Verbs")->set_help_flag("-h,--help", "print this help and exit");
    declare(*verb, options);
    work_.emplace_back(verb, [work, &options](Progress& progress) { return work(options, progress); });
    names_.push_back(name);
  }

  const CLI::App* chosen() const {
    for (const auto& [verb, work] : work_)
      if (verb->parsed()) return verb;
    return nullptr;
  }
  std::string verb_suffix() const { return chosen() ? " " + chosen()->get_name() : ""; }

  int report_extras() const {
    const CLI::App* verb = chosen() ? chosen() : &app_;
    std::string text;
    for (const auto& extra : app_.remaining(true)) {
      const bool option = extra.size() > 1 && extra[0] == '-';
      text += fmt::format("sunfleck{}: {} '{}'{}\n", verb_suffix(), option ? "unknown option" : "unexpected argument", extra,
                          option ? hint(extra.substr(0, extra.find('=')), option_names(*verb)) : "");
    }
    fmt::print(stderr, "{}see 'sunfleck{} --help'\n", text, verb_suffix());
    return bad_input;
  }

  CLI::App app_{"Sunfleck: the light that every leaf of a plant, crop or forest absorbs", "sunfleck"};
  Verbs verbs_;
  std::vector<std::pair<CLI::App*, std::function<int(Progress&)>>> work_;
  std::vector<std::string> names_;
};

}  // namespace

int run_program(int argc, char** argv) {
  try {
    return Program().run(argc, argv);
  } catch (const InputError& error) {
    fmt::print(stderr, "sunfleck: {}\n", error.what());
    return bad_input;
  } catch (const UsageError& error) {
    fmt::print(stderr, "sunfleck: {}\n", error.what());
    return bad_input;
  } catch (const Stopped& error) {
    fmt::print(stderr, "sunfleck: {}\n", error.what());
    return stopped;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "sunfleck: not enough memory; 'sunfleck plan' predicts what a scene needs\n");
    return failed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "sunfleck: {}\n", error.what());
    return failed;
  }
}

}  // namespace sunfleck
