// /geometry of a result file.
#pragma once

#include <sunfleck/result/result_geometry.hpp>

#include "result/dataset_reader.hpp"

namespace sunfleck::h5 {

/// `materials` rows exist in /optics. Throws InputError.
ResultGeometry read_geometry(const DatasetReader& reader, std::size_t materials);

/// The slope that a cell repeats along, if the file tells one. Throws InputError.
void read_slope(const DatasetReader& reader, PeriodicCell& cell);

}  // namespace sunfleck::h5
