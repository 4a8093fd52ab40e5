#include <sunfleck/view/text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb_truetype.h>
#include <stb_easy_font.h>
#pragma GCC diagnostic pop

namespace sunfleck {

struct Font::Outlines {
  std::vector<unsigned char> bytes;
  stbtt_fontinfo info;
};

namespace {

std::vector<unsigned char> font_file() {
  for (const char* file : {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                           "/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/share/fonts/dejavu/DejaVuSans.ttf"})
    if (std::ifstream in(file, std::ios::binary); in) return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return {};
}

/// Code points of UTF-8; a malformed byte becomes '?'.
std::vector<int> code_points(std::string_view text) {
  std::vector<int> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i++]);
    const int more = c < 0x80 ? 0 : (c >> 5) == 6 ? 1 : (c >> 4) == 14 ? 2 : (c >> 3) == 30 ? 3 : -1;
    int point = more < 0 ? '?' : more == 0 ? c : c & (0x3f >> more);
    for (int k = 0; k < more; ++k) {
      if (i >= text.size() || (static_cast<unsigned char>(text[i]) >> 6) != 2) {
        point = '?';
        break;
      }
      point = (point << 6) | (static_cast<unsigned char>(text[i++]) & 0x3f);
    }
    out.push_back(point);
  }
  return out;
}

constexpr std::array<int, 10> superscripts{0x2070, 0xb9, 0xb2, 0xb3, 0x2074, 0x2075, 0x2076, 0x2077, 0x2078, 0x2079};

/// What the line font can say.
std::string ascii(std::string_view text) {
  std::string out;
  bool raised = false;
  for (const int p : code_points(text)) {
    const auto digit = std::find(superscripts.begin(), superscripts.end(), p);
    if (digit != superscripts.end() || p == 0x207b) {
      if (!raised) out += '^';
      raised = true;
      out += p == 0x207b ? '-' : static_cast<char>('0' + (digit - superscripts.begin()));
      continue;
    }
    raised = false;
    out += p < 128 ? static_cast<char>(p) : p == 0xb5 || p == 0x3bc ? 'u' : p == 0x2026 ? '.' : '?';
  }
  return out;
}

/// The line font is 7 units high above its base line, in lines of 12.
constexpr double easy_line = 12.0, easy_base = 8.0;

}  // namespace

Font::Font() {
  auto outlines = std::make_unique<Outlines>();
  outlines->bytes = font_file();
  if (!outlines->bytes.empty() && stbtt_InitFont(&outlines->info, outlines->bytes.data(), 0) != 0) outlines_ = std::move(outlines);
}
Font::Font(std::unique_ptr<Outlines> outlines) : outlines_(std::move(outlines)) {}
Font::~Font() = default;
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;
Font Font::plain() {
  return Font(std::unique_ptr<Outlines>{});
}
bool Font::outlines() const {
  return outlines_ != nullptr;
}

double Font::width(std::string_view text, double size) const {
  if (!outlines_) {
    std::string plain_text = ascii(text);
    return stb_easy_font_width(plain_text.data()) * size / easy_line;
  }
  const double scale = stbtt_ScaleForPixelHeight(&outlines_->info, static_cast<float>(size));
  double total = 0;
  int before = 0;
  for (const int p : code_points(text)) {
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&outlines_->info, p, &advance, &bearing);
    total += scale * (advance + (before ? stbtt_GetCodepointKernAdvance(&outlines_->info, before, p) : 0));
    before = p;
  }
  return total;
}

void Font::draw(Image& image, double x, double y, std::string_view text, double size, const Rgb8& colour, Align align) const {
  if (align != Align::left) x -= width(text, size) * (align == Align::right ? 1.0 : 0.5);
  if (!outlines_) {
    std::string plain_text = ascii(text);
    struct Vertex {
      float x, y, z;
      unsigned char rgba[4];
    };
    std::vector<Vertex> quads(plain_text.size() * 80 + 4);
    const int count = stb_easy_font_print(0, 0, plain_text.data(), nullptr, quads.data(), static_cast<int>(quads.size() * sizeof(Vertex)));
    const double scale = size / easy_line;
    for (std::size_t q = 0; q < static_cast<std::size_t>(count); ++q) {
      const Vertex &a = quads[4 * q], &b = quads[4 * q + 2];
      const auto px = [&](float v) { return static_cast<int>(std::lround(x + v * scale)); };
      const auto py = [&](float v) { return static_cast<int>(std::lround(y + (v - easy_base) * scale)); };
      image.fill(px(a.x), py(a.y), std::max(px(b.x), px(a.x) + 1), std::max(py(b.y), py(a.y) + 1), colour);
    }
    return;
  }
  const float scale = stbtt_ScaleForPixelHeight(&outlines_->info, static_cast<float>(size));
  std::vector<unsigned char> glyph;
  int before = 0;
  for (const int p : code_points(text)) {
    if (before) x += static_cast<double>(scale) * stbtt_GetCodepointKernAdvance(&outlines_->info, before, p);
    const double whole_x = std::floor(x), whole_y = std::floor(y);
    const auto shift_x = static_cast<float>(x - whole_x), shift_y = static_cast<float>(y - whole_y);
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    stbtt_GetCodepointBitmapBoxSubpixel(&outlines_->info, p, scale, scale, shift_x, shift_y, &x0, &y0, &x1, &y1);
    const int w = x1 - x0, h = y1 - y0;
    if (w > 0 && h > 0) {
      glyph.assign(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0);
      stbtt_MakeCodepointBitmapSubpixel(&outlines_->info, glyph.data(), w, h, w, scale, scale, shift_x, shift_y, p);
      for (int j = 0; j < h; ++j)
        for (int i = 0; i < w; ++i)
          image.blend(static_cast<int>(whole_x) + x0 + i, static_cast<int>(whole_y) + y0 + j, colour,
                      glyph[static_cast<std::size_t>(j * w + i)] / 255.0);
    }
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&outlines_->info, p, &advance, &bearing);
    x += static_cast<double>(scale) * advance;
    before = p;
  }
}

std::string pretty_unit(std::string_view unit) {
  constexpr std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit[i] == '^') {
      while (i + 1 < unit.size() && (unit[i + 1] == '-' || (unit[i + 1] >= '0' && unit[i + 1] <= '9'))) {
        ++i;
        out += unit[i] == '-' ? "⁻" : digits[static_cast<std::size_t>(unit[i] - '0')];
      }
    } else if (unit.substr(i, 4) == "umol") {
      out += "µ";
    } else {
      out += unit[i];
    }
  }
  return out;
}

}  // namespace sunfleck
