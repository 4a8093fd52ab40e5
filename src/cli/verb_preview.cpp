#include <sunfleck/cli/verbs.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <sunfleck/core/timer.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/solver/preview.hpp>
#include <sunfleck/scene/plant_sizes.hpp>
#include <sunfleck/view/picture_sink.hpp>
#include <sunfleck/view/stored.hpp>
#include <sunfleck/view/text.hpp>

#include "cli/camera_settings.hpp"
#include "cli/output_path.hpp"
#include "cli/sizes_text.hpp"

namespace sunfleck {

namespace {

/// Light of one state on all facets: a picture of it need not look first which of them it shows.
class KeptState final : public IrradianceSink {
 public:
  KeptState(const Scene& scene, std::size_t state) : scene_(scene), state_(state) {
    light_.bands = scene.bands;
    light_.sun = scene.states[state].sun;
  }

  void rows(const IrradianceRows& r) override {
    const auto keep = [&](const float* from, std::size_t width, std::vector<float>& to) {
      to.insert(to.end(), from + state_ * r.count * width, from + (state_ + 1) * r.count * width);
    };
    keep(r.irradiance, 2 * scene_.band_count(), light_.irradiance);
    if (r.sunlit && light_.sun) keep(r.sunlit, 2, light_.sunlit);
  }

  Picture draw(const PlacedScene& placed, const PictureSettings& settings, Progress& progress) const {
    const DrawnScene drawn(scene_, placed);
    return draw_natural(drawn, light_source(light_, placed.facets), settings, progress);
  }

 private:
  const Scene& scene_;
  std::size_t state_;
  StateLight light_;
};

constexpr std::uint64_t most_facets_kept = 8'000'000;

/// In the lower left corner, on a darkened strip.
void say_what_it_is(Image& image, const std::string& text) {
  const Font font;
  const double size = std::clamp(image.height() / 45.0, 9.0, 28.0), width = font.width(text, size);
  image.fill(0, image.height() - static_cast<int>(1.8 * size), std::min(image.width(), static_cast<int>(width + 1.6 * size)),
             image.height(), {0, 0, 0}, 0.55);
  font.draw(image, 0.8 * size, image.height() - 0.6 * size, text, size, {255, 255, 255});
}

}  // namespace

int verb_preview(const PreviewOptions& options, Progress& progress) {
  const Stopwatch watch;
  check_output_path(options.output, {".png"}, {options.scene});
  const PictureSettings picture = settings_of_camera(options);
  const SceneFile file = read_scene_file(options.scene);
  std::vector<std::string> states;
  for (const auto& s : file.scene.states) states.push_back(s.name);
  const std::size_t state = state_row(std::move(states), options.scene, options.state);
  prepare_outputs({options.output}, progress);
  for (const auto& note : file.scene.notes) progress.line("note: " + note);
  progress.line(sizes_text(file.scene, scene_sizes(file.scene)));
  const PlacedScene placed = place(file.scene);
  PreviewSettings settings;
  settings.threads = options.threads;
  const auto drawn = [&]() -> Image {
    if (placed.facets > most_facets_kept) {
      PictureSink sink(file.scene, placed, state, picture, nullptr, progress);
      preview_light(file.scene, placed, settings, sink, progress);
      return sink.draw(progress).image;
    }
    KeptState sink(file.scene, state);
    preview_light(file.scene, placed, settings, sink, progress);
    return sink.draw(placed, picture, progress).image;
  };
  Image image = drawn();
  say_what_it_is(image, "preview, not a solve: sun by rays, sky by occlusion, scattered light a constant");
  write_png(image, options.output);
  progress.line(fmt::format("{}: {} x {} pixels, {} facets, {:.1f} s", options.output, image.width(), image.height(), placed.facets,
                            watch.seconds()));
  return 0;
}

}  // namespace sunfleck
