// Writes result files (HDF5, docs/formats-result.md) while rows arrive.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <sunfleck/result/certificate.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// Sums of a solution per organ and state. s states, m organs, b bands.
struct OrganTotals {
  std::size_t states = 0, organs = 0, bands = 0;
  std::vector<double> irradiance;  ///< [s][m][2][b] sum over facets of area x irradiance, front and back [W]
  std::vector<double> absorbed;    ///< [s][m][b] [W]
  std::vector<double> sunlit;      ///< [s][m][2] sum over facets of area x sunlit fraction [m^2]
  std::vector<double> area;        ///< [m] one-sided [m^2]

  double absorbed_power(std::size_t state, std::size_t organ, std::size_t band) const {
    return absorbed[(state * organs + organ) * bands + band];
  }
};

/// Absorbed per one-sided area is (1 - rho_f - tau) E_f + (1 - rho_b - tau) E_b [W m^-2]; organs take area-weighted sums in double.
///
/// The file is complete or absent: it grows under a temporary name in the same folder, and finish() renames it. A writer destroyed
/// before that removes the temporary and leaves what was there before. Throws OutputError (disk full, no permission), InputError for
/// an unknown name in `output`. Scene and facets must outlive the writer.
class ResultWriter final : public IrradianceSink {
 public:
  ResultWriter(const std::string& file, const Scene& scene, const FacetScene& facets, const OutputChoice& output,
               const std::string& software_version, const std::string& method);
  ~ResultWriter() override;
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;

  /// Rows in rising order without gaps. Throws Error on a gap or a value that is not finite.
  void rows(const IrradianceRows& rows) override;

  /// Sums of the rows received so far.
  const OrganTotals& totals() const;

  /// Completes the file and gives it its name. Throws Error if rows are missing. `certificate` may be null.
  void finish(const SolveReport& report, const Certificate* certificate = nullptr);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunfleck
