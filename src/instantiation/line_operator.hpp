// What an original does with light, from global lines in its own frame.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/instantiation/solve.hpp>
#include <sunfleck/radiosity/elements.hpp>
#include <sunfleck/visibility/projection.hpp>

#include "instantiation/link_rows.hpp"

namespace sunfleck {

/// Is shown the lines of an operator as they are traced, for those who need what sides see of each other once only. Directions belong to
/// a few streams; those of one stream come in their order, streams from several threads at once: who adds up stream by stream gets the same
/// bits with any number of threads.
class LineVisitor {
 public:
  static constexpr std::size_t streams = 8;
  virtual ~LineVisitor() = default;
  /// All hits of one direction, for LineOperator::each_meeting(). `up`: the upward side of the element of each, with marks; `cell_side`:
  /// that of its cell.
  virtual void lines(std::size_t stream, const std::vector<std::uint32_t>& up, const std::vector<std::uint32_t>& cell_side) = 0;
};

/// Element sides: 2 * element + (0 front, 1 back). Fields: (2 * direction + sense) * K^2 + pixel; sense 0 looks along the direction, 1
/// against it; the pixel is one of K x K parts of the direction's grid.
///
/// With n_ij the lines on which side i sees side j, n_if those on which it looks out through field f, and W_i all lines that meet i:
///   E_i = (sum_j n_ij B_j + sum_f n_if L_f) / W_i,
/// where L_f is what comes in through f (radiance times pi). All weights of a row sum to 1, so light is neither made nor lost.
class LineOperator {
 public:
  /// What a side sees: the element on the line, or the very cell, so that a gather can tell the sunlit part of a leaf from the other.
  enum class Seen { elements, cells };

  /// `seed` chooses the turns and shifts of the grids.
  /// `interior`: of interior_of_cells(). Hits that it encloses, as the base of a petiole in a stem, are in the dark and seen by nobody who
  /// matters: they count in `enclosed` and nowhere else.
  /// With a visitor `inside` stays empty: the lines are shown to it and not kept.
  LineOperator(const Elements& elements, const std::vector<std::uint8_t>& interior, const OperatorDensity& density, std::uint64_t seed,
               Progress& progress, Seen seen = Seen::elements, LineVisitor* visitor = nullptr);

  /// Calls meet(k, below, above) for hits k - 1 and k of which sides see each other, `below` and `above` being those of their elements.
  template <class Meet>
  static void each_meeting(const std::vector<std::uint32_t>& up, Meet&& meet) {
    for (std::size_t k = 1; k < up.size(); ++k)
      if (!(up[k] & line_begins) && !((up[k] | up[k - 1]) & dark)) meet(k, up[k - 1] & ~line_begins, up[k] ^ 1u);
  }

  Seen seen() const { return seen_; }
  std::size_t seen_sides() const { return seen_sides_; }  ///< columns of `inside`

  std::uint32_t directions() const { return directions_; }
  std::uint32_t pixels() const { return pixels_; }
  std::size_t fields() const { return field_lines.size(); }
  Vec3 direction(std::size_t sense) const { return sense & 1 ? -projections_[sense >> 1].direction : projections_[sense >> 1].direction; }

  /// The field through which light leaves that runs along the unit vector `d` and passes `p` (relative to the surface's origin): that of
  /// the nearest direction.
  std::uint32_t field_at(const Vec3& p, const Vec3& d) const;
  /// The field of the same direction whose pixel p lies in.
  std::uint32_t field_of(std::size_t sense, const Vec3& p) const;

  std::size_t bytes() const;
  /// Drops all but what tells fields of directions and points.
  void forget_links();
  /// The most that was held while it was made, itself included [bytes].
  std::size_t built_with() const { return built_with_; }
  /// What of it threads worked in, direction by direction [bytes].
  std::size_t traced_with() const { return traced_with_; }
  /// What is held for each direction, links aside [bytes].
  std::size_t bytes_of_directions() const;
  /// What forget_links() leaves [bytes].
  std::size_t bytes_kept() const;

  LinkRows inside;                   ///< n_ij: columns are sides of elements or of cells
  LinkRows outside;                  ///< n_if: columns are fields
  std::vector<std::uint32_t> lines;  ///< [elements] W_i
  std::vector<float> enclosed;       ///< [cells] fraction that is enclosed; empty if nothing is
  std::vector<float> open_area;      ///< [elements] one-sided, of what is not enclosed [m^2]
  float open(std::size_t cell) const { return enclosed.empty() ? 1.0f : 1.0f - enclosed[cell]; }
  std::vector<float> field_lines;              ///< [fields] lines that leave through each
  std::vector<std::uint32_t> point_start;      ///< [fields + 1]
  std::vector<std::array<float, 3>> points;    ///< where lines leave, chosen at random; relative to the surface's origin [m]
  std::vector<std::array<float, 6>> segments;  ///< some stretches of lines between two sides that see each other, at random [m]
  std::vector<std::uint32_t> stand_in;         ///< [elements] itself, or the nearest in order of the same material that lines have met
  double line_area = 0;                        ///< [m^2]
  std::uint64_t fragments = 0;

 private:
  friend struct OperatorArchive;
  LineOperator() = default;
  static constexpr std::uint32_t line_begins = 1u << 31, dark = 1u << 30;  // marks of a hit on a line; the latter: it is enclosed

  void trace(const Elements& elements, const std::vector<std::uint8_t>& interior, const OperatorDensity& density, std::uint64_t seed,
             Progress& progress, LineVisitor* visitor);
  void tabulate_directions();

  std::uint32_t directions_ = 0, pixels_ = 0;
  Seen seen_ = Seen::elements;
  std::vector<Projection> projections_;
  std::vector<std::uint16_t> nearest_;  ///< sense by octahedral map
  std::size_t seen_sides_ = 0, traced_with_ = 0, built_with_ = 0;
};

/// Directions whose links are merged together, where a direction's lines have so many hits; `visited`: a visitor follows them.
std::uint32_t directions_together(double hits_of_direction, bool visited);

}  // namespace sunfleck
