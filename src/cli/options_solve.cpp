#include "cli/options.hpp"
#include "cli/validators.hpp"

namespace sunfleck {

namespace {

constexpr const char* method_help =
    "how scattered light is found: 'instantiation' (each plant once, its copies through it), 'clustering' (cluster tree and links), 'flat' "
    "(every facet with every other it sees), 'direct' (no scattering), 'lattice' (scattered light as a fluid, approximate), 'occlusion' "
    "(sky light from the shape of crowns, approximate) or 'reference' (path tracing); the default is what the scene file "
    "says, "
    "else instantiation where enough repeats and copies stand free of each other, else clustering";
constexpr const char* quality_help = "accuracy against time: 'draft', 'standard' (the default) or 'fine'";
const std::vector<std::string> quality_names{"draft", "standard", "fine"};

}  // namespace

void define_solve(CLI::App& verb, SolveOptions& o) {
  verb.add_option("SCENE", o.scene, "scene file, TOML")->required()->type_name("");
  verb.add_option("-o,--output", o.result, "result to write, HDF5; replaced only when the new one is complete")
      ->required()
      ->type_name("RESULT.h5");
  verb.add_option("--method", o.method, method_help)->type_name("NAME");
  verb.add_option("--quality", o.quality, quality_help)->type_name("NAME")->check(one_of(quality_names));
  verb.add_option(
          "--error", o.error,
          "wanted rms error of an organ's absorbed light, of the mean: 2%, or 0.02, or by band, PAR=1%,NIR=2%. Solves at draft, and "
          "again as fine as its certificates and the distance between solves say it takes; exit code 3 where that does not reach it")
      ->type_name("ERROR");
  verb.add_option("--samples", o.samples, "reference method only: paths per facet")->type_name("N")->check(count_from(16, 4294967295.0));
  verb.add_option(
          "--lattice-mapping", o.lattice_mapping,
          "method lattice only: how optics become its coefficients, 'matched' (to W m^-2; the default) or 'paper' (Geist & Steele 2008)")
      ->type_name("NAME")
      ->check(one_of({"matched", "paper"}));
  verb.add_option("--lattice-nodes", o.lattice_nodes,
                  "method lattice only: nodes along the longest side of the scene (default 32, 64 or 128 by quality)")
      ->type_name("N")
      ->check(count_from(2, 1024));
  verb.add_option("--occlusion-model", o.occlusion_model,
                  "method occlusion only: 'table' (exact for a ball of leaves; the default) or 'paper' (Hegeman et al. 2006)")
      ->type_name("NAME")
      ->check(one_of({"table", "paper"}));
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
  verb.add_option("--picture", o.picture,
                  "also draw the scene in natural colour from the light as it is found, whatever the result keeps; 'render' has the other "
                  "choices")
      ->type_name("IMAGE.png");
  verb.add_option("--only", o.only,
                  "open only these placements, such as 'tile[3]/*' or 'coffee 17', in place of the scene's own [solve] only: what "
                  "stands about them lights and shades them, what is farther away is not even listed (methods instantiation and reference)")
      ->type_name("PATH");
  verb.add_option("--stop-at", o.stop_at,
                  "keep what whole structures absorb instead of their facets and organs: a type such as 'branch', 'plant', the name of a "
                  "plant or group, size=METRES or leaf_count=N (method instantiation)")
      ->type_name("WHAT");
  verb.add_option("--certificate-rays", o.certificate_rays,
                  "rays that the check spends, about (default 0.6 to 2 million, by the size of the scene): more of them lessen its noise")
      ->type_name("N")
      ->check(count_from(1, 1e12));
  verb.footer(
      "The table on standard output holds, per lighting state and band, incident and absorbed light [W, or umol/s where the scene says "
      "so],\n"
      "the absorbed fraction, the albedo, the balance's residual and the certified error.\n\n"
      "Exit codes: 0 done, 1 the result could not be written or there is not enough memory, 2 bad usage or input, 3 not converged, --error "
      "not\n"
      "reached, or inaccurate by its own certificate (the result is written, its status says which), 4 stopped.\n\n"
      "Examples:\n"
      "  sunfleck solve plants/stand.toml -o stand.h5\n"
      "  sunfleck solve field.toml -o draft.h5 --quality draft --no-certificate\n"
      "  sunfleck solve field.toml -o field.h5 --error PAR=1%,NIR=2%\n"
      "  sunfleck solve field.toml -o truth.h5 --method reference --samples 4096");
}

void define_plan(CLI::App& verb, PlanOptions& o) {
  verb.add_option("SCENE", o.scene, "scene file, TOML")->required()->type_name("");
  verb.add_option("--method", o.method, method_help)->type_name("NAME");
  verb.add_option("--quality", o.quality, quality_help)->type_name("NAME")->check(one_of(quality_names));
  verb.add_option("--threads", o.threads, "threads that the solve will use; 0 is all cores. More threads hold more memory")
      ->type_name("N")
      ->check(count_from(0, 4096));
  verb.add_flag("--json", o.json, "print JSON instead of text");
  verb.footer(
      "Examples:\n"
      "  sunfleck plan field.toml\n"
      "  sunfleck plan field.toml --quality fine --json");
}

void define_compare(CLI::App& verb, CompareOptions& o) {
  verb.add_option("RESULT", o.result, "result to judge, HDF5")->required()->type_name("");
  verb.add_option("REFERENCE", o.reference, "result to judge it by, HDF5; where it holds variances its own noise is taken out")
      ->required()
      ->type_name("");
  verb.add_flag("--ignore-places", o.ignore_places,
                "compare row by row although plants were moved or turned; organs must have the same areas");
  verb.add_flag("--json", o.json, "print JSON instead of a table");
  verb.footer(
      "Both must be results of the same scene: the same organs and facets in the same places. Where light, optics or names differ, it "
      "says\n"
      "so. Errors are of absorbed power per area, weighted by area, as fractions of the mean.\n\n"
      "Example:\n"
      "  sunfleck compare stand.h5 truth.h5");
}

}  // namespace sunfleck
