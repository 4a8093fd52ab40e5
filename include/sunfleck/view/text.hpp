// Text on pictures.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <sunfleck/view/image.hpp>

namespace sunfleck {

enum class Align { left, centre, right };

/// DejaVu Sans where the system has it (drawn by stb_truetype, anti-aliased), else the line font of stb_easy_font, which knows
/// ASCII only: superscripts then read "m^-2", "µ" reads "u".
class Font {
 public:
  Font();
  ~Font();
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;

  /// Without a font file, for tests of the second choice.
  static Font plain();
  /// True if a font file was found.
  bool outlines() const;
  /// Width of UTF-8 text at a size (height of a line) [pixels].
  double width(std::string_view text, double size) const;
  /// Draws text with its base line at y; x is its left end, middle or right end.
  void draw(Image& image, double x, double y, std::string_view text, double size, const Rgb8& colour, Align align = Align::left) const;

 private:
  struct Outlines;
  explicit Font(std::unique_ptr<Outlines> outlines);
  std::unique_ptr<Outlines> outlines_;
};

/// "W m^-2" -> "W m⁻²", "umol" -> "µmol".
std::string pretty_unit(std::string_view unit);

}  // namespace sunfleck
