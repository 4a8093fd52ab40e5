#include "instantiation/line_operator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/radiosity/interior.hpp>

namespace sunfleck {

namespace {

constexpr int octahedron = 96;  // cells along an edge of the table of directions
constexpr std::size_t segments_wanted = 288;
constexpr std::size_t row_ranges = 4;  // parts in which rows are made, one thread each

/// What one direction found: sides along lines from low to high (the upward side; its other bit is the downward one), the first of each
/// line marked; and which sides look out through which field.
struct Traced {
  std::vector<std::uint32_t> along;                          ///< sides of cells
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;  ///< (side, field)
  std::vector<std::pair<std::uint32_t, std::array<float, 3>>> points;
  std::vector<std::array<float, 6>> segments;
  std::uint64_t fragments = 0;
};

/// How often lines have met what, over all directions.
struct Hits {
  std::vector<std::uint32_t> lines;        ///< [elements] where not enclosed
  std::vector<std::uint32_t> all, inside;  ///< [cells] all, and enclosed ones; empty where nothing is interior
};

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

/// Rows from entries (row, column) that `visit(call)` lists: sorted by column, equal columns counted together.
template <class Visit>
LineOperator::Rows make_rows(std::size_t rows, const Visit& visit) {
  LineOperator::Rows out;
  out.start.assign(rows + 1, 0);
  struct Part {
    std::vector<std::uint32_t> column;
    std::vector<std::uint8_t> count;
  };
  std::vector<Part> parts(row_ranges);
  std::vector<std::uint64_t>& length = out.start;  // [row + 1], summed up below
  tbb::parallel_for(std::size_t{0}, row_ranges, [&](std::size_t r) {
    const std::size_t low = rows * r / row_ranges, high = rows * (r + 1) / row_ranges;
    if (low == high) return;
    std::vector<std::uint64_t> place(high - low + 1, 0);
    visit([&](std::uint32_t row, std::uint32_t) {
      if (row >= low && row < high) ++place[row - low + 1];
    });
    for (std::size_t i = 0; i + 1 < place.size(); ++i) place[i + 1] += place[i];
    std::vector<std::uint32_t> raw(place.back());
    auto cursor = place;
    visit([&](std::uint32_t row, std::uint32_t column) {
      if (row >= low && row < high) raw[cursor[row - low]++] = column;
    });
    cursor = {};
    auto& part = parts[r];
    std::uint64_t kept = 0;
    std::vector<std::uint8_t> count;
    count.reserve(raw.size());
    for (std::size_t i = 0; i < high - low; ++i) {
      const auto begin = raw.begin() + static_cast<std::ptrdiff_t>(place[i]), end = raw.begin() + static_cast<std::ptrdiff_t>(place[i + 1]);
      std::sort(begin, end);
      const std::uint64_t before = kept;
      for (auto k = begin; k != end;) {
        auto e = k;
        while (e != end && *e == *k && e - k < 255) ++e;
        const std::uint32_t column = *k;
        count.push_back(static_cast<std::uint8_t>(e - k));
        raw[kept++] = column;  // never beyond k: rows only get shorter
        k = e;
      }
      length[low + i + 1] = kept - before;
    }
    part.column.assign(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(kept));
    part.count.assign(count.begin(), count.end());
  });
  for (std::size_t i = 0; i < rows; ++i) out.start[i + 1] += out.start[i];
  out.column.reserve(out.start.back() + LineOperator::Rows::padding);
  out.count.reserve(out.start.back());
  for (auto& part : parts) {
    out.column.insert(out.column.end(), part.column.begin(), part.column.end());
    out.count.insert(out.count.end(), part.count.begin(), part.count.end());
    part = {};
  }
  out.column.insert(out.column.end(), LineOperator::Rows::padding, 0);
  return out;
}

}  // namespace

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
  const auto side_of = [&](std::uint32_t cell_side) { return 2 * elements.element_of_cell[cell_side >> 1] + (cell_side & 1u); };
  const double pitch = std::sqrt(0.5 * elements.organ_area / density.lines_per_organ);
  line_area = pitch * pitch;
  const std::size_t in_direction = std::size_t{pixels_} * pixels_;
  field_lines.assign(2 * directions_ * in_direction, 0.0f);
  projections_.resize(directions_);
  std::vector<Traced> traced(directions_);
  std::vector<std::uint32_t> counts(field_lines.size(), 0);
  tbb::enumerable_thread_specific<Hits> hits_of_thread([&] {
    const std::size_t cells = interior.empty() ? 0 : surface.cells();
    return Hits{std::vector<std::uint32_t>(elements.size(), 0), std::vector<std::uint32_t>(cells, 0), std::vector<std::uint32_t>(cells, 0)};
  });
  tbb::enumerable_thread_specific<LineBundle> bundles;
  const auto trace_direction = [&](std::uint32_t d) {
    LineBundle& bundle = bundles.local();
    auto& p = projections_[d];
    p = project_set_member(surface, hemisphere_direction(d, directions_, seed), d, pitch, seed);
    trace_lines(surface, p, bundle);
    auto& t = traced[d];
    t.fragments = bundle.side.size();
    t.along.reserve(bundle.side.size());
    const Vec3 x = p.x_row * line_area, y = p.y_row * line_area;  // pixel to metres
    std::vector<std::vector<std::array<float, 3>>> chosen(2 * in_direction);
    const std::size_t first_field = 2 * std::size_t{d} * in_direction;
    RandomStream random(mix(seed, d, 7));
    const std::size_t segments_per_direction = segments_wanted / directions_ + 1;
    std::uint64_t stretches = 0;
    for (int row = 0; row < p.rows; ++row)
      for (int column = 0; column < p.columns; ++column) {
        const std::size_t q = static_cast<std::size_t>(row) * p.columns + column;
        const auto begin = bundle.start[q], end = bundle.start[q + 1];
        if (begin == end) continue;
        const std::size_t first = t.along.size();
        t.along.insert(t.along.end(), bundle.side.begin() + begin, bundle.side.begin() + end);
        if (!interior.empty())
          each_enclosed(interior, bundle.side.data() + begin, end - begin, [&](std::uint32_t k) { t.along[first + k] |= dark; });
        t.along[first] |= line_begins;
        const auto point_at = [&](std::uint32_t k) {
          return (column + 0.5 - p.x0) * x + (row + 0.5 - p.y0) * y + double{bundle.depth[k]} * p.direction;
        };
        for (auto k = begin + 1; k < end; ++k) {
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
          const auto k = sense == 0 ? end - 1 : begin;
          const std::size_t local = sense * in_direction + pixel;
          if (t.along[first + (k - begin)] & dark) continue;
          t.out.emplace_back(side_of(bundle.side[k]) ^ static_cast<std::uint32_t>(sense), static_cast<std::uint32_t>(first_field + local));
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
    Hits& hits = hits_of_thread.local();
    for (const auto entry : t.along) {
      const std::uint32_t cell = (entry & ~(line_begins | dark)) >> 1;
      if (!interior.empty()) ++hits.all[cell];
      if (entry & dark)
        ++hits.inside[cell];
      else
        ++hits.lines[elements.element_of_cell[cell]];
    }
  };
  if (visitor)
    tbb::parallel_for(
        std::size_t{0}, LineVisitor::streams,
        [&](std::size_t stream) {
          for (auto d = static_cast<std::uint32_t>(stream); d < directions_ && !progress.cancelled(); d += LineVisitor::streams) {
            trace_direction(d);
            visitor->lines(stream, traced[d].along);
            traced[d].along = {};
          }
        },
        tbb::simple_partitioner());
  else
    tbb::parallel_for(std::uint32_t{0}, directions_, [&](std::uint32_t d) {
      if (!progress.cancelled()) trace_direction(d);
    });
  bundles.clear();
  progress.check();
  const std::size_t sides = 2 * elements.size();
  Hits hits = hits_of_thread.combine([](Hits a, const Hits& b) {
    const auto add = [](std::vector<std::uint32_t>& to, const std::vector<std::uint32_t>& from) {
      for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
    };
    add(a.lines, b.lines);
    add(a.all, b.all);
    add(a.inside, b.inside);
    return a;
  });
  hits_of_thread.clear();
  lines = std::move(hits.lines);
  for (const auto& t : traced) {
    fragments += t.fragments;
    segments.insert(segments.end(), t.segments.begin(), t.segments.end());
  }
  open_area = elements.area;
  if (std::any_of(hits.inside.begin(), hits.inside.end(), [](std::uint32_t n) { return n > 0; })) {
    enclosed.resize(surface.cells());
    for (std::size_t c = 0; c < enclosed.size(); ++c) {
      if (hits.all[c] > 0) enclosed[c] = static_cast<float>(hits.inside[c]) / static_cast<float>(hits.all[c]);
      open_area[elements.element_of_cell[c]] -= enclosed[c] * surface.cell_area[elements.row_of_cell[c]];
    }
    for (auto& a : open_area) a = std::max(a, 0.0f);
  }
  for (std::size_t f = 0; f < field_lines.size(); ++f) field_lines[f] = static_cast<float>(counts[f]);
  point_start.assign(field_lines.size() + 1, 0);
  for (const auto& t : traced)
    for (const auto& [field, point] : t.points) {
      ++point_start[field + 1];
      points.push_back(point);  // fields rise from direction to direction and within
    }
  for (std::size_t f = 0; f < field_lines.size(); ++f) point_start[f + 1] += point_start[f];
  outside = make_rows(sides, [&](auto&& call) {
    for (const auto& t : traced)
      for (const auto& [side, field] : t.out) call(side, field);
  });
  for (auto& t : traced) {
    t.out = {};
    t.points = {};
  }
  if (visitor) return;
  inside = make_rows(sides, [&](auto&& call) {
    for (const auto& t : traced)
      each_meeting(t.along, [&](std::uint32_t below, std::uint32_t above) {
        if (seen_ == Seen::cells) {
          call(side_of(below), above);
          call(side_of(above), below);
        } else {
          call(side_of(below), side_of(above));
          call(side_of(above), side_of(below));
        }
      });
  });
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

std::size_t LineOperator::bytes() const {
  std::size_t total = bytes_of(lines) + bytes_of(field_lines) + bytes_of(point_start) + bytes_of(points) + bytes_of(segments) +
                      bytes_of(stand_in) + bytes_of(projections_) + bytes_of(nearest_);
  for (const auto* rows : {&inside, &outside}) total += bytes_of(rows->start) + bytes_of(rows->column) + bytes_of(rows->count);
  return total;
}

}  // namespace sunfleck
