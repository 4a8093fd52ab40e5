// A small scene in memory with everything that a result file has to keep, and values to put in it.
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <sunfleck/result/result_writer.hpp>
#include <sunfleck/scene/facets.hpp>

namespace sunfleck::test {

/// A fresh folder that disappears at the end.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() / ("sunfleck-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::size_t files() const {
    std::size_t n = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) n += entry.exists();
    return n;
  }

 private:
  std::filesystem::path path_;
};

/// Stem and `leaves` leaves of two triangles that share one mesh; one leaf is mirrored.
inline std::shared_ptr<Plant> small_plant(std::uint32_t leaves) {
  auto plant = std::make_shared<Plant>();
  plant->name = "shrub";
  const auto root = plant->type_index("Plant"), stem = plant->type_index("Stem"), leaf = plant->type_index("Leaf");
  plant->materials = {""};
  plant->structures.push_back({no_parent, root, "shrub", {}, {}});
  plant->structures.push_back({0, stem, "stem", {}, {}});
  plant->meshes.push_back({{{0, 0, 0}, {0.1, 0, 0}, {0, 0, 1.0 / 3.0}}, {{0, 1, 2}}});
  plant->meshes.push_back({{{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.1, 0}, {0, 0.1, 0.01}}, {{0, 1, 2}, {0, 2, 3}}});
  plant->shapes.push_back({1, 0, 0, 1, 0, {}});
  for (std::uint32_t i = 0; i < leaves; ++i) {
    plant->structures.push_back({1, leaf, i == 1 ? "flag" : "", {}, {}});
    Affine map = Affine::translate({0.013 * i, 0.0, 0.1 + 0.07 * i}) * Affine::turn(0.7 * i);
    if (i == 1) map = map * Affine{Mat3{Vec3{1, 0, 0}, Vec3{0, -1.1, 0}, Vec3{0, 0, 1}}, Vec3{0.0}};
    plant->shapes.push_back({2 + i, 1, 0, 2, 0, map});
  }
  return plant;
}

inline Scene small_scene(std::uint32_t leaves = 3) {
  Scene scene;
  scene.text = "bands = [\"PAR\", \"NIR\"]\n";
  scene.bands = {"PAR", "NIR"};
  scene.band_units = {"W m^-2", "W m^-2"};
  LightState noon, evening;
  noon.name = "noon";
  noon.duration_s = 3600;
  noon.sun = Sun{glm::normalize(Vec3{0.5, 0, 0.8}), {400, 300}, 0.53};
  noon.sky.emplace();
  noon.sky->irradiance = {100, 80};
  evening.name = "evening";
  evening.duration_s = 1800;
  evening.sky.emplace();
  evening.sky->model = SkyModel::standard_overcast;
  evening.sky->irradiance = {20, 16};
  scene.states = {noon, evening};
  scene.optics.push_back({"leaf", {0.09f, 0.45f}, {0.11f, 0.47f}, {0.05f, 0.40f}});
  scene.optics.push_back({"bark", {0.2f, 0.4f}, {0.2f, 0.4f}, {0.0f, 0.0f}});
  const auto plant = small_plant(leaves);
  std::vector<std::uint32_t> optics(plant->shapes.size(), 0);
  optics[0] = 1;
  const Affine mirror{Mat3{Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, Vec3{0.0}};
  scene.plants.push_back(
      {"shrub", plant, optics, "", {{Affine::translate({1, 2, 0}) * Affine::turn(0.3)}, {Affine::translate({-1, 0, 0}) * mirror}}});
  scene.plants.push_back({"dark", plant, std::vector<std::uint32_t>(plant->shapes.size(), 1), "", {}});
  GroupEntry row;
  row.name = "row";
  row.members = {{false, 1, {Affine::translate({0, 3, 0})}}, {false, 0, {Affine::scale(1.7)}}};
  row.placements = {{Affine::translate({5, 0, 0.25})}};
  scene.groups.push_back(row);
  Ground ground;
  ground.size = {4, 3};
  ground.cells = {3, 2};
  ground.optics = {"ground", {0.12f, 0.2f}, {0.12f, 0.2f}, {0, 0}};
  scene.ground = ground;
  return scene;
}

/// Values that differ in every index.
struct Values {
  explicit Values(const FacetScene& facets, std::size_t state_count = 2) : n(facets.size()), b(facets.bands), states(state_count) {
    for (std::size_t i = 0; i < states * n * 2 * b; ++i)
      irradiance.push_back(static_cast<float>(100.0 + 50.0 * std::sin(0.37 * static_cast<double>(i))));
    for (std::size_t i = 0; i < states * n * 2; ++i)
      sunlit.push_back(static_cast<float>(0.5 + 0.5 * std::cos(0.11 * static_cast<double>(i))));
    for (std::size_t i = 0; i < states * n * b; ++i)
      variance.push_back(static_cast<float>(1.0 + 0.5 * std::cos(0.17 * static_cast<double>(i))));
  }

  /// Hands them over in pieces of `piece` facets.
  void send(IrradianceSink& sink, std::size_t piece, bool with_variance = false) const {
    for (std::size_t first = 0; first < n; first += piece) {
      const std::size_t count = std::min(piece, n - first);
      std::vector<float> e, l, v;
      for (std::size_t s = 0; s < states; ++s) {
        const auto part = [&](const std::vector<float>& all, std::size_t width, std::vector<float>& out) {
          const auto begin = all.begin() + static_cast<std::ptrdiff_t>((s * n + first) * width);
          out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(count * width));
        };
        part(irradiance, 2 * b, e);
        part(sunlit, 2, l);
        part(variance, b, v);
      }
      sink.rows({first, count, e.data(), l.data(), with_variance ? v.data() : nullptr});
    }
  }

  std::size_t n, b, states;
  std::vector<float> irradiance, sunlit, variance;  ///< [s][n][2][b], [s][n][2], [s][n][b]
};

inline SolveReport small_report() {
  SolveReport report;
  report.method = "flat";
  report.balance = {{{10, 4, 3, 2.5}, {8, 2, 3, 3, 0.998}}, {{1, 0.5, 0.25, 0.25}, {0, 0, 0, 0}}};
  report.convergence = {{0, 1, 0.5, 100, 0.25}, {0, 2, 0.01, 120, 0.5}};
  report.spectral_radius = {0.1, 0.8};
  report.counts = {{"links", 120}, {"rays", 7}};
  report.memory = {{"links", 4096}};
  report.timings = {{"direct", 0.5}, {"links", 1.5}};
  return report;
}

}  // namespace sunfleck::test
