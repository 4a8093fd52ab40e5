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
#include <sunfleck/instantiation/solve.hpp>
#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/reference/path_tracer.hpp>
#include <sunfleck/result/result_writer.hpp>
#include <sunfleck/scene/facets.hpp>

#include "cli/method_choice.hpp"
#include "cli/output_path.hpp"
#include "cli/solve_table.hpp"
#include "cli/text_units.hpp"

namespace sunfleck {

namespace {

constexpr int not_converged = 3;  // exit code

void say_what_was_read(const Scene& scene, const PlacedScene& placed, double seconds, Progress& progress) {
  for (const auto& note : scene.notes) progress.line("note: " + note);
  progress.line(fmt::format("read {}: {} of plants, {} of the ground, {}, {}, {} ({:.2f} s)", scene.file,
                            counted(placed.first_ground_facet, "facet", "facets"), placed.facets - placed.first_ground_facet,
                            counted(placed.organs, "organ", "organs"), counted(scene.band_count(), "band", "bands"),
                            counted(scene.states.size(), "state", "states"), seconds));
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
    settings.density = instantiation_density(choice.quality);
    return solve_instantiation(scene, placed, settings, sink, progress);
  }
  if (choice.method == "reference") {
    ReferenceSettings settings;
    settings.seed = seed;
    settings.threads = options.threads;
    if (options.samples)
      settings.samples = *options.samples;
    else if (scene.solve.samples)
      settings.samples = *scene.solve.samples;
    if (!facets) return trace_reference(scene, FacetRows(scene, placed), settings, sink, progress);
    return trace_reference(scene, *facets, settings, sink, progress);
  }
  RadiositySettings settings;
  settings.seed = seed;
  settings.threads = options.threads;
  settings.density = density_of(choice.quality);
  settings.method = radiosity_method(choice.method);
  return solve_radiosity(scene, *facets, settings, sink, progress);
}

/// Where copies make up most of a large scene, rays through copies cost less memory than facets written out, and little more time.
bool mostly_copies(const Scene& scene, const PlacedScene& placed) {
  std::uint64_t unique = placed.ground.size();
  for (std::size_t p = 0; p < scene.plants.size(); ++p) unique += placed.plant_facets[p];
  return placed.facets > 2'000'000 && placed.facets / 4 > unique;
}

bool wants_certificate(const MethodChoice& choice, const Scene& scene, const PlacedScene& placed, const SolveOptions& options) {
  return choice.method != "reference" && options.certificate && scene.solve.certificate.value_or(true) && placed.first_ground_facet > 0;
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

}  // namespace

int verb_solve(const SolveOptions& options, Progress& progress) {
  const Stopwatch total;
  check_output_path(options.result, {".h5", ".hdf5"}, {options.scene});
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));

  const Scene scene = read_scene(options.scene);
  const MethodChoice choice = choose_method(options.method, options.quality, options.error, scene, progress);
  const std::uint64_t seed = options.seed.value_or(scene.solve.seed.value_or(1));
  const PlacedScene placed = place(scene);
  std::optional<FacetScene> facets;  // every copy written out, for the methods that need it
  if (choice.method != "instantiation" && !(choice.method == "reference" && mostly_copies(scene, placed))) facets = expand(scene);
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
  std::vector<ChosenOrgan> chosen;
  ResultWriter writer(options.result, scene, placed, scene.output, software_version(), choice.method);
  if (wants_certificate(choice, scene, placed, options)) {
    chosen = choose_organs(rows, checking);
    std::vector<std::uint64_t> organs;
    for (const auto& c : chosen) organs.push_back(c.organ);
    writer.keep_totals(std::move(organs));
  }
  SolveReport report = run_method(choice, scene, placed, facets, options, seed, writer, progress);
  report.timings.emplace(report.timings.begin(), "read", read_seconds);

  std::optional<Certificate> certificate;
  if (!chosen.empty()) {
    const Stopwatch watch;
    certificate =
        certify(scene, rows, facets ? RayScene(*facets) : RayScene(rows), chosen, writer.totals(), report.balance, checking, progress);
    add_seconds(report.timings, "certificate", watch.seconds());
  }
  progress.check();
  const Stopwatch finishing;
  writer.finish(report, certificate ? &*certificate : nullptr);
  add_seconds(report.timings, "finish the file", finishing.seconds());

  print_solve_table(scene, report, certificate ? &*certificate : nullptr);
  say_timings(report, placed.facets, total.seconds(), progress);
  progress.line("wrote " + options.result);
  if (report.status == SolveStatus::converged) return 0;
  say_not_converged(scene, report, progress);
  return not_converged;
}

}  // namespace sunfleck
