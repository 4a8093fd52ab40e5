// Writes result files (HDF5, docs/formats-result.md) while rows arrive.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <sunfleck/result/certificate.hpp>
#include <sunfleck/result/organ_totals.hpp>
#include <sunfleck/result/plant_shares.hpp>
#include <sunfleck/scene/placed_scene.hpp>
#include <sunfleck/scene/run_settings.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// Absorbed per one-sided area is (1 - rho_f - tau) E_f + (1 - rho_b - tau) E_b [W m^-2]; organs take area-weighted sums in double.
///
/// The file is complete or absent: it grows under a temporary name in the same folder, and finish() renames it. A writer destroyed
/// before that removes the temporary and leaves what was there before. Throws OutputError (disk full, no permission), InputError for
/// an unknown name in `output`. Scene and placed scene must outlive the writer.
///
/// Nothing of the size of the scene is held: rows go to the file by chunks, sums over organs are held for one copy at a time. Memory: some
/// 20 MB of chunks, 60 bytes an organ of the largest plant for each state and band, and the ground's cells.
class ResultWriter final : public IrradianceSink {
 public:
  ResultWriter(const std::string& file, const Scene& scene, const PlacedScene& placed, const OutputChoice& output,
               const std::string& software_version, const std::string& method);
  ~ResultWriter() override;
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;

  /// Rows in rising order without gaps. Throws Error on a gap or a value that is not finite.
  void rows(const IrradianceRows& rows) override;

  /// Before the first rows: the organs (rows of /organs, rising) whose sums totals() is to keep; none, if this is not called.
  void keep_totals(std::vector<std::uint64_t> organs);
  /// Sums of the copies of plants and of the ground whose last row has been received.
  const OrganTotals& totals() const;

  /// What the plants absorb, by rows received.
  const PlantShares& plant_shares() const;

  /// Completes the file and gives it its name. Throws Error if rows are missing. `certificate` may be null.
  void finish(const SolveReport& report, const Certificate* certificate = nullptr);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunfleck
