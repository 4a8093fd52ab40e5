// One colour a facet, for lit meshes.
#pragma once

#include <vector>

#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/view/colour.hpp>
#include <sunfleck/view/export.hpp>
#include <sunfleck/view/legend.hpp>

namespace sunfleck {

/// Colours of ranges of facets, and the numbers that a map shows. Reads the values once before, to set exposure or scale.
/// Quantities "type" and "optics" colour by name and need no values: all copies of a plant then look alike.
class LitColours {
 public:
  LitColours(const Result& result, const ResultGeometry& geometry, const MeshChoice& choice, Progress& progress);

  struct Range {
    std::vector<Rgb8> colours;
    std::vector<float> values;  ///< of the quantity; of absorbed under natural colour, 0 where that is not kept
  };
  Range range(std::size_t first, std::size_t count) const;

  /// What may be averaged before it becomes a colour: [count][width()], the last of each row being the value. Natural light is
  /// averaged as light, not as display values; names are never averaged (an organ has one type).
  std::size_t width() const { return natural_ ? 4 : 1; }
  std::vector<float> shades(std::size_t first, std::size_t count) const;
  Rgb8 colour(const float* shade) const;

  /// The quantity of values, its unit, and whether it is one of names.
  const std::string& quantity() const { return quantity_; }
  std::string unit() const;
  bool named() const { return named_; }
  /// Rows of values of a named quantity.
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<float> values(std::size_t first, std::size_t count) const;
  std::vector<Rgb> light(std::size_t first, std::size_t count) const;

  const Result& result_;
  const ResultGeometry& geometry_;
  MeshChoice choice_;
  std::size_t state_;
  bool natural_, named_;
  std::string quantity_;
  std::vector<Optics> materials_;
  std::vector<std::vector<SurfaceKind>> surfaces_;  ///< [material][organ type]
  std::vector<std::string> names_;
  ColourBands bands_;
  Exposure exposure_;
  ValueScale scale_;
};

}  // namespace sunfleck
