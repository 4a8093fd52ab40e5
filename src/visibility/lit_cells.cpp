#include <sunfleck/visibility/copies.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/light/level_light.hpp>
#include <sunfleck/scene/slope.hpp>
#include <sunfleck/visibility/projection.hpp>

#include "depth_buffer.hpp"
#include "golden_ratio.hpp"
#include "rasterise.hpp"

namespace sunfleck {

namespace {

constexpr int tile = 256;                      // lines
constexpr std::uint32_t chunk_rows = 32;       // triangles that are left out of a tile together
constexpr std::uint32_t most_count = 65535;    // narrow counts are 16 bits wide and stay at their largest value
constexpr double most_expected = 32000;        // lines through a cell that narrow counts are trusted with
constexpr double least_slope_of_lines = 1e-3;  // of lines in periodic scenes
constexpr double fewest_cell_lines = 1024;     // through a cell of a periodic scene

/// Bounding spheres of runs of triangles of a surface.
struct Chunk {
  Vec3 centre{0.0};
  double radius = 0;
};

std::vector<Chunk> chunks_of(const Surface& s) {
  std::vector<Chunk> out;
  for (std::size_t first = 0; first < s.size(); first += chunk_rows) {
    const std::size_t end = std::min(s.size(), first + chunk_rows);
    Box b;
    for (std::size_t t = first; t < end; ++t)
      if (s.split[t] > 0)
        for (std::size_t k = 0; k < 3; ++k) b.add(Vec3{s.corner[3 * k][t], s.corner[3 * k + 1][t], s.corner[3 * k + 2][t]});
    Chunk c;
    c.radius = -1.0;
    if (!b.empty()) {
      c.centre = b.centre();
      c.radius = 0.5 * glm::length(b.size());
    }
    out.push_back(c);
  }
  return out;
}

/// An image of a copy as it stands on the plane of the projection.
struct Placed {
  std::uint32_t copy;
  Projection projection;  ///< of the surface's coordinates, onto the whole plane
  double depth0;
  double low_x, high_x, low_y, high_y;  ///< pixels of the whole plane
};

void add_saturated(std::uint16_t& counter, std::uint32_t n) {
  std::atomic_ref<std::uint16_t> count(counter);
  std::uint16_t old = count.load(std::memory_order_relaxed);
  while (!count.compare_exchange_weak(old, static_cast<std::uint16_t>(std::min(most_count, old + n)), std::memory_order_relaxed)) {
  }
}

/// Lines that meet cells, and those that meet them first. Two bytes each; eight for copies with cells that so many lines may meet that two
/// do not hold them: large things beside small ones.
class LineCounts {
 public:
  void add_copy(std::size_t cells, bool wide) {
    auto& next = wide ? wide_cells_ : narrow_cells_;
    first_.push_back({next, wide});
    next += cells;
  }
  void allocate() {
    narrow_.assign(narrow_cells_, 0);
    wide_.assign(wide_cells_, 0);
  }
  void add(std::uint32_t copy, std::size_t cell, std::uint32_t n) {
    const auto& at = first_[copy];
    if (at.wide)
      std::atomic_ref<std::uint64_t>(wide_[at.first + cell]).fetch_add(n, std::memory_order_relaxed);
    else
      add_saturated(narrow_[at.first + cell], n);
  }
  std::uint64_t of(std::uint32_t copy, std::size_t cell) const {
    const auto& at = first_[copy];
    return at.wide ? wide_[at.first + cell] : narrow_[at.first + cell];
  }

 private:
  struct First {
    std::size_t first;
    bool wide;
  };
  std::vector<First> first_;  ///< [copies]
  std::size_t narrow_cells_ = 0, wide_cells_ = 0;
  std::vector<std::uint16_t> narrow_;
  std::vector<std::uint64_t> wide_;
};

/// Small parts are rounded up or down by chance, so that what is lit by a low sun, at its rim only, keeps its light in the mean.
std::uint8_t in_255ths(std::uint64_t visible, std::uint64_t all, std::uint64_t seed) {
  constexpr std::uint64_t small = 8;
  if (all == 0) return 0;
  if (visible == 0 || 255 * visible >= small * all) return static_cast<std::uint8_t>((510 * visible + all) / (2 * all));
  const double exact = 255.0 * static_cast<double>(visible) / static_cast<double>(all);
  return static_cast<std::uint8_t>(exact + unit_interval(seed));
}

/// How many more lines than `pitch` [m] says go through a scene: small cells of periodic ones have at least some.
double times_finer(const CopyScene& scene, const Vec3& d, double pitch) {
  return scene.periodic ? std::max(1.0, fewest_cell_lines * pitch * pitch / (scene.periodic->area() * scene.periodic->above(d))) : 1.0;
}

/// The direction that lines are followed along.
Vec3 followed(const CopyScene& scene, const Vec3& d) {
  return scene.periodic ? lifted(*scene.periodic, d, least_slope_of_lines) : d;
}

class LitCellsCounter {
 public:
  LitCellsCounter(const CopyScene& scene, const std::vector<double>& pitch, const std::vector<Vec3>& directions, LitCells& out)
      : scene_(scene), pitch_(pitch), out_(out) {
    std::vector<float> largest;  // cell of each surface
    for (const auto* s : scene.surfaces) {
      chunks_.push_back(chunks_of(*s));
      largest.push_back(0.0f);
      for (std::size_t t = 0; t < s->size(); ++t)
        if (s->split[t] > 0) largest.back() = std::max(largest.back(), s->cell_area[t]);
    }
    out_.first.push_back(0);
    for (std::uint32_t c = 0; c < scene.copies.size(); ++c) {
      const auto surface = scene.copies[c].surface;
      const Mat3& map = scene.copies[c].map.linear;
      const double scale = std::max({glm::length(map[0]), glm::length(map[1]), glm::length(map[2])});
      const std::size_t cells = pitch[c] > 0 ? scene.surfaces[surface]->cells() : 0;
      double lines = 0;
      if (cells > 0)
        for (const auto& d : directions)
          lines += largest[surface] * scale * scale * times_finer(scene, followed(scene, d), pitch[c]) / (pitch[c] * pitch[c]);
      all_.add_copy(cells, lines > most_expected);
      visible_.add_copy(cells, lines > most_expected);
      out_.first.push_back(out_.first.back() + cells);
    }
    all_.allocate();
    visible_.allocate();
  }

  /// Counts lines along `direction` that are `pitch` apart, through copies of that pitch. `share`: of the lines that bring light.
  void project(const Vec3& direction, double share, std::uint64_t seed, double pitch, double turn, double shift_x, double shift_y) {
    counted_ = pitch;
    share_ = share;
    seed_ = seed;
    lay_out(direction, turn, shift_x, shift_y);
    tbb::parallel_for(std::size_t{0}, bins_.size(), [&](std::size_t t) { count_tile(bins_[t]); });
  }

  void finish(Progress& progress) {
    progress.check();
    out_.lit.resize(out_.first.back());
    std::vector<std::uint64_t> fragments(scene_.copies.size(), 0);
    tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(fragments.size()), [&](std::uint32_t copy) {
      for (std::size_t i = 0; i < out_.first[copy + 1] - out_.first[copy]; ++i) {
        const std::uint64_t all = all_.of(copy, i), visible = visible_.of(copy, i);
        out_.lit[out_.first[copy] + i] = in_255ths(visible, all, mix(copy, i));
        fragments[copy] += all;
      }
    });
    for (const auto n : fragments) out_.fragments += n;
  }

 private:
  /// A tile and the images that reach into it.
  struct Bin {
    std::int64_t x, y;
    std::vector<std::uint32_t> images;
  };

  bool counts(std::uint32_t copy) const { return pitch_[copy] == counted_; }

  /// Frame of the plane, every image of every copy on it, and which of them reach into which tile.
  void lay_out(const Vec3& d, double turn, double shift_x, double shift_y) {
    const double pitch = counted_;
    Projection plane;
    plane.direction = d;
    if (scene_.periodic) {
      const auto& cell = *scene_.periodic;
      const double gain = cell.above(d);
      const Vec3 up{cell.above({1.0, 0.0, 0.0}), cell.above({0.0, 1.0, 0.0}), 1.0};  // the gradient of what is above the plane
      const double finer = std::sqrt(times_finer(scene_, d, pitch) * gain) / pitch;
      columns_ = std::max(std::int64_t{1}, std::int64_t{std::llround(cell.width() * finer)});
      rows_ = std::max(std::int64_t{1}, std::int64_t{std::llround(cell.depth() * finer)});
      const double per_x = static_cast<double>(columns_) / cell.width(), per_y = static_cast<double>(rows_) / cell.depth();
      plane.x_row = (Vec3{1.0, 0.0, 0.0} - d.x / gain * up) * per_x;
      plane.y_row = (Vec3{0.0, 1.0, 0.0} - d.y / gain * up) * per_y;
      plane.z_row = up;
      plane.x0 = -cell.x_low * per_x + shift_x;
      plane.y0 = -cell.y_low * per_y + shift_y;
    } else {
      Vec3 u, v;
      orthonormal_frame(d, u, v);
      const double c = std::cos(turn), s = std::sin(turn);
      plane.x_row = (c * u + s * v) / pitch;
      plane.y_row = (c * v - s * u) / pitch;
      plane.z_row = d;
      plane.x0 = shift_x;
      plane.y0 = shift_y;
    }
    placed_.clear();
    Box range;  // of pixels that are counted
    for (std::uint32_t i = 0; i < scene_.copies.size(); ++i)
      if (!scene_.surfaces[scene_.copies[i].surface]->focus.empty()) {
        placed_.push_back(place(plane, i));
        if (!counts(i)) continue;
        range.add(Vec3{placed_.back().low_x, placed_.back().low_y, placed_.back().depth0});
        range.add(Vec3{placed_.back().high_x, placed_.back().high_y, placed_.back().depth0});
      }
    bins_.clear();
    if (range.empty()) return;
    if (scene_.periodic) {
      origin_x_ = origin_y_ = 0.0;
      repeat_images();
    } else {
      origin_x_ = std::floor(range.low.x);
      origin_y_ = std::floor(range.low.y);
      columns_ = static_cast<std::int64_t>(std::ceil(range.high.x - origin_x_)) + 1;
      rows_ = static_cast<std::int64_t>(std::ceil(range.high.y - origin_y_)) + 1;
    }
    fill_bins();
  }

  /// Tiles that an image reaches into, the last of each axis included.
  struct Tiles {
    std::int64_t x0, x1, y0, y1;
    bool empty() const { return x1 < x0 || y1 < y0; }
    double count() const { return empty() ? 0.0 : static_cast<double>(x1 - x0 + 1) * static_cast<double>(y1 - y0 + 1); }
    bool holds(const Bin& bin) const { return bin.x >= x0 && bin.x <= x1 && bin.y >= y0 && bin.y <= y1; }
  };
  Tiles tiles_of(const Placed& p) const {
    const auto at = [](double pixel, std::int64_t size) {
      return static_cast<std::int64_t>(std::clamp(std::floor(pixel / tile), -1.0, static_cast<double>((size - 1) / tile + 1)));
    };
    return {std::max(std::int64_t{0}, at(p.low_x - origin_x_, columns_)),
            std::min((columns_ - 1) / tile, at(p.high_x - origin_x_, columns_)), std::max(std::int64_t{0}, at(p.low_y - origin_y_, rows_)),
            std::min((rows_ - 1) / tile, at(p.high_y - origin_y_, rows_))};
  }

  /// Tiles that something counted reaches into, and all that reaches into them.
  void fill_bins() {
    const std::int64_t across = (columns_ - 1) / tile + 1;
    std::vector<std::int64_t> wanted;
    for (const auto& p : placed_)
      if (counts(p.copy)) {
        const Tiles t = tiles_of(p);
        for (auto y = t.y0; y <= t.y1; ++y)
          for (auto x = t.x0; x <= t.x1; ++x) wanted.push_back(y * across + x);
      }
    tbb::parallel_sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    bins_.resize(wanted.size());
    for (std::size_t k = 0; k < wanted.size(); ++k) bins_[k] = {wanted[k] % across, wanted[k] / across, {}};
    for (std::uint32_t k = 0; k < placed_.size(); ++k) {
      const Tiles t = tiles_of(placed_[k]);
      if (t.count() > static_cast<double>(wanted.size())) {
        for (auto& bin : bins_)
          if (t.holds(bin)) bin.images.push_back(k);
        continue;
      }
      for (auto y = t.y0; y <= t.y1; ++y) {
        auto at = static_cast<std::size_t>(std::lower_bound(wanted.begin(), wanted.end(), y * across + t.x0) - wanted.begin());
        for (; at < bins_.size() && bins_[at].y == y && bins_[at].x <= t.x1; ++at) bins_[at].images.push_back(k);
      }
    }
  }

  Placed place(const Projection& plane, std::uint32_t i) const {
    const auto& copy = scene_.copies[i];
    const Surface& s = *scene_.surfaces[copy.surface];
    Placed out;
    out.copy = i;
    out.projection = plane;
    const Mat3 back = glm::transpose(copy.map.linear);
    const Vec3 at = copy.map.point(s.origin);
    out.projection.x_row = back * plane.x_row;
    out.projection.y_row = back * plane.y_row;
    out.projection.z_row = back * plane.z_row;
    out.projection.x0 = glm::dot(plane.x_row, at) + plane.x0;
    out.projection.y0 = glm::dot(plane.y_row, at) + plane.y0;
    out.depth0 = glm::dot(plane.z_row, at);
    const Vec3 middle = s.focus.centre(), half = 0.5 * s.focus.size();
    const double x = glm::dot(out.projection.x_row, middle) + out.projection.x0, rx = glm::dot(glm::abs(out.projection.x_row), half);
    const double y = glm::dot(out.projection.y_row, middle) + out.projection.y0, ry = glm::dot(glm::abs(out.projection.y_row), half);
    out.low_x = x - rx - 1, out.high_x = x + rx + 1, out.low_y = y - ry - 1, out.high_y = y + ry + 1;
    return out;
  }

  /// Every image that reaches into the cell. Images of one copy differ in depth by nothing, as a line of a cell goes on in the next.
  void repeat_images() {
    std::vector<Placed> all;
    for (const auto& p : placed_) {
      const auto columns = static_cast<double>(columns_), rows = static_cast<double>(rows_);
      const double x0 = std::floor(p.low_x / columns), x1 = std::floor(p.high_x / columns);
      const double y0 = std::floor(p.low_y / rows), y1 = std::floor(p.high_y / rows);
      const double most = 2e6 + 64.0 * static_cast<double>(placed_.size());
      if (!(static_cast<double>(all.size()) + (x1 - x0 + 1) * (y1 - y0 + 1) < most))
        throw InputError("domain.periodic", fmt::format("shadows of the sun that reach over more than {:.0f} cells", most),
                         "a cell of about the plants' size, all in metres, and a sun not as low");
      for (double y = y0; y <= y1; ++y)
        for (double x = x0; x <= x1; ++x) {
          all.push_back(p);
          auto& q = all.back();
          q.projection.x0 -= x * columns, q.low_x -= x * columns, q.high_x -= x * columns;
          q.projection.y0 -= y * rows, q.low_y -= y * rows, q.high_y -= y * rows;
        }
    }
    placed_ = std::move(all);
  }

  void count_tile(const Bin& bin) {
    thread_local DepthBuffer buffer;
    thread_local std::vector<std::uint32_t> first_code;
    buffer.clear(tile * tile);
    first_code.clear();
    const double x_low = origin_x_ + static_cast<double>(bin.x) * tile, y_low = origin_y_ + static_cast<double>(bin.y) * tile;
    const int columns = static_cast<int>(std::min<std::int64_t>(tile, columns_ - bin.x * tile));
    const int rows = static_cast<int>(std::min<std::int64_t>(tile, rows_ - bin.y * tile));
    const double reference = placed_[bin.images.front()].depth0;
    std::uint64_t base = 0;
    for (const auto k : bin.images) {
      const auto& placed = placed_[k];
      const auto surface = scene_.copies[placed.copy].surface;
      const Surface& s = *scene_.surfaces[surface];
      Projection p = placed.projection;
      p.x0 -= x_low;
      p.y0 -= y_low;
      p.columns = columns;
      p.rows = rows;
      p.wraps = false;
      const auto offset = static_cast<float>(placed.depth0 - reference);
      const double scale_x = glm::length(p.x_row), scale_y = glm::length(p.y_row);
      const bool counted = counts(placed.copy);
      first_code.push_back(static_cast<std::uint32_t>(base));
      const auto draw = [&](std::size_t begin, std::size_t end) {
        rasterise(s, p, nullptr, begin, end, 0, rows,
                  [&](const ProjectedTriangle& triangle, int row, int column, int count, float dx, float dy) {
                    const std::size_t first = static_cast<std::size_t>(row) * tile + column;
                    float* depth = buffer.depth.data() + first;
                    std::uint32_t* code = buffer.code.data() + first;
                    const std::uint32_t front = triangle.front_up ? 1u : 0u;
                    if (counted) {
                      draw_span(triangle, static_cast<std::uint32_t>(base) + s.first_cell[triangle.index], front, 1.0f, offset, count, dx,
                                dy, 0.0f, depth, code, [&](std::uint32_t cell, int fragments) {
                                  all_.add(placed.copy, cell - base, static_cast<std::uint32_t>(fragments));
                                });
                    } else {  // one code for all that only shades
                      ProjectedTriangle whole = triangle;
                      whole.split = 1;
                      draw_span(whole, static_cast<std::uint32_t>(base), front, 1.0f, offset, count, dx, dy, 0.0f, depth, code,
                                [](std::uint32_t, int) {});
                    }
                  });
      };
      std::size_t begin = 0, end = 0;  // a run of chunks that may reach into the tile
      const auto& chunks = chunks_[surface];
      for (std::size_t c = 0; c < chunks.size(); ++c) {
        const double x = glm::dot(p.x_row, chunks[c].centre) + p.x0, y = glm::dot(p.y_row, chunks[c].centre) + p.y0;
        const double rx = chunks[c].radius * scale_x + 1, ry = chunks[c].radius * scale_y + 1;
        if (chunks[c].radius < 0 || x + rx < 0 || y + ry < 0 || x - rx > columns || y - ry > rows) continue;
        if (c * chunk_rows != end) {
          draw(begin, end);
          begin = c * chunk_rows;
        }
        end = std::min(s.size(), (c + 1) * std::size_t{chunk_rows});
      }
      draw(begin, end);
      base += counted ? s.cells() : 1;
    }
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns;) {
        const std::uint32_t code = buffer.code[static_cast<std::size_t>(row) * tile + column];
        int end = column + 1;
        while (end < columns && buffer.code[static_cast<std::size_t>(row) * tile + end] == code) ++end;
        if (code != nothing) {
          const auto image =
              static_cast<std::size_t>(std::upper_bound(first_code.begin(), first_code.end(), code >> 1) - first_code.begin()) - 1;
          if (const auto copy = placed_[bin.images[image]].copy; counts(copy))
            visible_.add(copy, (code >> 1) - first_code[image], bring_light(end - column, bin, row, column));
        }
        column = end;
      }
    }
  }

  /// Of the lines of a run, those that bring light; by chance, so that they are as many in the mean.
  std::uint32_t bring_light(int lines, const Bin& bin, int row, int column) const {
    if (share_ >= 1.0) return static_cast<std::uint32_t>(lines);
    const double chance =
        unit_interval(mix(seed_, static_cast<std::uint64_t>(bin.x), static_cast<std::uint64_t>(bin.y) << 16 | row << 8 | column));
    return static_cast<std::uint32_t>(share_ * lines + chance);
  }

  const CopyScene& scene_;
  const std::vector<double>& pitch_;
  LitCells& out_;
  std::vector<std::vector<Chunk>> chunks_;
  LineCounts all_, visible_;
  std::uint64_t seed_ = 0;          ///< of the direction
  double counted_ = 0, share_ = 1;  ///< pitch of the copies that are counted; of their lines that bring light
  std::vector<Placed> placed_;
  std::vector<Bin> bins_;
  double origin_x_ = 0, origin_y_ = 0;
  std::int64_t columns_ = 1, rows_ = 1;
};

}  // namespace

LitCells lit_cells(const CopyScene& scene, const std::vector<Vec3>& directions, const std::vector<double>& pitch, std::uint64_t seed,
                   Progress& progress) {
  LitCells out;
  LitCellsCounter counter(scene, pitch, directions, out);
  std::vector<double> pitches;  // different ones, what only shades left out
  for (const double p : pitch)
    if (p > 0) pitches.push_back(p);
  std::sort(pitches.begin(), pitches.end());
  pitches.erase(std::unique(pitches.begin(), pitches.end()), pitches.end());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    progress.check();
    progress.fraction("sun", static_cast<double>(i) / static_cast<double>(directions.size()));
    const auto shift = r2_point(i, unit_interval(mix(seed, 1)), unit_interval(mix(seed, 2)));
    const Vec3 d = followed(scene, directions[i]);
    const double share = scene.periodic ? share_of_level_light(scene.periodic->levelled(directions[i]), least_slope_of_lines) : 1.0;
    const double turn = static_cast<double>(i) * golden_ratio_fraction + unit_interval(mix(seed, 3));
    for (const double p : pitches)
      counter.project(d, share, mix(seed, 4, i), p, 2.0 * std::numbers::pi * (turn - std::floor(turn)), shift[0], shift[1]);
  }
  counter.finish(progress);
  return out;
}

}  // namespace sunfleck
