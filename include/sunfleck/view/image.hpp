// Pictures: 8-bit sRGB, rows from the top.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/view/colour.hpp>

namespace sunfleck {

class Image {
 public:
  Image(int width, int height, Rgb8 fill = {255, 255, 255});
  int width() const { return width_; }
  int height() const { return height_; }
  Rgb8& at(int x, int y) { return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)]; }
  const Rgb8& at(int x, int y) const {
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  }
  const Rgb8* data() const { return pixels_.data(); }

  /// Mixes a colour into a pixel; nothing happens outside the picture. opacity in [0, 1].
  void blend(int x, int y, const Rgb8& colour, double opacity);
  /// Fills the pixels [x0, x1) x [y0, y1).
  void fill(int x0, int y0, int x1, int y1, const Rgb8& colour, double opacity = 1.0);

 private:
  int width_, height_;
  std::vector<Rgb8> pixels_;
};

/// The picture as an 8-bit RGB PNG. Throws OutputError where it cannot be encoded.
std::string png_bytes(const Image& image);

/// Writes an 8-bit RGB PNG, complete or not at all: to a temporary name beside it that is renamed when done. Throws UsageError
/// unless the name ends in .png, OutputError where it cannot be written.
void write_png(const Image& image, const std::string& file);

}  // namespace sunfleck
