#include "instantiation/operator_size.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "instantiation/threads.hpp"

namespace sunfleck {

namespace {

/// log2 of the links of some directions over those of the last pilot.
class Growth {
 public:
  explicit Growth(const std::vector<const LineOperator*>& pilots) {
    const std::size_t n = pilots.size();
    directions_ = pilots.back()->directions();
    links_ = static_cast<double>(pilots.back()->inside.size());
    const auto exponent = [&](std::size_t k) {
      const auto few = static_cast<double>(pilots[k - 1]->inside.size()), more = static_cast<double>(pilots[k]->inside.size());
      const double doublings = std::log2(static_cast<double>(pilots[k]->directions()) / pilots[k - 1]->directions());
      return few > 0 && doublings > 0 ? std::clamp(std::log2(more / few) / doublings, 0.0, 1.0) : 1.0;
    };
    if (n > 1) exponent_ = exponent(n - 1);
    if (n > 2) change_ = std::min(0.0, exponent_ - exponent(n - 2));  // rows fill, never empty
  }
  double links(double directions) const {
    double doublings = std::log2(directions / directions_), exponent = exponent_, grown = 0;
    if (doublings <= 0) return links_ * std::exp2(exponent_ * doublings);
    for (; doublings > 0; doublings -= 1) {
      exponent = std::max(0.0, exponent + change_);
      grown += exponent * std::min(1.0, doublings);
    }
    return links_ * std::exp2(grown);
  }

 private:
  double directions_ = 1, links_ = 0, exponent_ = 1, change_ = 0;
};

/// Rows of links in full, and in the making.
struct RowsSize {
  double bytes_per_link = 0, column_bytes = 0;
  double starts = 0;              ///< bytes that do not depend on the links
  double lines_of_direction = 0;  ///< entries before they are merged
  double largest_share = 0;       ///< of the part with most links
  double rows_of_part = 0, parts = 1;

  RowsSize(const LinkRows& pilot, std::size_t sides, std::size_t pilot_columns, std::size_t columns, std::uint32_t directions) {
    const auto links = static_cast<double>(pilot.size());
    starts = static_cast<double>(pilot.bytes()) - LinkRows::bytes_per_link(pilot_columns) * links;
    bytes_per_link = LinkRows::bytes_per_link(columns);
    column_bytes = bytes_per_link - 1;
    lines_of_direction = static_cast<double>(pilot.lines()) / directions;
    largest_share = links > 0 ? static_cast<double>(pilot.largest_part()) / links : 0.0;
    parts = static_cast<double>(std::max<std::size_t>(pilot.parts(), 1));
    rows_of_part = static_cast<double>(sides) / parts;
  }
  double bytes(double links) const { return starts + bytes_per_link * links; }
  /// As LinkParts::merge() counts it, when the last `together` directions make it so many links.
  double merged_with(double links, double together) const {
    const double lists = together * (lines_of_direction * (2 + column_bytes) + 8 * (parts + 1));
    const auto grown = std::bit_ceil(static_cast<std::uint64_t>(largest_share * links) + LinkRows::padding);  // entry by entry
    const double room =
        12 * rows_of_part + together * lines_of_direction * largest_share * column_bytes + bytes_per_link * static_cast<double>(grown);
    return bytes(links) + lists + std::min(static_cast<double>(threads_at_work()), parts) * room;
  }
};

}  // namespace

OperatorSize operator_size(const std::vector<const LineOperator*>& pilots, std::uint32_t directions, bool followed) {
  const LineOperator& pilot = *pilots.back();
  const std::uint32_t traced = pilot.directions();
  const double times = static_cast<double>(directions) / traced;
  OperatorSize out;
  out.fields = 2 * std::size_t{directions} * pilot.pixels() * pilot.pixels();
  out.points = times * static_cast<double>(pilot.points.size());
  out.fragments = times * static_cast<double>(pilot.fragments);
  const std::size_t sides = 2 * pilot.lines.size();
  const RowsSize inside(pilot.inside, sides, pilot.seen_sides(), pilot.seen_sides(), traced),
      outside(pilot.outside, sides, pilot.fields(), out.fields, traced);
  const Growth growth(pilots);
  const auto links_inside = [&](double d) { return followed ? 0.0 : growth.links(d); };
  const auto links_outside = [&](double d) { return static_cast<double>(pilot.outside.size()) * d / traced; };
  out.links = links_inside(directions);

  const auto of_directions = static_cast<double>(pilot.bytes_of_directions());
  const auto fixed = static_cast<double>(pilot.bytes() - pilot.inside.bytes() - pilot.outside.bytes()) - of_directions;
  out.bytes = fixed + times * of_directions + inside.bytes(out.links) + outside.bytes(links_outside(directions));
  const double points = static_cast<double>(pilot.points.size() * sizeof(pilot.points[0]));
  out.kept = static_cast<double>(pilot.bytes_kept()) + (times - 1) * (of_directions - points);

  const auto together = directions_together(static_cast<double>(pilot.fragments) / traced, followed);
  const auto most_held = [&](const RowsSize& rows, const auto& links_of) {
    double most = 0, merged = 0;  // directions
    for (std::uint32_t first = 0; first < directions; first += together) {
      const std::uint32_t end = std::min(directions, first + together);
      const double waiting = (end - merged) * rows.lines_of_direction;
      if (end < directions && !merge_is_due(static_cast<std::uint64_t>(waiting), static_cast<std::uint64_t>(links_of(merged)))) continue;
      most = std::max(most, rows.merged_with(links_of(end), end - merged));
      merged = end;
    }
    return most;
  };
  const double within = followed ? inside.bytes(0) : most_held(inside, links_inside), leaving = most_held(outside, links_outside);
  out.built_with = static_cast<double>(pilot.traced_with()) + within + leaving;
  return out;
}

std::vector<LineOperator> pilots_of(const OriginalLight& original, OperatorDensity density, std::size_t count, LineOperator::Seen seen,
                                    std::uint64_t seed, Progress& progress) {
  std::vector<LineOperator> out;
  const std::uint32_t most = density.directions;
  for (std::uint32_t directions = 8; out.size() < count && (out.empty() || directions <= most); directions *= 2) {
    density.directions = std::min(directions, most);
    out.emplace_back(original.elements, original.interior, density, seed, progress, seen);
  }
  return out;
}

}  // namespace sunfleck
