// The parts of a result file that are known when the solve is over.
#pragma once

#include <functional>

#include <sunfleck/result/result_writer.hpp>

#include "result/height_profile.hpp"
#include "result/row_dataset.hpp"

namespace sunfleck::h5 {

/// /organs/irradiance, absorbed, sunlit, area; `keeps` says which.
void write_organ_values(ArrayWriter& arrays, hid_t group, const OrganTotals& totals, const std::function<bool(const char*)>& keeps);
/// /balance, /convergence, /counts, /certificate, /timings, /memory and the status.
void write_report(OutputFile& file, ArrayWriter& arrays, const SolveReport& report, const Certificate* certificate,
                  const OrganTotals& totals, const HeightProfile& profile);

}  // namespace sunfleck::h5
