#include <sunfleck/view/image.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/replaced_file.hpp>

namespace sunfleck {

Image::Image(int width, int height, Rgb8 fill_colour) : width_(width), height_(height) {
  if (width < 1 || height < 1 || width > 32768 || height > 32768)
    throw UsageError(fmt::format("picture size: found {} x {}; expected 1 to 32768 pixels each way", width, height));
  pixels_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill_colour);
}

void Image::blend(int x, int y, const Rgb8& colour, double opacity) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  auto& p = at(x, y);
  for (std::size_t c = 0; c < 3; ++c)
    p[c] = static_cast<std::uint8_t>(std::lround(p[c] + (colour[c] - p[c]) * std::clamp(opacity, 0.0, 1.0)));
}

void Image::fill(int x0, int y0, int x1, int y1, const Rgb8& colour, double opacity) {
  for (int y = std::max(0, y0); y < std::min(height_, y1); ++y)
    for (int x = std::max(0, x0); x < std::min(width_, x1); ++x) blend(x, y, colour, opacity);
}

std::string png_bytes(const Image& image) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  if (stbi_write_png_to_func(append, &bytes, image.width(), image.height(), 3, image.data(), image.width() * 3) == 0)
    throw OutputError("a picture could not be encoded");
  return bytes;
}

void write_png(const Image& image, const std::string& file) {
  std::string suffix = std::filesystem::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix != ".png") throw UsageError(fmt::format("{}: found the suffix '{}'; expected .png", file, suffix));

  const std::string bytes = png_bytes(image);
  ReplacedFile out(file);
  out.write(bytes.data(), bytes.size());
  out.commit();
}

}  // namespace sunfleck
