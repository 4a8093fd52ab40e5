#include <sunfleck/cli/verbs.hpp>

#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <sunfleck/audit/certificate.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/version.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/instantiation/fineness.hpp>
#include <sunfleck/radiosity/fineness.hpp>
#include <sunfleck/reference/path_tracer.hpp>
#include <sunfleck/result/result_writer.hpp>
#include <sunfleck/result/structure_sums.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/plant_sizes.hpp>
#include <sunfleck/view/picture_sink.hpp>

#include "cli/bytes_of_scene.hpp"
#include "cli/error_goal.hpp"
#include "cli/memory_need.hpp"
#include "cli/method_choice.hpp"
#include "cli/output_path.hpp"
#include "cli/second_try.hpp"
#include "cli/sizes_text.hpp"
#include "cli/solve_again.hpp"
#include "cli/solve_table.hpp"
#include "cli/text_units.hpp"

namespace sunfleck {

namespace {

constexpr int not_as_asked = 3;  // exit code: did not converge, is inaccurate, or misses a wanted error

void say_what_was_read(const Scene& scene, const PlacedScene& placed, double seconds, Progress& progress) {
  progress.line(fmt::format("read {}: {} of plants, {} of the ground, {}, {}, {} ({:.2f} s)", scene.file,
                            counted(placed.first_ground_facet, "facet", "facets"), placed.facets - placed.first_ground_facet,
                            counted(placed.organs, "organ", "organs"), counted(scene.band_count(), "band", "bands"),
                            counted(scene.states.size(), "state", "states"), seconds));
  progress.line(sizes_text(scene, scene_sizes(scene)));
}

void say_what_is_dropped(const FacetScene& facets, Progress& progress) {
  if (facets.zero_area_facets > 0)
    progress.line(
        fmt::format("note: {} no area: kept as rows of zeros, not traced", counted(facets.zero_area_facets, "facet has", "facets have")));
}

SolveReport run_method(const MethodChoice& choice, const Scene& scene, const PlacedScene& placed, const std::optional<FacetScene>& facets,
                       const SolveOptions& options, std::uint64_t seed, IrradianceSink& sink, Progress& progress) {
  if (choice.method == "instantiation") {
    InstantiationSettings settings;
    settings.seed = seed;
    settings.threads = options.threads;
    settings.density = choice.fineness ? instantiation_density_at(*choice.fineness) : instantiation_density(choice.quality);
    const auto classes = classes_of_policies(scene);
    settings.classes = classes ? &*classes : nullptr;
    return solve_instantiation(scene, placed, settings, sink, progress);
  }
  if (choice.method == "reference") {
    ReferenceSettings settings;
    if (placed.partial) settings.facets = placed.facets;
    settings.seed = seed;
    settings.threads = options.threads;
    if (options.samples)
      settings.samples = *options.samples;
    else if (scene.solve.samples)
      settings.samples = *scene.solve.samples;
    if (placed.partial) {
      const PlacedScene wide = with_surroundings(placed);
      return trace_reference(scene, FacetRows(scene, wide), settings, sink, progress);
    }
    if (!facets) return trace_reference(scene, FacetRows(scene, placed), settings, sink, progress);
    return trace_reference(scene, *facets, settings, sink, progress);
  }
  RadiositySettings settings;
  settings.seed = seed;
  settings.threads = options.threads;
  settings.density = choice.fineness ? density_at(*choice.fineness) : density_of(choice.quality);
  settings.method = radiosity_method(choice.method);
  return solve_radiosity(scene, *facets, settings, sink, progress);
}

/// Where copies make up most of a large scene, rays through copies cost less memory than facets written out, and little more time.
bool mostly_copies(const Scene& scene, const PlacedScene& placed) {
  std::uint64_t unique = placed.ground.size();
  for (std::size_t p = 0; p < scene.plants.size(); ++p) unique += placed.plant_facets[p];
  return placed.facets > 2'000'000 && placed.facets / 4 > unique;
}

bool needs_facets(const MethodChoice& choice, const Scene& scene, const PlacedScene& placed) {
  return choice.method != "instantiation" && !(choice.method == "reference" && (placed.partial || mostly_copies(scene, placed)));
}

/// Where the solver counts what it holds at once, what the program holds besides is a part of it: itself, as it stood before it read
/// anything, and what `sunfleck plan` names alike.
void count_program(const Scene& scene, const SceneCounts& counts, std::size_t bytes_at_start, SolveReport& report) {
  const bool all_open = scene.solve.only.empty() && scene.solve.stop_at.empty();
  std::vector<std::pair<std::string, std::uint64_t>> besides{{"program", bytes_at_start}};
  if (all_open) besides.insert(besides.end(), {{"layout", layout_bytes(counts)}, {"file", row_bytes(scene, counts)}});
  const auto at_once = std::find_if(report.memory.begin(), report.memory.end(), [](const auto& part) { return part.first == "at_once"; });
  if (at_once == report.memory.end()) return;
  for (const auto& [name, bytes] : besides) at_once->second += bytes;
  report.memory.insert(report.memory.begin(), besides.begin(), besides.end());
}

bool wants_certificate(const MethodChoice& choice, const Scene& scene, const PlacedScene& placed, const SolveOptions& options) {
  const bool asked = options.error || scene.solve.certificate.value_or(true);  // a wanted error cannot do without
  return choice.method != "reference" && options.certificate && asked && placed.first_ground_facet > 0;
}

void say_timings(const SolveReport& report, std::uint64_t facets, double seconds, Progress& progress) {
  for (const auto& [phase, spent] : report.timings) progress.line(fmt::format("  {:<28}{:>9.2f} s", phase, spent));
  progress.line(fmt::format("  {:<28}{:>9.2f} s  {} facets/s, peak memory {}", "in all", seconds,
                            count_text(static_cast<double>(facets) / seconds), bytes_text(static_cast<double>(peak_resident_bytes()))));
}

void say_not_converged(const Scene& scene, const SolveReport& report, Progress& progress) {
  const auto worst = std::max_element(report.spectral_radius.begin(), report.spectral_radius.end());
  const std::string why = worst == report.spectral_radius.end()
                              ? ""
                              : fmt::format("; in {} the largest part of scattered light that one more scattering keeps is {:.7f}",
                                            scene.bands[static_cast<std::size_t>(worst - report.spectral_radius.begin())], *worst);
  progress.line(
      fmt::format("sunfleck: did not converge: the residual reached is {:.2e} of the direct light after {}{}. The result is written "
                  "with status 'not_converged'. Where light is trapped between surfaces of an albedo near 1, lower that albedo, or "
                  "open the space",
                  report.convergence.empty() ? 0.0 : report.convergence.back().residual,
                  counted(report.convergence.size(), "iteration", "iterations"), why));
}

void check_goal(const SolveOptions& options) {
  if (options.quality) throw UsageError("--error: found with --quality; expected one of them, as --error chooses the densities itself");
  if (!options.certificate) throw UsageError("--error: found with --no-certificate; expected to be judged by the certificate");
}

void check_goal(const MethodChoice& choice) {
  if (choice.method == "direct" || choice.method == "reference")
    throw UsageError(fmt::format("--error: found method '{}'; expected instantiation, clustering or flat ({})", choice.method,
                                 choice.method == "direct" ? "'direct' leaves scattered light out" : "'reference' takes --samples"));
}

}  // namespace

int verb_solve(const SolveOptions& options, Progress& progress) {
  const Stopwatch total;
  const std::size_t bytes_at_start = resident_bytes();
  check_output_path(options.result, {".h5", ".hdf5"}, {options.scene});
  if (options.picture) check_output_path(*options.picture, {".png"}, {options.scene, options.result});
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));

  NamedErrors wanted;
  if (options.error) {
    check_goal(options);
    wanted = named_errors(*options.error);
  }

  Scene scene = read_scene(options.scene);
  std::vector<std::string> outputs{options.result};
  if (options.picture) outputs.push_back(*options.picture);
  prepare_outputs(outputs, progress);
  for (const auto& note : scene.notes) progress.line("note: " + note);
  if (!options.only.empty()) scene.solve.only = options.only;
  if (options.stop_at) scene.solve.stop_at = stop_from_text(*options.stop_at);
  std::vector<double> goal;  // wanted errors; empty: none
  std::optional<Refinement> refinement;
  const auto free = free_memory();
  const auto counts = count(scene);
  refuse_layout(scene, counts, free);
  MethodChoice choice = choose_method(options.method, options.error ? "draft" : options.quality, scene, progress);
  if (options.error) {
    check_goal(choice);
    goal = error_goal(wanted, scene.bands);
    refinement.emplace(goal, choice.method);
    choice.fineness = refinement->first();
  }
  const std::uint64_t seed = options.seed.value_or(scene.solve.seed.value_or(1));
  refuse_depth(scene, choice.method);
  refuse_memory(scene, counts, choice, free, bytes_at_start, options.threads, progress);
  const PlacedScene placed = place(scene);
  const bool sums = stops_inside(scene, placed);  // structures within plants have rows instead of facets
  const PlacedScene layout = sums ? structures_layout(scene, placed) : PlacedScene{};
  std::optional<FacetScene> facets;  // every copy written out, for the methods that need it
  if (needs_facets(choice, scene, placed)) facets = expand(scene);
  const double read_seconds = total.seconds();
  say_what_was_read(scene, placed, read_seconds, progress);
  if (facets) say_what_is_dropped(*facets, progress);
  if (!choice.why.empty()) progress.line(fmt::format("method {}: {}", choice.method, choice.why));
  progress.check();

  const FacetRows rows(scene, placed);
  CertificateSettings checking;
  checking.seed = seed;
  checking.threads = options.threads;
  if (options.certificate_organs) checking.organs = *options.certificate_organs;
  if (options.certificate_rays) checking.rays = *options.certificate_rays;
  std::vector<ChosenOrgan> chosen, compared;  // to trace; to compare solves by
  if (!sums && wants_certificate(choice, scene, placed, options)) chosen = choose_organs(rows, checking);
  if (refinement && !chosen.empty()) compared = organs_to_compare(rows, checking);
  const Aims quality_aims = aims_of(choice, goal, rows, chosen);
  SecondTry second_try(scene, options.method || scene.solve.method, [&](const MethodChoice& next, std::string& why_not) {
    return fits_in_memory(scene, next, bytes_at_start, options.threads, why_not, progress);
  });

  std::optional<ResultWriter> writer;
  SolveReport report;
  std::optional<TracedOrgans> traced;  // once: all solves are judged by the same
  std::optional<Certificate> certificate;
  Aims aims;
  std::optional<Contradiction> contradicted;
  std::vector<OrganTotals> solved;  // where an error is wanted: of all solves
  std::optional<Image> image;
  double earlier_seconds = 0.0, certificate_seconds = 0.0;
  for (bool again = true; again;) {
    writer.emplace(options.result, scene, sums ? layout : placed, scene.output, software_version(), choice.method);
    std::vector<std::uint64_t> organs = rows_of(chosen, compared);
    if (!organs.empty()) writer->keep_totals(std::move(organs));
    std::optional<StructureSums> structures;
    if (sums) structures.emplace(scene, placed, layout, *writer);
    IrradianceSink& rows_sink = structures ? static_cast<IrradianceSink&>(*structures) : *writer;
    std::optional<PictureSink> picture;
    if (options.picture) picture.emplace(scene, placed, 0, PictureSettings{}, &rows_sink, progress);
    IrradianceSink& sink = picture ? *picture : rows_sink;
    // other lines for every solve, so that their errors have little in common
    report = run_method(choice, scene, placed, facets, options, seed + solved.size(), sink, progress);
    count_program(scene, counts, bytes_at_start, report);
    if (structures) structures->append(report.structures);
    again = false;
    if (picture) image = picture->draw(progress).image;
    if (chosen.empty()) {
      if (refinement) progress.line("note: no organ of a plant has an area: there is no error to judge");
      break;
    }
    const Stopwatch watch;
    if (!traced) {
      const PlacedScene wide = placed.closed.empty() ? PlacedScene{} : with_surroundings(placed);
      const FacetRows wide_rows(scene, wide);
      const RayScene rays = facets ? RayScene(*facets) : RayScene(placed.closed.empty() ? rows : wide_rows);
      traced = trace_organs(scene, rows, rays, chosen, checking, progress);
    }
    certificate = judge(*traced, writer->totals(), report.balance);
    certificate_seconds += watch.seconds();
    aims = refinement ? aims_of(choice, goal, rows, chosen) : quality_aims;
    contradicted = report.status == SolveStatus::converged ? contradiction(*certificate, aims.error) : std::nullopt;
    std::optional<MethodChoice> other;
    if (contradicted) other = second_try.next(choice);
    if (other) {
      progress.line(fmt::format("the certificate finds {}: solving again with method {}{}", text_of(*contradicted, aims, scene),
                                other->method, other->fineness ? fmt::format(" at fineness {:.2f}", *other->fineness) : ""));
      choice = *other;
      if (!facets && needs_facets(choice, scene, placed)) facets = expand(scene);
      if (refinement) refinement.emplace(goal, choice.method);
      solved.clear();
      again = true;
    } else if (refinement) {
      std::vector<SolveDifference> to_earlier;
      for (const auto& earlier : solved) to_earlier.push_back(solve_difference(compared, earlier, writer->totals(), report.balance));
      solved.push_back(writer->totals());
      again = refine_further(scene, report, *certificate, to_earlier, *refinement, choice, progress);
    }
    if (again)
      for (const auto& [phase, spent] : report.timings) earlier_seconds += spent;
  }
  const bool solve_converged = report.status == SolveStatus::converged;
  if (contradicted)
    report.status = SolveStatus::inaccurate;
  else if (certificate && refinement && !refinement->reached())
    report.status = SolveStatus::not_converged;
  report.timings.emplace(report.timings.begin(), "read", read_seconds);
  if (earlier_seconds > 0) add_seconds(report.timings, "earlier, coarser solves", earlier_seconds);
  if (certificate) add_seconds(report.timings, "certificate", certificate_seconds);
  progress.check();
  const Stopwatch finishing;
  writer->finish(report, certificate ? &*certificate : nullptr);
  add_seconds(report.timings, "finish the file", finishing.seconds());

  if (image) write_png(*image, *options.picture);  // before the table, which a closed pipe may end

  print_solve_table(scene, report, certificate ? &*certificate : nullptr, sums ? nullptr : &writer->plant_shares());
  say_timings(report, placed.facets, total.seconds(), progress);
  progress.line("wrote " + options.result);
  if (image) progress.line("wrote " + *options.picture);
  if (report.status == SolveStatus::converged) return 0;
  if (contradicted)
    say_inaccurate(*contradicted, aims, scene, second_try.advice(), progress);
  else if (solve_converged)
    say_not_reached(scene, *refinement, *certificate, progress);
  else
    say_not_converged(scene, report, progress);
  return not_as_asked;
}

}  // namespace sunfleck
