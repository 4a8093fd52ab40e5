// Where the views of a picture are, and the rays through their pixels.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/view/picture.hpp>
#include <sunfleck/view/text.hpp>

namespace sunfleck {

struct View {
  Camera camera;
  int left, top, width, height;  ///< [pixels]
  std::string caption;           ///< empty: none

  /// Through picture coordinates in [0, 1] of this view.
  CameraRay ray(double x, double y) const { return camera.ray(x, y); }
};

/// Views of `settings` in the left `width` pixels, framing `points`; `frame` for a single view. Throws UsageError for an unknown view
/// (with the nearest name) or settings that cannot be.
std::vector<View> lay_out(const PictureSettings& settings, const std::vector<Vec3>& points, int width, const Frame& frame);

/// White lines between views, captions, and scale bars where they are wanted. `size`: height of a text line [pixels].
void draw_captions(Image& image, const std::vector<View>& views, const PictureSettings& settings, const Font& font, double size);

/// Height of a text line that suits the picture [pixels].
double text_size(const PictureSettings& settings);

/// Samples of a pixel: strata x strata, each with random bits of its own that depend on the pixel alone.
struct Strata {
  explicit Strata(const PictureSettings& settings);
  int side = 3;
  int count() const { return side * side; }
  int middle() const { return side / 2 * side + side / 2; }
  struct Sample {
    CameraRay ray;
    std::uint64_t bits;
  };
  Sample sample(const View& view, int x, int y, int s) const {  ///< x, y from the picture's top left
    const std::uint64_t bits = mix(static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(s));
    const double dx = (s % side + unit_interval(bits)) / side, dy = (s / side + unit_interval(mix(bits, 1))) / side;
    return {view.ray((x - view.left + dx) / view.width, (y - view.top + dy) / view.height), mix(bits, 2)};
  }
};

/// Calls pixel(view, x, y) for every pixel of every view, in parallel; stops when cancelled.
void each_pixel(const std::vector<View>& views, const std::string& phase, Progress& progress,
                const std::function<void(const View&, int x, int y)>& pixel);

}  // namespace sunfleck
