// Solves whose light goes to a result file, and files written of light in memory.
#pragma once

#include <optional>
#include <string>

#include <sunfleck/result/result_writer.hpp>
#include <sunfleck/solver/solution.hpp>
#include <sunfleck/solver/solve.hpp>

namespace sunfleck {

/// Streams a solve into a result file (docs/formats-result.md), which is complete or absent: see ResultWriter for memory and errors.
class ResultFile : public LightSink {
 public:
  explicit ResultFile(std::string file, OutputChoice output = {}) : file_(std::move(file)), output_(std::move(output)) {}

  IrradianceSink& begin(const SolveStart& start) override;
  const OrganTotals& totals() const override { return writer_->totals(); }
  void finish(const SolveReport& report, const Certificate* certificate) override { writer_->finish(report, certificate); }

  /// What each plant absorbs; null where structures are kept in the place of organs.
  const PlantShares* plant_shares() const { return of_structures_ ? nullptr : &writer_->plant_shares(); }

 private:
  std::string file_;
  OutputChoice output_;
  bool of_structures_ = false;
  std::optional<ResultWriter> writer_;
};

/// Writes a solution of `scene` whose facets were kept, as if it had been solved into the file. Throws OutputError, and UsageError where
/// facets were not kept.
void write_result(const Scene& scene, const Solution& solution, const std::string& file, const OutputChoice& output = {});

}  // namespace sunfleck
