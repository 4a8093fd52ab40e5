// Measuring the tables of an original by randomised quasi-Monte Carlo ray tracing of its true geometry.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/original/tables.hpp>
#include <sunfleck/plant/optics.hpp>

namespace sunfleck {

/// Facets in the frame in which the tables are wanted, and their optics.
struct OriginalGeometry {
  std::vector<Triangle> corners;      ///< [n] [m]
  std::vector<std::uint32_t> optics;  ///< [n] row of materials
  std::vector<Optics> materials;
  std::uint32_t bands = 1;
};

struct MeasureSettings {
  TableSettings tables;
  std::uint64_t seed = 1;
  std::uint64_t most_samples = std::uint64_t{1} << 24;  ///< then the error reached is stored as it is
  bool fit = true;                                      ///< measure TableErrors::fit
};

/// Measures until the sampling errors of S in every band and of sigma are at most TableSettings::error, from 16 independent randomisations.
/// The same bits for any number of threads. docs/originals.md describes the estimator. Throws InputError if there is no facet with an area;
/// Stopped.
OriginalTables measure_original(const OriginalGeometry& geometry, const MeasureSettings& settings, Progress& progress);

}  // namespace sunfleck
