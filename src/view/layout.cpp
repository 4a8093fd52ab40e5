#include "view/layout.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

struct Direction {
  const char* name;
  double azimuth_deg, elevation_deg;
};
constexpr std::array<Direction, 6> directions{
    {{"front", 180, 0}, {"back", 0, 0}, {"left", 270, 0}, {"right", 90, 0}, {"top", 180, 90}, {"bottom", 180, -90}}};

/// The camera of a view by name.
CameraChoice choice_of(const std::string& name, const CameraChoice& camera) {
  if (name == "camera") return camera;
  for (const auto& d : directions)
    if (name == d.name) {
      CameraChoice out;
      out.azimuth_deg = d.azimuth_deg, out.elevation_deg = d.elevation_deg, out.orthographic = true;
      return out;
    }
  const std::string nearest = nearest_name(name, view_names());
  throw UsageError(fmt::format("--views: found '{}'; expected some of {}{}", name, joined(view_names()),
                               nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
}

/// A round length that is between a tenth and a quarter of what a parallel projection shows.
double bar_length(double metres) {
  const double rough = metres / 4, power = std::pow(10.0, std::floor(std::log10(rough))), f = rough / power;
  return power * (f >= 5 ? 5 : f >= 2 ? 2 : 1);
}

std::string length_text(double metres) {
  return metres >= 1000   ? fmt::format("{:g} km", metres / 1000)
         : metres >= 1    ? fmt::format("{:g} m", metres)
         : metres >= 0.01 ? fmt::format("{:g} cm", metres * 100)
                          : fmt::format("{:g} mm", metres * 1000);
}

}  // namespace

const std::vector<std::string>& view_names() {
  static const std::vector<std::string> names{"camera", "front", "back", "left", "right", "top", "bottom"};
  return names;
}

double text_size(const PictureSettings& s) {
  return std::clamp(0.024 * std::min<double>(s.height, 0.9 * s.width), 9.0, 60.0);
}

std::vector<View> lay_out(const PictureSettings& settings, const std::vector<Vec3>& points, int width, const Frame& frame) {
  std::vector<View> views;
  if (settings.views.empty()) {
    views.push_back({Camera(settings.camera, points, static_cast<double>(settings.width) / settings.height, frame), 0, 0, settings.width,
                     settings.height, ""});
  } else {
    // The grid whose tiles are nearest to squares.
    const auto n = static_cast<int>(settings.views.size());
    if (n > 64) throw UsageError(fmt::format("--views: found {}; expected at most 64", n));
    int columns = 1;
    double best = 1e300;
    for (int c = 1; c <= n; ++c) {
      const int rows = (n + c - 1) / c;
      const double shape =
          std::fabs(std::log(static_cast<double>(width) / c / (static_cast<double>(settings.height) / rows))) + 0.7 * (c * rows - n);
      if (shape < best) best = shape, columns = c;
    }
    const int rows = (n + columns - 1) / columns;
    double half = 0;
    for (const bool scaled : {false, true}) {  // first to find the scale that fits all parallel projections
      views.clear();
      for (int i = 0; i < n; ++i) {
        const int x0 = i % columns * width / columns, x1 = (i % columns + 1) * width / columns;
        const int y0 = i / columns * settings.height / rows, y1 = (i / columns + 1) * settings.height / rows;
        if (x1 - x0 < 4 || y1 - y0 < 4)
          throw UsageError("--views: found more views than the picture has room for; expected a larger picture or fewer views");
        CameraChoice choice = choice_of(settings.views[static_cast<std::size_t>(i)], settings.camera);
        const bool named = settings.views[static_cast<std::size_t>(i)] != "camera";
        // What one tile shows per pixel, not per tile: tiles may differ by a pixel.
        if (named && scaled) choice.least_half_height = half * (y1 - y0);
        const Frame room{.left = 0.06, .right = 0.94, .top = 0.10, .bottom = 0.93};
        View view{Camera(choice, points, static_cast<double>(x1 - x0) / (y1 - y0), room),
                  x0,
                  y0,
                  x1 - x0,
                  y1 - y0,
                  settings.views[static_cast<std::size_t>(i)]};
        if (named) half = std::max(half, view.camera.half_height() / view.height);
        views.push_back(std::move(view));
      }
    }
  }
  if (settings.scale_bar && std::none_of(views.begin(), views.end(), [](const View& v) { return v.camera.orthographic(); }))
    throw UsageError(
        "--scale-bar: found no parallel projection; expected --orthographic, or one of the views front, back, left, right, top, bottom");
  return views;
}

void draw_captions(Image& image, const std::vector<View>& views, const PictureSettings& settings, const Font& font, double size) {
  constexpr Rgb8 ink{30, 30, 30}, paper{255, 255, 255};
  const int line = std::max(1, settings.width / 600);
  for (const auto& v : views) {
    if (v.left > 0) image.fill(v.left - line, v.top, v.left + line, v.top + v.height, paper);
    if (v.top > 0) image.fill(v.left, v.top - line, v.left + v.width, v.top + line, paper);
  }
  const int pad = static_cast<int>(0.4 * size);
  for (const auto& v : views) {
    if (!v.caption.empty()) {
      const int w = static_cast<int>(font.width(v.caption, size)) + 2 * pad;
      image.fill(v.left + pad, v.top + pad, v.left + pad + w, v.top + pad + static_cast<int>(1.5 * size), paper, 0.65);
      font.draw(image, v.left + 2 * pad, v.top + pad + 1.08 * size, v.caption, size, ink);
    }
    if (settings.scale_bar && v.camera.orthographic()) {
      const double per_pixel = 2 * v.camera.half_height() / v.height, length = bar_length(per_pixel * v.width);
      const auto bar = static_cast<int>(std::lround(length / per_pixel));
      const std::string text = length_text(length);
      const int w = std::max(bar, static_cast<int>(font.width(text, size))) + 2 * pad, h = static_cast<int>(2.1 * size);
      const int x = v.left + v.width - pad - w, y = v.top + v.height - pad - h, middle = x + w / 2;
      image.fill(x, y, x + w, y + h, paper, 0.65);
      font.draw(image, middle, y + 1.05 * size, text, size, ink, Align::centre);
      image.fill(middle - bar / 2, y + static_cast<int>(1.5 * size), middle - bar / 2 + bar,
                 y + static_cast<int>(1.5 * size) + std::max(2, static_cast<int>(0.2 * size)), ink);
    }
  }
}

Strata::Strata(const PictureSettings& settings) {
  if (settings.samples < 1 || settings.samples > 4096)
    throw UsageError(fmt::format("--samples: found {}; expected 1 to 4096 per pixel", settings.samples));
  side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(settings.samples)) - 1e-9));
}

void each_pixel(const std::vector<View>& views, const std::string& phase, Progress& progress,
                const std::function<void(const View&, int, int)>& pixel) {
  constexpr int band = 8;  // rows between two looks at the clock and the stop signal: about 0.1 s
  int done = 0, rows = 0;
  for (const auto& v : views) rows += v.height;
  for (const auto& v : views)
    for (int top = 0; top < v.height; top += band) {
      progress.check();
      const int bottom = std::min(v.height, top + band);
      tbb::parallel_for(tbb::blocked_range2d<int>(v.top + top, v.top + bottom, band, v.left, v.left + v.width, 2 * band),
                        [&](const tbb::blocked_range2d<int>& tile) {
                          for (int y = tile.rows().begin(); y < tile.rows().end(); ++y)
                            for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) pixel(v, x, y);
                        });
      done += bottom - top;
      progress.fraction(phase, static_cast<double>(done) / rows);
    }
}

}  // namespace sunfleck
