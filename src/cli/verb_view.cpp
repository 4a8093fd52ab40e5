#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include <sunfleck/cli/verbs.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/solver/preview.hpp>
#include <sunfleck/solver/result_file.hpp>
#include <sunfleck/view/viewer.hpp>

namespace sunfleck {

namespace {

/// A result that a preview takes the place of, in a folder of its own, as long as it is looked at.
class PreviewResult {
 public:
  PreviewResult(const std::string& scene_file, Progress& progress) {
    const SceneFile file = read_scene_file(scene_file);
    for (const auto& note : file.scene.notes) progress.line("note: " + note);
    std::string folder = (std::filesystem::temp_directory_path() / "sunfleck-preview-XXXXXX").string();
    if (!mkdtemp(folder.data()))
      throw OutputError("found no way to make a temporary folder in " + folder + "; expected TMPDIR to name one");
    folder_ = folder;
    try {
      const PlacedScene placed = place(file.scene);
      const std::string method = "preview";
      ResultFile sink(this->file());
      IrradianceSink& rows = sink.begin({file.scene, placed, placed, method, {}});
      PreviewSettings settings;
      settings.trace_sun = true;
      sink.finish(preview_light(file.scene, placed, settings, rows, progress), nullptr);
    } catch (...) {
      remove();
      throw;
    }
    progress.line("preview, not a solve: sun by rays, sky by occlusion, scattered light a constant");
  }
  ~PreviewResult() { remove(); }
  PreviewResult(const PreviewResult&) = delete;
  PreviewResult& operator=(const PreviewResult&) = delete;

  std::string file() const { return (folder_ / "preview.h5").string(); }

 private:
  void remove() const {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::filesystem::path folder_;
};

bool is_scene(const std::string& file) {
  return std::filesystem::path(file).extension() == ".toml";
}

}  // namespace

int verb_view(const ViewOptions& options, Progress& progress) {
  std::optional<PreviewResult> preview;
  if (is_scene(options.result)) preview.emplace(options.result, progress);
  ViewerSettings settings;
  settings.results = {preview ? preview->file() : options.result};
  if (options.other) settings.results.push_back(*options.other);
  settings.listen = options.listen, settings.token = options.token, settings.port = options.port;
  ViewerServer server(settings);
  fmt::print("{}\n", server.url());
  std::fflush(stdout);
  server.run(progress);
  return 0;  // to be stopped is how a viewer ends
}

}  // namespace sunfleck
