// What method occlusion knows of a scene: crowns, or a layer.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <sunfleck/occlusion/ball_visibility.hpp>
#include <sunfleck/occlusion/solve.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/scene/facet_rows.hpp>

#include "occlusion/ambient_light.hpp"
#include "occlusion/leaf_layer.hpp"
#include "occlusion/shell_grid.hpp"

namespace sunfleck {

/// Sky light on any side of a scene; per sky of light_sources(), over the sky's horizontal irradiance [-].
class OccludedSky {
 public:
  OccludedSky(const FacetRows& rows, const std::vector<const Sky*>& skies, OcclusionModel model);

  std::size_t skies() const { return skies_.size(); }
  bool is_layer() const { return profile_.has_value(); }
  std::size_t shells() const { return grid_.shells().size(); }
  std::size_t bytes() const;

  /// Row of a shell of the scene that a facet of a copy lies in.
  std::uint32_t shell_of(std::uint32_t copy, std::uint64_t facet) const;
  /// Light on the two sides of a plant's facet. `light` [2][skies].
  void on_leaf(std::uint32_t shell, const Vec3& point, const Vec3& normal, double* light) const;
  /// The same of the ground's.
  void on_ground(const Triangle& corners, const Vec3& normal, double* light) const;

 private:
  void place_crowns(const FacetRows& rows);
  void find_layer(const FacetRows& rows);
  void look_out();
  void add_at_ground(const Vec3& point, const Vec3& normal, double share, double* light) const;

  std::vector<const Sky*> skies_;
  OcclusionModel model_;
  std::vector<CrownShells> crowns_;         ///< per row of Scene::plants
  std::vector<std::uint32_t> first_shell_;  ///< [copies]
  std::vector<std::uint32_t> plant_of_;     ///< [copies]
  ShellGrid grid_;
  std::vector<double> optical_radius_;                   ///< [shells]
  std::vector<Mat3> normals_to_ball_;                    ///< [shells]
  std::vector<std::shared_ptr<const BallTable>> table_;  ///< [shells]
  std::vector<std::vector<SkyDirection>> directions_;    ///< [skies]
  std::vector<AmbientLight> ambient_;                    ///< [shells][skies]
  std::optional<LeafProfile> profile_;
  std::vector<LayerLight> layer_;  ///< [skies]
};

}  // namespace sunfleck
