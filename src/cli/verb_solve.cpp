#include <sunfleck/cli/verbs.hpp>

#include <optional>
#include <string>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/text_units.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/scene/plant_sizes.hpp>
#include <sunfleck/solver/result_file.hpp>
#include <sunfleck/view/picture_sink.hpp>

#include "cli/error_option.hpp"
#include "cli/output_path.hpp"
#include "cli/sizes_text.hpp"
#include "cli/solve_table.hpp"

namespace sunfleck {

namespace {

constexpr int not_as_asked = 3;  // exit code: did not converge, is inaccurate, or misses a wanted error

/// A result file, and a picture where one is wanted.
class FileAndPicture final : public ResultFile {
 public:
  FileAndPicture(std::string file, OutputChoice output, bool draws, Progress& progress)
      : ResultFile(std::move(file), std::move(output)), draws_(draws), progress_(progress) {}

  IrradianceSink& begin(const SolveStart& start) override {
    picture_.reset();
    IrradianceSink& rows = ResultFile::begin(start);
    if (draws_) picture_.emplace(start.scene, start.placed, 0, PictureSettings{}, nullptr, progress_);
    return rows;
  }
  IrradianceSink* watcher() override { return picture_ ? &*picture_ : nullptr; }
  void end(Progress& progress) override {
    if (picture_) image_ = picture_->draw(progress).image;
  }
  const std::optional<Image>& image() const { return image_; }

 private:
  bool draws_;
  Progress& progress_;
  std::optional<PictureSink> picture_;
  std::optional<Image> image_;
};

/// The command line, then the scene's own [solve].
RunSettings run_of(const SolveOptions& options, const RunSettings& of_scene) {
  RunSettings run;
  run.method = options.method;
  if (options.quality) run.quality = quality_from_name(*options.quality);
  if (options.error) run.error = wanted_errors(*options.error);
  run.seed = options.seed;
  run.samples = options.samples;
  run.lattice_mapping = options.lattice_mapping;
  run.lattice_nodes = options.lattice_nodes;
  run.occlusion_model = options.occlusion_model;
  run.threads = options.threads;
  if (!options.certificate) run.certificate = false;
  run.certificate_organs = options.certificate_organs;
  run.certificate_rays = options.certificate_rays;
  run.depth.only = options.only;
  if (options.stop_at) run.depth.stop_at = stop_from_text(*options.stop_at);
  return filled_up(std::move(run), of_scene);
}

void check_goal(const SolveOptions& options) {
  if (!options.error) return;
  if (options.quality) throw UsageError("--error: found with --quality; expected one of them, as --error chooses the densities itself");
  if (!options.certificate) throw UsageError("--error: found with --no-certificate; expected to be judged by the certificate");
  if (const auto why = why_not_judged(options.method.value_or("")); !why.empty())
    throw UsageError(fmt::format("--error: found method '{}'; expected instantiation, clustering or flat ({})", *options.method, why));
}

void say_timings(const SolveReport& report, std::uint64_t facets, double seconds, Progress& progress) {
  for (const auto& [phase, spent] : report.timings) progress.line(fmt::format("  {:<28}{:>9.2f} s", phase, spent));
  progress.line(fmt::format("  {:<28}{:>9.2f} s  {} facets/s, peak memory {}", "in all", seconds,
                            count_text(static_cast<double>(facets) / seconds), bytes_text(static_cast<double>(peak_resident_bytes()))));
}

}  // namespace

int verb_solve(const SolveOptions& options, Progress& progress) {
  const Stopwatch total;
  SolveCaller caller;
  check_output_path(options.result, {".h5", ".hdf5"}, {options.scene});
  if (options.picture) check_output_path(*options.picture, {".png"}, {options.scene, options.result});
  check_goal(options);
  if (options.error) wanted_errors(*options.error);  // before anything is read

  const SceneFile file = read_scene_file(options.scene);
  std::vector<std::string> outputs{options.result};
  if (options.picture) outputs.push_back(*options.picture);
  prepare_outputs(outputs, progress);
  for (const auto& note : file.scene.notes) progress.line("note: " + note);
  progress.line(sizes_text(file.scene, scene_sizes(file.scene)));
  caller.read_seconds = total.seconds();

  FileAndPicture sink(options.result, file.output, options.picture.has_value(), progress);
  const RunSettings run = run_of(options, file.run);
  const SolveResult result = solve(file.scene, run, sink, progress, caller);
  if (sink.image()) write_png(*sink.image(), *options.picture);  // before the table, which a closed pipe may end

  const auto* certificate = result.certificate ? &*result.certificate : nullptr;
  print_solve_table(file.scene, run.depth, result.report, certificate, sink.plant_shares());
  say_timings(result.report, result.facets, total.seconds(), progress);
  progress.line("wrote " + options.result);
  if (sink.image()) progress.line("wrote " + *options.picture);
  if (result.report.status == SolveStatus::converged) return 0;
  progress.line("sunfleck: " + result.verdict);
  return not_as_asked;
}

}  // namespace sunfleck
