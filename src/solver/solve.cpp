#include <sunfleck/solver/solve.hpp>

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <sunfleck/audit/certificate.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/text_units.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/result/structure_sums.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/solver/error_goal.hpp>

#include "solver/bytes_of_scene.hpp"
#include "solver/lattice_run.hpp"
#include "solver/memory_need.hpp"
#include "solver/method_settings.hpp"
#include "solver/prepared_scene.hpp"
#include "solver/second_try.hpp"
#include "solver/solve_again.hpp"

namespace sunfleck {

namespace {

/// Where copies make up most of a large scene, rays through copies cost less memory than facets written out, and little more time.
bool mostly_copies(const Scene& scene, const PlacedScene& placed) {
  std::uint64_t unique = placed.ground.size();
  for (std::size_t p = 0; p < scene.plants.size(); ++p) unique += placed.plant_facets[p];
  return placed.facets > 2'000'000 && placed.facets / 4 > unique;
}

bool needs_facets(const MethodChoice& choice, const Scene& scene, const PlacedScene& placed) {
  return choice.method != "instantiation" && choice.method != "occlusion" &&
         !(choice.method == "reference" && (placed.partial || mostly_copies(scene, placed)));
}

SolveReport run_method(const MethodChoice& choice, const RunSettings& run, const Scene& scene, const PlacedScene& placed,
                       const std::optional<FacetScene>& facets, const SolveCaller& caller, IrradianceSink& sink, Progress& progress) {
  if (choice.method == "instantiation") {
    auto settings = instantiation_settings(choice, run);
    const auto classes = classes_of_policies(scene);
    settings.classes = classes ? &*classes : nullptr;
    settings.store = caller.operators;
    return solve_instantiation(scene, placed, settings, sink, progress);
  }
  if (choice.method == "occlusion") return solve_occlusion(scene, placed, occlusion_settings(run), sink, progress);
  if (choice.method == "lattice")
    return solve_with_lattice(scene, placed, *facets, radiosity_settings(choice, run), choice.quality == Quality::draft,
                              lattice_settings(choice, run), sink, progress);
  if (choice.method != "reference") {
    auto settings = radiosity_settings(choice, run);
    settings.store = caller.transports;
    settings.geometry = caller.geometry;
    return solve_radiosity(scene, *facets, settings, sink, progress);
  }
  auto settings = reference_settings(run);
  if (placed.partial) {
    settings.facets = placed.facets;
    const PlacedScene wide = with_surroundings(placed);
    return trace_reference(scene, FacetRows(scene, wide), settings, sink, progress);
  }
  if (!facets) return trace_reference(scene, FacetRows(scene, placed), settings, sink, progress);
  return trace_reference(scene, *facets, settings, sink, progress);
}

/// Hands rows to two sinks.
class Both final : public IrradianceSink {
 public:
  Both(IrradianceSink& first, IrradianceSink& second) : first_(first), second_(second) {}
  void rows(const IrradianceRows& rows) override {
    first_.rows(rows);
    second_.rows(rows);
  }

 private:
  IrradianceSink& first_;
  IrradianceSink& second_;
};

std::string not_converged_text(const Scene& scene, const SolveReport& report) {
  const auto worst = std::max_element(report.spectral_radius.begin(), report.spectral_radius.end());
  const std::string why = worst == report.spectral_radius.end()
                              ? ""
                              : fmt::format("; in {} the largest part of scattered light that one more scattering keeps is {:.7f}",
                                            scene.bands[static_cast<std::size_t>(worst - report.spectral_radius.begin())], *worst);
  return fmt::format(
      "did not converge: the residual reached is {:.2e} of the direct light after {}{}. The result has status 'not_converged'. Where light "
      "is trapped between surfaces of an albedo near 1, lower that albedo, or open the space",
      report.convergence.empty() ? 0.0 : report.convergence.back().residual, counted(report.convergence.size(), "iteration", "iterations"),
      why);
}

void check_goal(const RunSettings& run, const MethodChoice& choice) {
  if (run.quality) throw UsageError("error: found with a quality; expected one of them, as a wanted error chooses the densities itself");
  if (!run.certificate.value_or(true)) throw UsageError("error: found without a certificate; expected to be judged by one");
  if (const auto why = why_not_judged(choice.method); !why.empty())
    throw UsageError(fmt::format("error: found method '{}'; expected instantiation, clustering or flat ({})", choice.method, why));
}

/// One call of solve(): what is known before the first solve, and what solves one after another leave.
class Run {
 public:
  Run(const Scene& scene, const RunSettings& settings, LightSink& sink, Progress& progress, const SolveCaller& caller)
      : scene_(scene), run_(settings), sink_(sink), progress_(progress), caller_(caller), second_try_(run_, fits()) {}

  SolveResult operator()() {
    choose();
    lay_out();
    choose_certified();
    for (bool again = true; again;) {
      solve_once();
      again = !chosen_.empty() && judge_and_go_on();
      if (again)
        for (const auto& [phase, spent] : result_.report.timings) earlier_seconds_ += spent;
    }
    conclude();
    return std::move(result_);
  }

 private:
  SecondTry::Fits fits() {
    return [this](const MethodChoice& next, std::string& why_not) {
      return fits_in_memory(scene_, next, run_, caller_.bytes_at_start, why_not, progress_);
    };
  }

  void choose() {
    const auto free = free_memory();
    counts_ = count(scene_);
    refuse_layout(scene_, counts_, run_.depth, free);
    auto& choice = result_.choice = choose_method(run_, scene_, progress_);
    if (!run_.error.empty()) {
      check_goal(run_, choice);
      goal_ = error_goal(run_.error, scene_.bands);
      refinement_.emplace(goal_, choice.method);
      choice.fineness = refinement_->first();
    }
    refuse_depth(scene_, run_.depth, choice.method);
    refuse_memory(scene_, counts_, choice, run_, free, caller_.bytes_at_start, progress_);
  }

  void lay_out() {
    const Stopwatch watch;
    placed_ = place(scene_, run_.depth);
    sums_ = stops_inside(placed_);
    if (sums_) layout_ = structures_layout(scene_, placed_);
    if (needs_facets(result_.choice, scene_, placed_)) facets_ = expand(scene_);
    read_seconds_ = caller_.read_seconds + watch.seconds();
    progress_.line(fmt::format("{}{} of plants, {} of the ground, {}, {}, {} ({:.2f} s)",
                               scene_.file.empty() ? "" : "read " + scene_.file + ": ",
                               counted(placed_.first_ground_facet, "facet", "facets"), placed_.facets - placed_.first_ground_facet,
                               counted(placed_.organs, "organ", "organs"), counted(scene_.band_count(), "band", "bands"),
                               counted(scene_.states.size(), "state", "states"), read_seconds_));
    if (facets_ && facets_->zero_area_facets > 0)
      progress_.line(fmt::format("note: {} no area: kept as rows of zeros, not traced",
                                 counted(facets_->zero_area_facets, "facet has", "facets have")));
    const auto& choice = result_.choice;
    if (!choice.why.empty()) progress_.line(fmt::format("method {}: {}", choice.method, choice.why));
    progress_.check();
    rows_.emplace(scene_, placed_);
    result_.facets = placed_.facets;
    result_.depth = run_.depth;
  }

  void choose_certified() {
    checking_.seed = seed_of(run_);
    checking_.threads = run_.threads;
    if (run_.certificate_organs) checking_.organs = *run_.certificate_organs;
    if (run_.certificate_rays) checking_.rays = *run_.certificate_rays;
    const bool wanted = run_.certificate.value_or(true) && result_.choice.method != "reference" && placed_.first_ground_facet > 0;
    if (!sums_ && wanted) chosen_ = choose_organs(*rows_, checking_);
    if (refinement_ && chosen_.empty()) progress_.line("note: no organ of a plant has an area: there is no error to judge");
    if (refinement_ && !chosen_.empty()) compared_ = organs_to_compare(*rows_, checking_);
  }

  void solve_once() {
    auto& report = result_.report;
    const auto totals = rows_of(chosen_, compared_);
    IrradianceSink& kept = sink_.begin({scene_, placed_, sums_ ? layout_ : placed_, result_.choice.method, totals});
    std::optional<StructureSums> structures;
    if (sums_) structures.emplace(scene_, placed_, layout_, kept);
    IrradianceSink& rows = structures ? static_cast<IrradianceSink&>(*structures) : kept;
    IrradianceSink* watcher = sink_.watcher();
    std::optional<Both> both;
    if (watcher) both.emplace(rows, *watcher);
    // other lines for every solve, so that their errors have little in common
    RunSettings run = run_;
    run.seed = seed_of(run_) + solved_.size();
    report = run_method(result_.choice, run, scene_, placed_, facets_, caller_, both ? *both : rows, progress_);
    count_program();
    if (structures) structures->append(report.structures);
    sink_.end(progress_);
  }

  /// Where the solver counts what it holds at once, what the program holds besides is a part of it: itself, as it stood before it read
  /// anything, and what a plan names alike.
  void count_program() {
    auto& memory = result_.report.memory;
    std::vector<std::pair<std::string, std::uint64_t>> besides{{"program", caller_.bytes_at_start}};
    if (run_.depth.whole()) besides.insert(besides.end(), {{"layout", layout_bytes(counts_)}, {"file", row_bytes(scene_, counts_)}});
    const auto at_once = std::find_if(memory.begin(), memory.end(), [](const auto& part) { return part.first == "at_once"; });
    if (at_once == memory.end()) return;
    for (const auto& [name, bytes] : besides) at_once->second += bytes;
    memory.insert(memory.begin(), besides.begin(), besides.end());
  }

  void trace() {
    const PlacedScene wide = placed_.closed.empty() ? PlacedScene{} : with_surroundings(placed_);
    const FacetRows wide_rows(scene_, wide);
    const RayScene rays = facets_ ? RayScene(*facets_) : RayScene(placed_.closed.empty() ? *rows_ : wide_rows);
    traced_ = trace_organs(scene_, *rows_, rays, chosen_, checking_, progress_);
  }

  /// Judges the last solve; true where another one follows, by choice_.
  bool judge_and_go_on() {
    const Stopwatch watch;
    auto& choice = result_.choice;
    const auto& report = result_.report;
    if (!traced_) trace();  // once: all solves are judged by the same
    auto& certificate = result_.certificate.emplace(judge(*traced_, sink_.totals(), report.balance));
    certificate_seconds_ += watch.seconds();
    // by the quality as it was chosen first: a finer second try need not be better than that
    if (refinement_ || !aims_) aims_ = aims_of(choice, goal_, *rows_, chosen_);
    contradicted_ = report.status == SolveStatus::converged ? contradiction(certificate, aims_->error) : std::nullopt;
    if (contradicted_)
      if (const auto other = second_try_.next(choice)) {
        progress_.line(fmt::format("the certificate finds {}: solving again with method {}{}", text_of(*contradicted_, *aims_, scene_),
                                   other->method, other->fineness ? fmt::format(" at fineness {:.2f}", *other->fineness) : ""));
        choice = *other;
        result_.tried_again = true;
        if (!facets_ && needs_facets(choice, scene_, placed_)) facets_ = expand(scene_);
        if (refinement_) refinement_.emplace(goal_, choice.method);
        solved_.clear();
        return true;
      }
    if (!refinement_) return false;
    std::vector<SolveDifference> to_earlier;
    for (const auto& earlier : solved_) to_earlier.push_back(solve_difference(compared_, earlier, sink_.totals(), report.balance));
    solved_.push_back(sink_.totals());
    return refine_further(scene_, report, certificate, to_earlier, *refinement_, choice, progress_);
  }

  void conclude() {
    auto& report = result_.report;
    const bool solve_converged = report.status == SolveStatus::converged;
    if (contradicted_)
      report.status = SolveStatus::inaccurate;
    else if (result_.certificate && refinement_ && !refinement_->reached())
      report.status = SolveStatus::not_converged;
    report.timings.emplace(report.timings.begin(), "read", read_seconds_);
    if (earlier_seconds_ > 0) add_seconds(report.timings, "earlier, coarser solves", earlier_seconds_);
    if (result_.certificate) add_seconds(report.timings, "certificate", certificate_seconds_);
    if (contradicted_)
      result_.verdict = inaccurate_text(*contradicted_, *aims_, scene_, second_try_.advice());
    else if (report.status != SolveStatus::converged)
      result_.verdict = solve_converged ? not_reached_text(scene_, *refinement_, *result_.certificate) : not_converged_text(scene_, report);
    progress_.check();
    const Stopwatch finishing;
    sink_.finish(report, result_.certificate ? &*result_.certificate : nullptr);
    add_seconds(report.timings, "finish the file", finishing.seconds());
  }

  const Scene& scene_;
  const RunSettings& run_;
  LightSink& sink_;
  Progress& progress_;
  const SolveCaller& caller_;
  SecondTry second_try_;
  SolveResult result_;

  SceneCounts counts_;
  PlacedScene placed_, layout_;
  bool sums_ = false;                 ///< structures within plants have rows instead of facets
  std::optional<FacetScene> facets_;  ///< every copy written out, for the methods that need it
  std::optional<FacetRows> rows_;
  double read_seconds_ = 0, earlier_seconds_ = 0, certificate_seconds_ = 0;

  std::vector<double> goal_;  ///< wanted errors; empty: none
  std::optional<Refinement> refinement_;
  CertificateSettings checking_;
  std::vector<ChosenOrgan> chosen_, compared_;  ///< to trace; to compare solves by
  std::optional<TracedOrgans> traced_;
  std::optional<Aims> aims_;
  std::optional<Contradiction> contradicted_;
  std::vector<OrganTotals> solved_;  ///< where an error is wanted: of all solves
};

}  // namespace

SolveResult solve(const Scene& scene, const RunSettings& run, LightSink& sink, Progress& progress, const SolveCaller& caller) {
  std::optional<tbb::global_control> limit;
  if (run.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(run.threads));
  const PreparedScene prepared(scene);
  return Run(prepared.scene(), run, sink, progress, caller)();
}

}  // namespace sunfleck
