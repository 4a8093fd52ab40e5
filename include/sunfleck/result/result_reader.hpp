// Reads result files: looks at shapes first, values in ranges of rows when asked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/result/certificate.hpp>
#include <sunfleck/result/result_geometry.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// True if the file is HDF5 with format = "sunfleck-result"; never throws.
bool is_result(const std::string& file);

/// What the root of the file says.
struct ResultHeader {
  std::string software_version, method, status, scene_text, scene_file, scene_sha256;
};

/// Leaf area and absorbed power by height; layers of equal depth.
struct StoredProfile {
  std::vector<double> height;    ///< [l + 1] edges [m]
  std::vector<double> area;      ///< [l] one-sided [m^2]
  std::vector<double> absorbed;  ///< [s][l][b] [W]
};

/// A lamp of the scene: its name, how many hang, the power of all copies together and the states in which they shine.
struct StoredLamp {
  std::string name;
  std::uint32_t copies = 0;
  std::vector<double> power;  ///< [b] [W]
  std::vector<bool> shines;   ///< [s]
};

/// What a sensor measured; k cells.
struct StoredSensor {
  std::string name, kind;            ///< kind: "grid", "profile", "mesh"
  std::vector<float> area;           ///< [k] [m^2]
  std::vector<double> centroid;      ///< [k][3] [m]
  std::vector<double> normal;        ///< [k][3] of the front
  std::vector<std::uint32_t> cells;  ///< of a grid: along x, along y; else empty
  SensorReading reading;
  std::size_t size() const { return area.size(); }
};

/// A result file, open for reading. Dataset names are as in docs/formats-result.md, without the leading slash: "facets/absorbed".
/// Nothing is trusted: a file cut short, a wrong type, shapes that contradict each other or are larger than what is stored, indices
/// out of range and values that are not finite are InputErrors that name file and dataset. For one thread at a time.
class Result {
 public:
  explicit Result(const std::string& file);
  ~Result();
  Result(Result&&) noexcept;
  Result& operator=(Result&&) noexcept;

  const std::string& file() const;
  const ResultHeader& header() const;
  const std::vector<std::string>& bands() const;
  const std::vector<std::string>& band_units() const;
  const std::vector<LightState>& states() const;  ///< names, durations, sun and sky of each
  std::size_t facet_count() const;                ///< 0 if the file keeps organs only
  std::size_t organ_count() const;

  bool has(const std::string& dataset) const;
  /// Empty if there is no such dataset.
  std::vector<std::size_t> shape(const std::string& dataset) const;

  /// Rows [first, first + count) of a dataset [rows, ...]; T is float, double, std::uint8_t, std::uint32_t, std::uint64_t or std::int64_t.
  template <class T>
  std::vector<T> rows(const std::string& dataset, std::size_t first, std::size_t count) const;
  /// The same of one state of a dataset [states, rows, ...].
  template <class T>
  std::vector<T> state_rows(const std::string& dataset, std::size_t state, std::size_t first, std::size_t count) const;
  /// A whole dataset, row-major.
  template <class T>
  std::vector<T> all(const std::string& dataset) const;
  std::vector<std::string> strings(const std::string& dataset) const;

  OrganTable organs() const;
  /// /optics; rows are what ResultGeometry::optics speaks of.
  std::vector<Optics> materials() const;
  /// Organs (rows of /organs) of a range of facets.
  std::vector<std::uint32_t> facet_organs(std::size_t first, std::size_t count) const;
  /// Throws InputError if the scene chose not to keep /geometry.
  ResultGeometry geometry() const;

  std::vector<std::vector<Balance>> balance() const;  ///< [s][b]
  StoredProfile profile() const;
  std::vector<StoredLamp> lamps() const;      ///< empty if the scene has none
  std::vector<StoredSensor> sensors() const;  ///< the same
  std::vector<IterationRow> convergence() const;
  std::vector<double> spectral_radius() const;  ///< [b] as in SolveReport; empty where nothing was iterated
  Timings timings() const;
  std::vector<std::pair<std::string, std::uint64_t>> counts() const;
  std::vector<std::pair<std::string, std::uint64_t>> memory() const;  ///< ends with "peak_resident"
  std::optional<Certificate> certificate() const;
  /// The cell that repeats; none for a finite scene, or where /geometry was not kept.
  std::optional<PeriodicCell> periodic() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunfleck
