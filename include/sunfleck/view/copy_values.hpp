// Light on the organs of one copy of a plant, by structure: for plant files that are written back.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/result/result_reader.hpp>

namespace sunfleck {

/// A copy, and its numbers per structure.
struct CopyValues {
  std::string placement;                    ///< "tile[3]/coffee[1]"
  std::size_t plant = 0;                    ///< row of ResultGeometry::plants
  std::vector<std::string> names;           ///< area_m2, then the columns of export_csv; letters, digits and _.- only
  std::vector<std::string> organ_names;     ///< [structure]; empty for structures that are no organ
  std::vector<std::vector<double>> values;  ///< [column][structure]; NaN for structures that are no organ
};

/// `placement` may be left out where the scene holds one copy. Throws UsageError with the nearest name for one that is not there, or where
/// one must be chosen; InputError where the file keeps no values of organs or no geometry.
CopyValues copy_values(const Result& result, const ResultGeometry& geometry, const std::optional<std::string>& placement,
                       Progress& progress);

}  // namespace sunfleck
