// A solve whose light stays in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <sunfleck/scene/facet_rows.hpp>
#include <sunfleck/solver/solve.hpp>

namespace sunfleck {

inline constexpr std::uint32_t of_ground = 0xffffffffu;

/// Light of facets in the order of the scene: plants in scene order, placements in theirs, facets in the plant's own; then the ground's.
/// s states, n facets, b bands; sides are front, back. W stands for umol s^-1 in bands of photons.
struct FacetLight {
  std::size_t states = 0, count = 0, bands = 0;
  std::vector<float> irradiance;     ///< [s][n][2][b] on each side, direct and scattered [W m^-2]
  std::vector<float> absorbed;       ///< [s][n][b] by both sides, per one-sided area [W m^-2]
  std::vector<float> sunlit;         ///< [s][n][2] fraction of the side that the sun reaches [-]; zeros without sun
  std::vector<float> area;           ///< [n] one-sided [m^2]
  std::vector<std::uint32_t> organ;  ///< [n] row of the organs
  std::vector<float> variance;       ///< [s][n][b] of absorbed [(W m^-2)^2]; empty unless by method reference
};

/// Light of organs, in the order of the scene; cells of the ground are organs of it. m organs.
struct OrganLight {
  std::size_t states = 0, count = 0, bands = 0;
  std::vector<double> irradiance;     ///< [s][m][2][b] mean over each side [W m^-2]
  std::vector<double> absorbed;       ///< [s][m][b] by both sides [W]
  std::vector<double> sunlit;         ///< [s][m][2] fraction of each side that the sun reaches [-]
  std::vector<double> area;           ///< [m] one-sided [m^2]
  std::vector<std::uint32_t> plant;   ///< [m] row of Scene::plants; of_ground
  std::vector<std::uint32_t> copy;    ///< [m] which placed plant, counted in scene order; the ground is their number
  std::vector<std::uint32_t> member;  ///< [m] which of the organs of its plant
  std::vector<double> variance;       ///< [s][m][b] of absorbed [W^2]; empty unless by method reference

  double absorbed_in(std::size_t organ, std::size_t band = 0, std::size_t state = 0) const {
    return absorbed[(state * count + organ) * bands + band];
  }
  double irradiance_on(std::size_t organ, int side, std::size_t band = 0, std::size_t state = 0) const {
    return irradiance[((state * count + organ) * 2 + static_cast<std::size_t>(side)) * bands + band];
  }

  const std::string& name(std::size_t organ) const { return names.names[columns(organ).name[member[organ]]]; }
  const std::string& type(std::size_t organ) const { return names.types[columns(organ).type[member[organ]]]; }
  /// "coffee[3]", as results name placements; "ground".
  const std::string& placement(std::size_t organ) const { return placements[copy[organ]]; }

  OrganNames names;
  std::vector<std::string> placements;  ///< [copies + 1] paths; the last is the ground's

 private:
  const OrganNames::Columns& columns(std::size_t organ) const {
    return plant[organ] == of_ground ? names.ground : names.of_plant[plant[organ]];
  }
};

/// What a solve found.
struct Solution : SolveResult {
  FacetLight facets;  ///< empty where they were not to be kept
  OrganLight organs;
};

/// Keeps light in memory. Memory: 4 (3 b + 2) s + 8 bytes a facet, 8 (3 b + 2) s + 20 bytes an organ.
class LightInMemory final : public LightSink {
 public:
  explicit LightInMemory(bool facets = true);
  ~LightInMemory() override;
  LightInMemory(const LightInMemory&) = delete;
  LightInMemory& operator=(const LightInMemory&) = delete;

  IrradianceSink& begin(const SolveStart& start) override;
  void end(Progress& progress) override;
  const OrganTotals& totals() const override;
  void finish(const SolveReport& report, const Certificate* certificate) override;

  FacetLight facets;
  OrganLight organs;

 private:
  class Rows;
  bool keeps_facets_;
  std::vector<std::uint64_t> wanted_;
  OrganTotals totals_;
  std::unique_ptr<Rows> rows_;
};

/// solve() with the light in memory: of facets and organs, or of organs alone.
Solution solve(const Scene& scene, const RunSettings& run = {}, Progress& progress = silent(), bool facets = true);

}  // namespace sunfleck
