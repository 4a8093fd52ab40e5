#include "cli/options.hpp"
#include "cli/validators.hpp"

namespace sunfleck {

void define_generate(CLI::App& verb, GenerateOptions& o) {
  verb.add_option("SPECIES", o.species, "species file, TOML, such as those in plants/")->required()->type_name("");
  verb.add_option("-o,--output", o.output,
                  "plant to write: .h5 keeps its hierarchy of structures, .obj its organs as groups, with a .mtl beside it that must not "
                  "be someone else's")
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

void define_import(CLI::App& verb, ImportOptions& o) {
  auto& c = o.choice;
  verb.add_option("FILE", c.files, "one .ops (AMAP); or one .can with .opt (a band each), .light and .8 (CARIBU)")
      ->required()
      ->type_name("");
  verb.add_option("-o,--output", c.output,
                  "scene file to write; it names the files where they are. One that is there is replaced only if import wrote it and "
                  "nobody has changed it")
      ->required()
      ->type_name("SCENE.toml");
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

void define_originals(CLI::App& verb, OriginalsOptions& o) {
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

void define_policy(CLI::App& verb, PolicyOptions& o) {
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

}  // namespace sunfleck
