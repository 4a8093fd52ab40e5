// Meshes of organs in units of their own length: +z along the organ, +y the normal of its front, x across.
#pragma once

#include <cstdint>

#include <sunfleck/plant/species.hpp>

namespace sunfleck {

/// A blade of length 1 on a petiole, bent in the y-z plane and folded along its midrib. At relative position s the tangent is
/// turned down by hinge + curvature s^1.5, which bends tips more than bases.
struct BladeForm {
  double width_ratio, fold_rad, curvature_rad;
  double petiole_ratio = 0, petiole_width_ratio = 0, hinge_rad = 0;
};
/// Stations are the outline's points; 2 triangles for each pair of half-widths, 1 where one of them is 0. The petiole is a ribbon
/// of 4 triangles.
Mesh blade_mesh(const Outline& outline, const BladeForm& form);

/// The outline at so many equal steps (linear between its points).
Outline resample(const Outline& outline, std::int64_t segments);

/// Mantle of a frustum from z = 0 (radius 1) to z = 1 (radius `top`), fronts outwards; 2 triangles a side.
Mesh frustum_mesh(std::int64_t sides, double top);

/// Where a curved rachis of length 1 is at relative position s, and its tangent: turned down by curvature x s.
struct RachisPoint {
  Vec3 position, tangent;
};
RachisPoint rachis_point(double curvature_rad, double s);
/// Three-sided tube along the rachis.
Mesh rachis_mesh(double curvature_rad, double radius, std::int64_t segments);

/// Spindle of length 1 and this largest radius, closed at both ends.
Mesh spindle_mesh(double radius, std::int64_t sides, std::int64_t rings);

/// A spike of length 1: spikelets (octahedra) in two rows, each with an awn where awn > 0 (a narrow triangle of that length).
Mesh spike_mesh(double radius, std::int64_t spikelets, double awn);

/// Appends b, moved by a map that does not mirror.
void append(Mesh& a, const Mesh& b, const Affine& map);

}  // namespace sunfleck
