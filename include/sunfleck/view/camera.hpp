// Where a picture is taken from.
#pragma once

#include <optional>
#include <span>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

struct CameraRay {
  Vec3 origin;     ///< [m]
  Vec3 direction;  ///< unit
};

/// What the user wants; what is left out frames the scene.
struct CameraChoice {
  std::optional<Vec3> eye = std::nullopt;     ///< [m]
  std::optional<Vec3> target = std::nullopt;  ///< point that appears in the middle [m]
  double azimuth_deg = 150.0;                 ///< where the camera stands, seen from the scene: from north over east (135 = south-east)
  double elevation_deg = 25.0;                ///< of the camera above the horizon, in [-90, 90]
  double field_of_view_deg = 35.0;            ///< full vertical angle, in (0, 170]; for a perspective only
  bool orthographic = false;                  ///< parallel projection
  double least_half_height = 0;               ///< a parallel projection shows at least this much above and below its middle [m]
};

/// Part of the picture that the framed points must lie in, as fractions from its left and top edges.
struct Frame {
  double left = 0.05, right = 0.95, top = 0.05, bottom = 0.95;
};

/// Pinhole or parallel camera that looks along `forward`; picture coordinates run from (0, 0) top left to (1, 1) bottom right.
class Camera {
 public:
  /// Stands at the chosen eye, or, where none is given, as near as possible along the chosen azimuth and elevation such that
  /// all points appear inside the frame (exact: each side of the view pyramid is a half-space bound on the eye). With a target
  /// and no eye, the target is in the middle and the points are inside the frame. Throws UsageError where eye and target coincide, an angle
  /// is out of range, or a value is not finite.
  Camera(const CameraChoice& choice, std::span<const Vec3> points, double aspect, const Frame& frame = {});

  CameraRay ray(double x, double y) const;
  /// Picture coordinates of a world point; no value behind a perspective camera.
  std::optional<std::array<double, 2>> project(const Vec3& p) const;
  const Vec3& eye() const { return eye_; }
  bool orthographic() const { return orthographic_; }
  /// Half the picture's height: at distance 1 (perspective), or in the scene [m] (parallel projection).
  double half_height() const { return half_height_; }
  const Vec3& forward() const { return forward_; }

 private:
  Vec3 eye_, forward_, right_, up_;
  double half_width_, half_height_;  ///< at distance 1 (perspective), or of the picture [m] (orthographic)
  bool orthographic_;
};

}  // namespace sunfleck
