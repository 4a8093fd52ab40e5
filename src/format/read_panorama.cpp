#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>

#include <format/panorama.hpp>
#include <format/stb_image.hpp>

namespace sunfleck {

namespace {

constexpr const char* kinds = "a picture in Radiance HDR, OpenEXR or PNG";

/// Bytes as stb_image asks for them; it takes a missing end for zeros, so that it is noted here.
struct Bytes {
  const std::string& all;
  std::size_t at = 0;
  bool short_of = false;

  static int read(void* user, char* to, int count) {
    auto& my = *static_cast<Bytes*>(user);
    const auto n = std::min(static_cast<std::size_t>(std::max(count, 0)), my.all.size() - my.at);
    if (n == 0 && count > 0) my.short_of = true;
    std::memcpy(to, my.all.data() + my.at, n);
    my.at += n;
    return static_cast<int>(n);
  }
  static void skip(void* user, int count) {
    auto& my = *static_cast<Bytes*>(user);
    if (count < 0) {
      my.at -= std::min(my.at, static_cast<std::size_t>(-static_cast<long long>(count)));
      return;
    }
    const auto n = static_cast<std::size_t>(count);
    my.short_of = my.short_of || n > my.all.size() - my.at;
    my.at += std::min(n, my.all.size() - my.at);
  }
  static int ended(void* user) {
    const auto& my = *static_cast<Bytes*>(user);
    return my.at == my.all.size();
  }
};

constexpr stbi_io_callbacks calls{Bytes::read, Bytes::skip, Bytes::ended};

struct Freed {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

[[noreturn]] void refuse(const std::string& file, const Bytes& bytes) {
  const std::string why = bytes.short_of ? "its bytes end too early" : stbi_failure_reason() ? stbi_failure_reason() : "unreadable";
  if (why == "outofmem") throw OutOfMemory("the picture " + file);
  throw InputError(location(file), "a broken picture (" + why + ')', kinds);
}

double from_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

Panorama empty(int columns, int rows) {
  Panorama out;
  out.columns = static_cast<std::uint32_t>(columns);
  out.rows = static_cast<std::uint32_t>(rows);
  out.value.resize(std::size_t{out.columns} * out.rows);
  return out;
}

Panorama read_hdr(const std::string& all, const std::string& file) {
  Bytes bytes{all};
  int columns = 0, rows = 0, channels = 0;
  const std::unique_ptr<float, Freed> rgb(stbi_loadf_from_callbacks(&calls, &bytes, &columns, &rows, &channels, 3));
  if (!rgb || bytes.short_of) refuse(file, bytes);
  Panorama out = empty(columns, rows);
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    const float* c = rgb.get() + 3 * i;
    out.value[i] = luminance(c[0], c[1], c[2]);
  }
  return out;
}

Panorama read_png(const std::string& all, const std::string& file, PictureCode code) {
  Bytes depth{all};
  const bool deep = stbi_is_16_bit_from_callbacks(&calls, &depth) != 0;
  const bool srgb = code == PictureCode::srgb || (code == PictureCode::by_depth && !deep);
  Bytes bytes{all};
  int columns = 0, rows = 0, channels = 0;
  const std::unique_ptr<std::uint16_t, Freed> rgb(stbi_load_16_from_callbacks(&calls, &bytes, &columns, &rows, &channels, 3));
  if (!rgb || bytes.short_of) refuse(file, bytes);
  std::vector<float> light(65536);
  for (int v = 0; v < 65536; ++v) light[static_cast<std::size_t>(v)] = static_cast<float>(srgb ? from_srgb(v / 65535.0) : v / 65535.0);
  Panorama out = empty(columns, rows);
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    const std::uint16_t* c = rgb.get() + 3 * i;
    out.value[i] = luminance(light[c[0]], light[c[1]], light[c[2]]);
  }
  return out;
}

bool begins(const std::string& bytes, std::string_view with) {
  return std::string_view(bytes).substr(0, with.size()) == with;
}

/// Before any memory is taken for it.
void check_size(const std::string& all, const std::string& file) {
  Bytes bytes{all};
  int columns = 0, rows = 0, channels = 0;
  if (!stbi_info_from_callbacks(&calls, &bytes, &columns, &rows, &channels)) refuse(file, bytes);
  check_picture_size(columns, rows, file);
}

}  // namespace

void check_picture_size(long long columns, long long rows, const std::string& file) {
  if (columns < 4 || columns > most_picture_columns || columns != 2 * rows)
    throw InputError(
        location(file), fmt::format("{} x {} pixels", columns, rows),
        fmt::format("a picture of all directions (equirectangular), twice as wide as high, 4 to {} columns", most_picture_columns));
}

Panorama read_panorama(const std::string& file, PictureCode code) {
  const std::string bytes = read_input_file(file);
  const bool hdr = begins(bytes, "#?RADIANCE\n") || begins(bytes, "#?RGBE\n"), png = begins(bytes, "\x89PNG\r\n\x1a\n");
  if (begins(bytes, "\x76\x2f\x31\x01")) return read_exr(bytes, file);
  if (!hdr && !png) throw InputError(location(file), bytes.empty() ? "an empty file" : "a file of another kind", kinds);
  check_size(bytes, file);
  return hdr ? read_hdr(bytes, file) : read_png(bytes, file, code);
}

}  // namespace sunfleck
