#include <sunfleck/visibility/copies.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/visibility/projection.hpp>

#include "depth_buffer.hpp"
#include "rasterise.hpp"

namespace sunfleck {

namespace {

constexpr int tile = 256;                    // lines
constexpr std::uint32_t chunk_rows = 32;     // triangles that are left out of a tile together
constexpr std::uint32_t most_count = 65535;  // counts are 16 bits wide and stay at their largest value

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

class LitCellsCounter {
 public:
  LitCellsCounter(const CopyScene& scene, std::optional<std::uint32_t> only, LitCells& out) : scene_(scene), only_(only), out_(out) {
    for (const auto* s : scene.surfaces) chunks_.push_back(chunks_of(*s));
    out_.first.push_back(0);
    for (std::uint32_t c = 0; c < scene.copies.size(); ++c)
      out_.first.push_back(out_.first.back() + (counts(c) ? scene.surfaces[scene.copies[c].surface]->cells() : 0));
    all_.assign(out_.first.back(), 0);
    visible_.assign(out_.first.back(), 0);
  }

  void project(const Vec3& direction, double pitch, double turn, double shift_x, double shift_y) {
    lay_out(direction, pitch, turn, shift_x, shift_y);
    tbb::parallel_for(std::size_t{0}, bins_.size(), [&](std::size_t t) { count_tile(t); });
  }

  void finish(Progress& progress) {
    progress.check();
    out_.lit.resize(all_.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, all_.size(), 1 << 16), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        out_.lit[i] = all_[i] ? static_cast<std::uint8_t>((510u * visible_[i] + all_[i]) / (2u * all_[i])) : std::uint8_t{0};
    });
    for (std::size_t i = 0; i < all_.size(); ++i) out_.fragments += all_[i];
  }

 private:
  bool counts(std::uint32_t copy) const { return !only_ || copy == *only_; }

  /// Frame of the plane, every image of every copy on it, and which of them reach into which tile.
  void lay_out(const Vec3& d, double pitch, double turn, double shift_x, double shift_y) {
    Projection plane;
    plane.direction = d;
    if (scene_.periodic) {
      const auto& cell = *scene_.periodic;
      columns_ = std::max(1, static_cast<int>(std::lround(cell.width() * std::sqrt(d.z) / pitch)));
      rows_ = std::max(1, static_cast<int>(std::lround(cell.depth() * std::sqrt(d.z) / pitch)));
      const double per_x = columns_ / cell.width(), per_y = rows_ / cell.depth();
      plane.x_row = Vec3{1.0, 0.0, -d.x / d.z} * per_x;
      plane.y_row = Vec3{0.0, 1.0, -d.y / d.z} * per_y;
      plane.z_row = {0.0, 0.0, 1.0};
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
    Box range;  // of pixels
    for (std::uint32_t i = 0; i < scene_.copies.size(); ++i)
      if (!scene_.surfaces[scene_.copies[i].surface]->focus.empty()) {
        placed_.push_back(place(plane, i));
        range.add(Vec3{placed_.back().low_x, placed_.back().low_y, placed_.back().depth0});
        range.add(Vec3{placed_.back().high_x, placed_.back().high_y, placed_.back().depth0});
      }
    bins_.clear();
    if (placed_.empty()) return;
    if (scene_.periodic) {
      origin_x_ = origin_y_ = 0.0;
      repeat_images();
    } else {
      origin_x_ = std::floor(range.low.x);
      origin_y_ = std::floor(range.low.y);
      columns_ = static_cast<int>(std::ceil(range.high.x - origin_x_)) + 1;
      rows_ = static_cast<int>(std::ceil(range.high.y - origin_y_)) + 1;
    }
    tiles_x_ = (columns_ + tile - 1) / tile;
    const int tiles_y = (rows_ + tile - 1) / tile;
    bins_.resize(static_cast<std::size_t>(tiles_x_) * tiles_y);
    for (std::uint32_t k = 0; k < placed_.size(); ++k) {
      const auto& p = placed_[k];
      const int x0 = std::max(0, static_cast<int>(std::floor((p.low_x - origin_x_) / tile))),
                x1 = std::min(tiles_x_ - 1, static_cast<int>(std::floor((p.high_x - origin_x_) / tile)));
      const int y0 = std::max(0, static_cast<int>(std::floor((p.low_y - origin_y_) / tile))),
                y1 = std::min(tiles_y - 1, static_cast<int>(std::floor((p.high_y - origin_y_) / tile)));
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) bins_[static_cast<std::size_t>(y) * tiles_x_ + x].push_back(k);
    }
    if (only_)
      for (auto& bin : bins_)
        if (std::none_of(bin.begin(), bin.end(), [&](std::uint32_t k) { return counts(placed_[k].copy); })) bin.clear();
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
      const double x0 = std::floor(p.low_x / columns_), x1 = std::floor(p.high_x / columns_);
      const double y0 = std::floor(p.low_y / rows_), y1 = std::floor(p.high_y / rows_);
      const double most = 2e6 + 64.0 * static_cast<double>(placed_.size());
      if (!(static_cast<double>(all.size()) + (x1 - x0 + 1) * (y1 - y0 + 1) < most))
        throw InputError("domain.periodic", fmt::format("shadows of the sun that reach over more than {:.0f} cells", most),
                         "a cell of about the plants' size, all in metres, and a sun not as low");
      for (double y = y0; y <= y1; ++y)
        for (double x = x0; x <= x1; ++x) {
          all.push_back(p);
          auto& q = all.back();
          q.projection.x0 -= x * columns_, q.low_x -= x * columns_, q.high_x -= x * columns_;
          q.projection.y0 -= y * rows_, q.low_y -= y * rows_, q.high_y -= y * rows_;
        }
    }
    placed_ = std::move(all);
  }

  void count_tile(std::size_t t) {
    if (bins_[t].empty()) return;
    thread_local DepthBuffer buffer;
    thread_local std::vector<std::uint32_t> first_code;
    buffer.clear(tile * tile);
    first_code.clear();
    const double x_low = origin_x_ + static_cast<double>(t % tiles_x_) * tile, y_low = origin_y_ + static_cast<double>(t / tiles_x_) * tile;
    const int columns = std::min(tile, columns_ - static_cast<int>(t % tiles_x_) * tile);
    const int rows = std::min(tile, rows_ - static_cast<int>(t / tiles_x_) * tile);
    const double reference = placed_[bins_[t].front()].depth0;
    std::uint64_t base = 0;
    for (const auto k : bins_[t]) {
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
      const std::uint64_t first_cell = out_.first[placed.copy];
      const bool counted = counts(placed.copy);
      first_code.push_back(static_cast<std::uint32_t>(base));
      const auto draw = [&](std::size_t begin, std::size_t end) {
        rasterise(s, p, nullptr, begin, end, 0, rows,
                  [&](const ProjectedTriangle& triangle, int row, int column, int count, float dx, float dy) {
                    const std::size_t first = static_cast<std::size_t>(row) * tile + column;
                    draw_span(triangle, static_cast<std::uint32_t>(base) + s.first_cell[triangle.index], triangle.front_up ? 1u : 0u, 1.0f,
                              offset, count, dx, dy, 0.0f, buffer.depth.data() + first, buffer.code.data() + first,
                              [&](std::uint32_t cell, int fragments) {
                                if (counted) add_saturated(all_[first_cell + (cell - base)], static_cast<std::uint32_t>(fragments));
                              });
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
      base += s.cells();
    }
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns;) {
        const std::uint32_t code = buffer.code[static_cast<std::size_t>(row) * tile + column];
        int end = column + 1;
        while (end < columns && buffer.code[static_cast<std::size_t>(row) * tile + end] == code) ++end;
        if (code != nothing) {
          const auto image =
              static_cast<std::size_t>(std::upper_bound(first_code.begin(), first_code.end(), code >> 1) - first_code.begin()) - 1;
          if (const auto copy = placed_[bins_[t][image]].copy; counts(copy))
            add_saturated(visible_[out_.first[copy] + ((code >> 1) - first_code[image])], static_cast<std::uint32_t>(end - column));
        }
        column = end;
      }
  }

  const CopyScene& scene_;
  std::optional<std::uint32_t> only_;
  LitCells& out_;
  std::vector<std::vector<Chunk>> chunks_;
  std::vector<std::uint16_t> all_, visible_;
  std::vector<Placed> placed_;
  std::vector<std::vector<std::uint32_t>> bins_;
  double origin_x_ = 0, origin_y_ = 0;
  int columns_ = 1, rows_ = 1, tiles_x_ = 1;
};

}  // namespace

LitCells lit_cells(const CopyScene& scene, const std::vector<Vec3>& directions, double pitch, std::uint64_t seed, Progress& progress,
                   std::optional<std::uint32_t> only) {
  LitCells out;
  LitCellsCounter counter(scene, only, out);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    progress.check();
    progress.fraction("sun", static_cast<double>(i) / static_cast<double>(directions.size()));
    const auto shift = r2_point(i, unit_interval(mix(seed, 1)), unit_interval(mix(seed, 2)));
    Vec3 d = directions[i];
    if (scene.periodic && d.z < 1e-3) d = glm::normalize(Vec3{d.x, d.y, 1e-3});
    const double turn = static_cast<double>(i) * 0.6180339887498949 + unit_interval(mix(seed, 3));
    counter.project(d, pitch, 2.0 * std::numbers::pi * (turn - std::floor(turn)), shift[0], shift[1]);
  }
  counter.finish(progress);
  return out;
}

}  // namespace sunfleck
