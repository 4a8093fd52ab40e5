// What exported meshes tell of every facet, besides its colour.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/view/export.hpp>

namespace sunfleck {

/// Floats of facets, one element of the rows of a dataset [states][n][width].
struct MeshColumn {
  std::string name;  ///< letters, digits and _.-: only; no two alike
  std::string dataset;
  std::size_t state, width, element;
  std::string unit;
};

/// What the file keeps of irradiance_front_BAND, irradiance_back_BAND, absorbed_BAND, sunlit_front, sunlit_back, of the state chosen or of
/// all; "_STATE" is appended where several are kept.
std::vector<MeshColumn> mesh_columns(const Result& result, const MeshChoice& choice);

/// [columns][count] values of facets [first, first + count). A dataset is read once for all its columns.
std::vector<std::vector<float>> column_values(const Result& result, const std::vector<MeshColumn>& columns, std::size_t first,
                                              std::size_t count);

/// Throws InputError where the file keeps no values per facet.
void expect_facets(const Result& result);

/// "radiation per facet of FILE; ..." lines about units, for the comments of text formats.
std::vector<std::string> mesh_comments(const Result& result);

}  // namespace sunfleck
