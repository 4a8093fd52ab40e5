// Parallel projections of a surface: who sees the sun or a part of the sky, and global lines.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/visibility/surface.hpp>

namespace sunfleck {

/// A grid of parallel lines along `direction`. A point p (relative to the surface's origin) has pixel coordinates
/// X = dot(x_row, p) + x0, Y = dot(y_row, p) + y0 and depth dot(z_row, p), which rises along the direction.
/// Finite scenes: an orthonormal frame turned about the direction, fitted to the focus box. Periodic scenes: a sheared
/// projection onto the plane of the cell, taken modulo the cell.
struct Projection {
  Vec3 direction{0, 0, 1};  ///< unit vector, in periodic scenes out of the plane they repeat along
  Vec3 x_row{1, 0, 0}, y_row{0, 1, 0}, z_row{0, 0, 1};
  double x0 = 0, y0 = 0;
  int columns = 1, rows = 1;
  bool wraps = false;
  double line_area = 1.0;  ///< area perpendicular to the direction that one line stands for [m^2]
};

/// Lines about `pitch` apart [m]; turned by `turn` [rad] (finite scenes) and shifted by fractions of a pixel against aliasing.
Projection project_along(const Surface& surface, const Vec3& direction, double pitch, double turn, double shift_x, double shift_y);

/// Direction d of D, uniform in solid angle over the upper hemisphere: a spherical Fibonacci lattice (Marques et al. 2013,
/// doi:10.1111/cgf.12190) turned by an angle that depends on the seed.
Vec3 hemisphere_direction(std::uint32_t d, std::uint32_t count, std::uint64_t seed);

/// A direction as lines of the surface can go along it: it or its opposite, whichever leads out of the plane that a periodic scene repeats
/// along, not quite along it on a slope. Directions of the upper hemisphere stay as they are in all others.
Vec3 along_lines(const Surface& surface, const Vec3& direction);

/// How much depth a line of a projection gains per length.
double depth_per_length(const Surface& surface, const Projection& projection);

/// The projection number d of a set, its turn and shifts from a low-discrepancy sequence keyed by the seed.
Projection project_set_member(const Surface& surface, const Vec3& direction, std::uint32_t d, double pitch, std::uint64_t seed);

/// How many lines meet each cell, and on how many the cell is the last thing towards the direction (it sees the sun, the sky).
/// Flat ground outside the focus counts by its exact area, as all visible.
struct VisibleCounts {
  std::vector<float> all;      ///< [cells]
  std::vector<float> visible;  ///< [cells]
};

/// Adds the counts of one projection. `from_below` counts what sees the opposite direction instead. Single-threaded; the working
/// buffer is bounded to about 1 MiB.
void count_visible(const Surface& surface, const Projection& projection, bool from_below, VisibleCounts& counts);

/// All fragments of a projection, sorted along each line.
struct LineBundle {
  struct Fragment {
    std::uint32_t pixel;
    std::uint32_t facet;  ///< with the orientation in bit 0 (1 = front up)
    std::uint32_t cell;
    float depth;
  };
  std::vector<std::uint32_t> start;  ///< [lines + 1], lines row by row
  /// Upward side of each fragment, from the lowest to the highest: 2 * cell + (0 if the front faces the direction, else 1).
  /// `side ^ 1` is the downward side.
  std::vector<std::uint32_t> side;
  std::vector<float> depth;  ///< along the line, same order; times depth_to_length = distance [m]
  double depth_to_length = 1.0;
  std::vector<Fragment> found, sorted;  ///< working space

  std::size_t bytes() const { return bytes_of(start) + bytes_of(side) + bytes_of(depth) + bytes_of(found) + bytes_of(sorted); }
};

/// Which lines have a place in LineBundle::start.
enum class LinesKept {
  all,  ///< columns * rows
  met   ///< where more than 2^24 meet nothing, only those that meet something: scenes of few plants far apart cost no more than these
};

/// Traces all lines. Coincident fragments (closer than the surface's depth tolerance) are ordered so that, for facets i < j, j
/// lies on the front side of i, the same from every direction. Single-threaded, reuses the bundle's memory. Throws InputError where the
/// projection has more than 2^32 lines.
void trace_lines(const Surface& surface, const Projection& projection, LineBundle& bundle, LinesKept lines = LinesKept::all);

/// Area, in lines, of the cells of flat ground that lie outside the focus, where lines would meet nothing else; empty in periodic scenes.
struct OutsideArea {
  std::uint32_t cell;
  float lines;
  bool front_up;  ///< the front faces the direction
};
std::vector<OutsideArea> outside_focus(const Surface& surface, const Projection& projection);

}  // namespace sunfleck
