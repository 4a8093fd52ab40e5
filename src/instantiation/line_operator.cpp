#include "instantiation/line_operator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/release_memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/radiosity/interior.hpp>

#include "instantiation/threads.hpp"

namespace sunfleck {

namespace {

constexpr int octahedron = 96;  // cells along an edge of the table of directions
constexpr std::size_t segments_wanted = 288;
constexpr std::size_t release_above = std::size_t{16} << 20;  // [bytes] in the making: small ones would only pay for it
constexpr double hits_together = 1e6;                         // of lines whose links are merged together

/// What one direction leaves behind besides links.
struct Traced {
  std::vector<std::pair<std::uint32_t, std::array<float, 3>>> points;  ///< (field, point)
  std::vector<std::array<float, 6>> segments;
  std::uint64_t fragments = 0;
};

/// What one thread works in.
struct Tracer {
  LineBundle bundle;
  std::vector<std::uint32_t> up;  ///< side of an element of each hit, the upward one, with its marks
  std::vector<std::uint32_t> lines;
  std::vector<std::uint32_t> hits, inside_hits;  ///< of cells, where anything is enclosed

  std::size_t bytes() const { return bundle.bytes() + bytes_of(up) + bytes_of(lines) + bytes_of(hits) + bytes_of(inside_hits); }
};

void add_to(std::vector<std::uint32_t>& sum, const std::vector<std::uint32_t>& part) {
  for (std::size_t i = 0; i < part.size(); ++i) sum[i] += part[i];
}

/// Octahedral map of the sphere onto the square [-1, 1]^2 (Meyer et al. 2010, doi:10.1111/j.1467-8659.2010.01737.x).
std::array<double, 2> to_octahedron(const Vec3& d) {
  const double length = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
  const double x = d.x / length, y = d.y / length;
  if (d.z >= 0) return {x, y};
  return {(1 - std::fabs(y)) * (x < 0 ? -1 : 1), (1 - std::fabs(x)) * (y < 0 ? -1 : 1)};
}

Vec3 from_octahedron(double x, double y) {
  const double z = 1 - std::fabs(x) - std::fabs(y);
  if (z < 0) {
    const double a = (1 - std::fabs(y)) * (x < 0 ? -1 : 1), b = (1 - std::fabs(x)) * (y < 0 ? -1 : 1);
    x = a;
    y = b;
  }
  return glm::normalize(Vec3{x, y, z});
}

}  // namespace

std::uint32_t directions_together(double hits_of_direction, bool visited) {
  const auto fewest = static_cast<double>(std::max(std::size_t{4}, threads_at_work()));
  const auto together = static_cast<std::uint32_t>(std::clamp(hits_together / std::max(hits_of_direction, 1.0), fewest, 65536.0));
  constexpr auto streams = static_cast<std::uint32_t>(LineVisitor::streams);
  return visited ? (together + streams - 1) / streams * streams : together;  // streams in order
}

LineOperator::LineOperator(const Elements& elements, const std::vector<std::uint8_t>& interior, const OperatorDensity& density,
                           std::uint64_t seed, Progress& progress, Seen seen, LineVisitor* visitor)
    : directions_(density.directions), pixels_(density.field_pixels), seen_(seen) {
  if (2 * elements.surface.cells() >= dark) throw Error("an original of more than 2^29 cells");
  trace(elements, interior, density, seed, progress, visitor);
  tabulate_directions();
  stand_in.resize(elements.size());
  std::uint32_t last = 0;
  bool any = false;
  for (std::uint32_t i = 0; i < elements.size(); ++i) {
    if (lines[i] > 0) last = i, any = true;
    stand_in[i] = lines[i] > 0 ? i : last;
    if (lines[i] == 0 && (!any || elements.material[last] != elements.material[i]))
      for (std::uint32_t step = 1; step < 64 && i + step < elements.size(); ++step)
        if (lines[i + step] > 0 && elements.material[i + step] == elements.material[i]) {
          stand_in[i] = i + step;
          break;
        }
  }
}

void LineOperator::trace(const Elements& elements, const std::vector<std::uint8_t>& interior, const OperatorDensity& density,
                         std::uint64_t seed, Progress& progress, LineVisitor* visitor) {
  const Surface& surface = elements.surface;
  const double pitch = std::sqrt(0.5 * elements.patch_area / density.lines_per_organ);
  line_area = pitch * pitch;
  const std::size_t in_direction = std::size_t{pixels_} * pixels_;
  field_lines.assign(2 * directions_ * in_direction, 0.0f);
  projections_.resize(directions_);
  std::vector<Traced> traced(directions_);
  std::vector<std::uint32_t> counts(field_lines.size(), 0);
  seen_sides_ = 2 * (seen_ == Seen::cells ? surface.cells() : elements.size());
  LinkRowsBuilder within(2 * elements.size(), seen_sides_);
  LinkRowsBuilder out(2 * elements.size(), field_lines.size());
  tbb::enumerable_thread_specific<Tracer> tracers;
  // Links of some directions are merged before more are traced: all lines of a large plant take several times what their links do.
  const double area = std::accumulate(elements.area.begin(), elements.area.end(), 0.0);
  const double hits_of_direction = 0.5 * area / line_area;
  const auto together = directions_together(hits_of_direction, visitor != nullptr);
  for (std::uint32_t first = 0; first < directions_; first += together) {
    const std::uint32_t end = std::min(directions_, first + together);
    const std::size_t within_list = within.begin(end - first), out_list = out.begin(end - first);
    const auto trace_direction = [&](std::uint32_t d) {
      Tracer& tracer = tracers.local();
      LineBundle& bundle = tracer.bundle;
      auto& up = tracer.up;
      if (tracer.lines.empty()) {
        tracer.lines.assign(elements.size(), 0);
        tracer.hits.assign(interior.empty() ? 0 : surface.cells(), 0);
        tracer.inside_hits = tracer.hits;
      }
      auto& p = projections_[d];
      p = project_set_member(surface, hemisphere_direction(d, directions_, seed), d, pitch, seed);
      trace_lines(surface, p, bundle);
      auto& t = traced[d];
      t.fragments = bundle.side.size();
      up.resize(bundle.side.size());
      for (std::size_t k = 0; k < up.size(); ++k) up[k] = 2 * elements.element_of_cell[bundle.side[k] >> 1] + (bundle.side[k] & 1u);
      const Vec3 x = p.x_row * line_area, y = p.y_row * line_area;  // pixel to metres
      std::vector<std::vector<std::array<float, 3>>> chosen(2 * in_direction);
      std::vector<std::array<std::uint32_t, 2>> leaving;  // (side, field)
      const std::size_t first_field = 2 * std::size_t{d} * in_direction;
      RandomStream random(mix(seed, d, 7));
      const std::size_t segments_per_direction = segments_wanted / directions_ + 1;
      std::uint64_t stretches = 0;
      for (int row = 0; row < p.rows; ++row)
        for (int column = 0; column < p.columns; ++column) {
          const std::size_t q = static_cast<std::size_t>(row) * p.columns + column;
          const auto begin = bundle.start[q], last = bundle.start[q + 1];
          if (begin == last) continue;
          if (!interior.empty())
            each_enclosed(interior, bundle.side.data() + begin, last - begin, [&](std::uint32_t k) { up[begin + k] |= dark; });
          up[begin] |= line_begins;
          const auto point_at = [&](std::uint32_t k) {
            return (column + 0.5 - p.x0) * x + (row + 0.5 - p.y0) * y + double{bundle.depth[k]} * p.direction;
          };
          for (auto k = begin + 1; k < last; ++k) {
            auto slot = static_cast<std::size_t>(random.next() * static_cast<double>(++stretches));
            if (stretches <= segments_per_direction) slot = stretches - 1;
            if (slot >= segments_per_direction) continue;
            const Vec3 a = point_at(k - 1), b = point_at(k);
            t.segments.resize(std::max(t.segments.size(), slot + 1));
            t.segments[slot] = {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z),
                                static_cast<float>(b.x), static_cast<float>(b.y), static_cast<float>(b.z)};
          }
          const auto pixel = static_cast<std::size_t>(static_cast<std::int64_t>(row) * pixels_ / p.rows) * pixels_ +
                             static_cast<std::size_t>(static_cast<std::int64_t>(column) * pixels_ / p.columns);
          for (std::size_t sense = 0; sense < 2; ++sense) {
            const auto k = sense == 0 ? last - 1 : begin;
            const std::size_t local = sense * in_direction + pixel;
            if (up[k] & dark) continue;
            leaving.push_back(
                {(up[k] & ~line_begins) ^ static_cast<std::uint32_t>(sense), static_cast<std::uint32_t>(first_field + local)});
            const auto seen = ++counts[first_field + local];
            auto slot = static_cast<std::size_t>(seen - 1);
            if (seen > density.points) slot = static_cast<std::size_t>(random.next() * seen);  // reservoir sampling (Vitter 1985)
            if (slot >= density.points) continue;
            const Vec3 at = point_at(k);
            const std::array<float, 3> point{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
            if (slot == chosen[local].size())
              chosen[local].push_back(point);
            else
              chosen[local][slot] = point;
          }
        }
      for (std::size_t local = 0; local < chosen.size(); ++local)
        for (const auto& point : chosen[local]) t.points.emplace_back(static_cast<std::uint32_t>(first_field + local), point);
      for (std::size_t k = 0; k < up.size(); ++k) {
        const std::uint32_t cell = bundle.side[k] >> 1;
        if (!interior.empty()) ++tracer.hits[cell];
        if (up[k] & dark)
          ++tracer.inside_hits[cell];
        else
          ++tracer.lines[(up[k] & ~line_begins) >> 1];
      }
      out.put(out_list + d - first, [&](auto&& call) {
        for (const auto& [side, field] : leaving) call(side, field);
      });
      if (visitor) {
        visitor->lines(d % LineVisitor::streams, up, bundle.side);
        return;
      }
      within.put(within_list + d - first, [&](auto&& call) {
        each_meeting(up, [&](std::size_t k, std::uint32_t below, std::uint32_t above) {
          if (seen_ == Seen::cells) {
            call(below, bundle.side[k] ^ 1u);
            call(above, bundle.side[k - 1]);
          } else {
            call(below, above);
            call(above, below);
          }
        });
      });
    };
    if (visitor)
      tbb::parallel_for(
          std::uint32_t{0}, std::uint32_t{LineVisitor::streams},
          [&](std::uint32_t stream) {
            for (auto d = first + stream; d < end && !progress.cancelled(); d += LineVisitor::streams) trace_direction(d);
          },
          tbb::simple_partitioner());
    else
      tbb::parallel_for(first, end, [&](std::uint32_t d) {
        if (!progress.cancelled()) trace_direction(d);
      });
    progress.check();
    for (auto* rows : {&within, &out})
      if (end == directions_ || rows->due()) rows->merge();
  }
  lines.assign(elements.size(), 0);
  std::vector<std::uint32_t> hits(interior.empty() ? 0 : surface.cells(), 0), inside_hits(hits);
  for (const auto& tracer : tracers) {
    add_to(lines, tracer.lines);
    add_to(hits, tracer.hits);
    add_to(inside_hits, tracer.inside_hits);
    traced_with_ += tracer.bytes();
  }
  built_with_ = traced_with_ + within.peak() + out.peak();
  tracers.clear();
  for (const auto& t : traced) {
    fragments += t.fragments;
    segments.insert(segments.end(), t.segments.begin(), t.segments.end());
  }
  open_area = elements.area;
  if (std::any_of(inside_hits.begin(), inside_hits.end(), [](std::uint32_t n) { return n > 0; })) {
    enclosed.resize(surface.cells());
    for (std::size_t c = 0; c < enclosed.size(); ++c) {
      if (hits[c] > 0) enclosed[c] = static_cast<float>(inside_hits[c]) / static_cast<float>(hits[c]);
      open_area[elements.element_of_cell[c]] -= enclosed[c] * surface.cell_area[elements.row_of_cell[c]];
    }
    for (auto& a : open_area) a = std::max(a, 0.0f);
  }
  for (std::size_t f = 0; f < field_lines.size(); ++f) field_lines[f] = static_cast<float>(counts[f]);
  point_start.assign(field_lines.size() + 1, 0);
  std::size_t kept_points = 0;
  for (const auto& t : traced) kept_points += t.points.size();
  points.reserve(kept_points);
  for (const auto& t : traced)
    for (const auto& [field, point] : t.points) {
      ++point_start[field + 1];
      points.push_back(point);  // fields rise from direction to direction and within
    }
  for (std::size_t f = 0; f < field_lines.size(); ++f) point_start[f + 1] += point_start[f];
  outside = out.finish();
  inside = within.finish();
  if (built_with_ > release_above) release_freed_memory();
}

void LineOperator::tabulate_directions() {
  nearest_.resize(octahedron * octahedron);
  tbb::parallel_for(0, octahedron, [&](int j) {
    for (int i = 0; i < octahedron; ++i) {
      const Vec3 w = from_octahedron((i + 0.5) / octahedron * 2 - 1, (j + 0.5) / octahedron * 2 - 1);
      double best = -2;
      for (std::uint32_t d = 0; d < directions_; ++d) {
        const double cosine = glm::dot(w, projections_[d].direction);
        if (std::fabs(cosine) > best) {
          best = std::fabs(cosine);
          nearest_[j * octahedron + i] = static_cast<std::uint16_t>(2 * d + (cosine < 0 ? 1 : 0));
        }
      }
    }
  });
}

std::uint32_t LineOperator::field_of(std::size_t sense, const Vec3& p) const {
  const auto& grid = projections_[sense >> 1];
  const auto part = [&](double x, int size) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::clamp(static_cast<int>(std::floor(x)), 0, size - 1)) * pixels_ / size);
  };
  const auto column = part(glm::dot(grid.x_row, p) + grid.x0, grid.columns), row = part(glm::dot(grid.y_row, p) + grid.y0, grid.rows);
  return static_cast<std::uint32_t>(sense) * pixels_ * pixels_ + row * pixels_ + column;
}

std::uint32_t LineOperator::field_at(const Vec3& p, const Vec3& d) const {
  const auto q = to_octahedron(d);
  const auto cell = [](double x) { return std::clamp(static_cast<int>((x + 1) * 0.5 * octahedron), 0, octahedron - 1); };
  return field_of(nearest_[cell(q[1]) * octahedron + cell(q[0])], p);
}

void LineOperator::forget_links() {
  inside = {};
  outside = {};
  lines = {};
  enclosed = {};
  open_area = {};
  stand_in = {};
  points = {};
}

std::size_t LineOperator::bytes_of_directions() const {
  return bytes_of(field_lines) + bytes_of(point_start) + bytes_of(points) + bytes_of(projections_);
}

std::size_t LineOperator::bytes_kept() const {
  return bytes_of_directions() - bytes_of(points) + bytes_of(segments) + bytes_of(nearest_);
}

std::size_t LineOperator::bytes() const {
  return bytes_kept() + bytes_of(points) + bytes_of(lines) + bytes_of(stand_in) + bytes_of(enclosed) + bytes_of(open_area) +
         inside.bytes() + outside.bytes();
}

}  // namespace sunfleck
