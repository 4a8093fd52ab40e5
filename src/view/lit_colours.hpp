// One colour a facet, for lit meshes.
#pragma once

#include <vector>

#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/view/colour.hpp>
#include <sunfleck/view/export.hpp>
#include <sunfleck/view/legend.hpp>

namespace sunfleck {

/// Colours of ranges of facets, and the numbers that a map shows. Reads the values once before, to set exposure or scale.
class LitColours {
 public:
  LitColours(const Result& result, const ResultGeometry& geometry, const MeshChoice& choice, Progress& progress);

  struct Range {
    std::vector<Rgb8> colours;
    std::vector<float> values;  ///< of the quantity; of absorbed under natural colour, 0 where that is not kept
  };
  Range range(std::size_t first, std::size_t count) const;

 private:
  std::vector<float> values(std::size_t first, std::size_t count) const;
  std::vector<Rgb> light(std::size_t first, std::size_t count) const;

  const Result& result_;
  const ResultGeometry& geometry_;
  MeshChoice choice_;
  std::size_t state_;
  bool natural_;
  std::string quantity_;
  std::vector<Optics> materials_;
  std::vector<std::uint32_t> organ_type_;
  std::vector<std::vector<Surface>> surfaces_;  ///< [material][organ type]
  ColourBands bands_;
  Exposure exposure_;
  ValueScale scale_;
};

}  // namespace sunfleck
