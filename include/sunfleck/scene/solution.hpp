// What every method hands over: irradiance rows to a sink, and a report.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/core/timer.hpp>
#include <sunfleck/scene/sensor.hpp>

namespace sunfleck {

/// Irradiance of consecutive facets under all lighting states. s states, b bands, `count` facets.
struct IrradianceRows {
  std::size_t first_facet = 0;
  std::size_t count = 0;
  const float* irradiance = nullptr;  ///< [s][count][2][b] front, back [W m^-2], all light: direct and scattered
  const float* sunlit = nullptr;      ///< [s][count][2] fraction of the side that the sun reaches [-]; null without sun in any state
  /// [s][count][b] of the mean of absorbed [(W m^-2)^2]; reference method only. Facets are sampled independently of each other: the
  /// variance of an organ's absorbed power is the sum over its facets of area^2 x variance.
  const float* variance_of_absorbed = nullptr;
};

/// Receives finished rows; called from one thread at a time, rows in rising order without gaps.
class IrradianceSink {
 public:
  virtual ~IrradianceSink() = default;
  virtual void rows(const IrradianceRows& rows) = 0;
};

/// What one sensor measured. s states, k cells, b bands.
struct SensorReading {
  std::vector<Patch> cells;                      ///< [k] as place_sensors() made them
  std::vector<float> irradiance;                 ///< [s][k][b] on the front [W m^-2]
  std::vector<float> standard_error;             ///< [s][k][b] of the sampling by rays, from independent randomisations [W m^-2]
  std::vector<float> back, back_standard_error;  ///< the same of the back; empty for sensors with one side
};

/// Power balance of one state and band [W]; of one cell where the scene is periodic.
/// incident = leaves + ground + escaped + residual.
struct Balance {
  double incident = 0;  ///< direct light (sun, sky, lamps) that facets and ground meet first
  double leaves = 0;    ///< absorbed by plant facets
  double ground = 0;    ///< absorbed by the ground
  double escaped = 0;   ///< scattered light that leaves the scene
  /// Factor by which scattered light, absorbed or escaped, was multiplied to make up for what sampling missed [-]; 1 where nothing was.
  double scattered_scale = 1;
  double residual() const { return incident - leaves - ground - escaped; }
};

struct IterationRow {
  std::uint32_t level = 0;
  std::uint32_t iteration = 0;
  double residual = 0;  ///< ||E0 + F R E - E|| / ||E0||, true residual, worst band and state
  std::uint64_t links = 0;
  double seconds = 0;
};

enum class SolveStatus {
  converged,
  not_converged,  ///< the iteration ended early, or an error that was asked for was not reached
  inaccurate      ///< the result's own certificate contradicts it (audit/verdict.hpp)
};
/// As the result file has it.
std::string name_of(SolveStatus status);

/// What a method did.
struct SolveReport {
  std::string method;
  SolveStatus status = SolveStatus::converged;
  std::vector<std::vector<Balance>> balance;  ///< [s][b]
  std::vector<IterationRow> convergence;
  /// [b] largest eigenvalue of F R that the iteration has met: how much of the scattered light one more scattering keeps. From below;
  /// empty where nothing was iterated.
  std::vector<double> spectral_radius;
  /// [b] where structures stood in for others: what the closed ones absorb against what they did once opened, per area, over all of them:
  /// root mean square and mean of the difference over the mean. The approximation's own error, apart from the solver's.
  std::vector<double> stand_in_rmse, stand_in_bias;
  std::vector<double> structures;                             ///< [k][s][b] absorbed by PlacedScene::closed [W]
  std::vector<std::pair<std::string, std::uint64_t>> counts;  ///< deterministic work: "links", "fragments", "directions", "rays"
  std::vector<std::pair<std::string, std::uint64_t>> memory;  ///< bytes held per phase, counted by the program
  Timings timings;
  std::vector<SensorReading> sensors;  ///< as Scene::sensors
};

/// Settings shared by all methods.
struct SolveSettings {
  std::uint64_t seed = 1;
  int threads = 0;       ///< 0 = all cores
  double tolerance = 0;  ///< relative true residual; 0 = the quality's own
};

}  // namespace sunfleck
