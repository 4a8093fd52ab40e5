#include <sunfleck/solver/result_file.hpp>

#include <algorithm>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/version.hpp>

#include <sunfleck/result/structure_sums.hpp>

#include "solver/prepared_scene.hpp"

namespace sunfleck {

IrradianceSink& ResultFile::begin(const SolveStart& start) {
  writer_.reset();
  writer_.emplace(file_, start.scene, start.rows, output_, software_version(), start.method);
  if (!start.totals.empty()) writer_->keep_totals(start.totals);
  of_structures_ = &start.rows != &start.placed;
  return *writer_;
}

void write_result(const Scene& given, const Solution& solution, const std::string& file, const OutputChoice& output) {
  const PreparedScene prepared(given);
  const Scene& scene = prepared.scene();
  const PlacedScene placed = place(scene, solution.depth);
  const FacetLight& light = solution.facets;
  if (light.count != placed.facets || stops_inside(placed))
    throw UsageError("result file: found a solution that kept no facets; expected one that did, or to solve into a file");
  ResultWriter writer(file, scene, placed, output, software_version(), solution.choice.method);
  const bool sun = std::any_of(scene.states.begin(), scene.states.end(), [](const LightState& s) { return s.sun.has_value(); });
  writer.rows({0, light.count, light.irradiance.data(), sun ? light.sunlit.data() : nullptr,
               light.variance.empty() ? nullptr : light.variance.data()});
  writer.finish(solution.report, solution.certificate ? &*solution.certificate : nullptr);
}

}  // namespace sunfleck
