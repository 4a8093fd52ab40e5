// The triangles of a stored scene, rebuilt from unique meshes and the maps that place them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/plant/plant.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Holds each mesh once; facets are made on request, as the solver had them (coordinates to the last bit where nothing is contracted).
struct ResultGeometry {
  struct Copy {
    std::uint32_t plant = 0;  ///< row of `plants`
    Affine map;               ///< plant frame -> world
    std::size_t first_facet = 0;
  };
  struct Entry {
    std::string name;
    std::shared_ptr<const Plant> plant;       ///< meshes, shapes, structures with parent, type and attributes; no names or frames
    std::vector<std::uint32_t> shape_optics;  ///< per shape, row of the materials
    std::vector<std::size_t> shape_facet;     ///< [shapes + 1] first facet of each shape within a copy
  };
  std::vector<Entry> plants;
  std::vector<Copy> copies;  ///< in facet order
  Mesh ground;               ///< world coordinates
  std::uint32_t ground_optics = 0;
  std::size_t plant_facets = 0;
  std::optional<PeriodicCell> periodic;

  std::size_t facet_count() const { return plant_facets + ground.triangles.size(); }
  /// Corners of facets [first, first + count), world coordinates [m], fronts as solved.
  std::vector<Triangle> corners(std::size_t first, std::size_t count) const;
  /// Row of the materials, per facet.
  std::vector<std::uint32_t> optics(std::size_t first, std::size_t count) const;
  /// Row of types() of the structure, per facet; no_parent for the ground.
  std::vector<std::uint32_t> types_of(std::size_t first, std::size_t count) const;
  /// Names of structure types, shared by all plants.
  const std::vector<std::string>& types() const;
};

}  // namespace sunfleck
