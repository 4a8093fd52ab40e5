#include <format/polygons.hpp>

#include <algorithm>
#include <cmath>
#include <deque>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

using Point = glm::dvec2;

constexpr double warp = 0.1;                       ///< distance from the mean plane, of the polygon's size, that is worth a note
constexpr double flat_angle = 1e-13;               ///< areas of triangles, of the square of the polygon's size, that are rounding
constexpr double fan_rounding = 1e-9;              ///< the same of a whole fan
constexpr std::uint64_t most_tests = 300'000'000;  ///< of a corner against an ear: a second or two

/// Corners by the cell of a square raster that they lie in.
class Raster {
 public:
  Raster(const std::vector<Point>& points, const std::vector<std::uint32_t>& members) : points_(points) {
    for (const auto& p : points) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
    }
    side_ = std::max<int>(1, static_cast<int>(std::sqrt(static_cast<double>(members.size()))));
    begin_.assign(static_cast<std::size_t>(side_ * side_) + 1, 0);
    for (const auto m : members) ++begin_[cell(points[m]) + 1];
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    members_.resize(members.size());
    auto at = begin_;
    for (const auto m : members) members_[at[cell(points[m])]++] = m;
  }

  /// Calls visit(corner) for those that may lie in the box, until it returns true.
  template <class Visit>
  bool any(const Point& low, const Point& high, Visit&& visit) const {
    for (int y = row(low.y, low_.y, high_.y); y <= row(high.y, low_.y, high_.y); ++y)
      for (int x = row(low.x, low_.x, high_.x); x <= row(high.x, low_.x, high_.x); ++x) {
        const auto c = static_cast<std::size_t>(y * side_ + x);
        for (std::size_t i = begin_[c]; i < begin_[c + 1]; ++i)
          if (visit(members_[i])) return true;
      }
    return false;
  }

 private:
  int row(double v, double low, double high) const {
    return high > low ? std::clamp(static_cast<int>((v - low) / (high - low) * side_), 0, side_ - 1) : 0;
  }
  std::size_t cell(const Point& p) const { return static_cast<std::size_t>(row(p.y, low_.y, high_.y) * side_ + row(p.x, low_.x, high_.x)); }
  const std::vector<Point>& points_;
  Point low_{0, 0}, high_{0, 0};
  int side_ = 1;
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> members_;
};

double area2(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A polygon that loses an ear at a time.
class EarClipper {
 public:
  EarClipper(const std::vector<Point>& points, std::vector<std::array<std::uint32_t, 3>>& out)
      : points_(points), out_(out), raster_(points, find_reflex()), waiting_(points.size()) {}

  /// Corners of triangles are numbers of points. False if the polygon crosses itself.
  bool clip(const std::string& file, long line) {
    const auto n = static_cast<std::uint32_t>(points_.size());
    std::deque<std::uint32_t> next_ones;
    for (std::uint32_t i = 0; i < n; ++i) next_ones.push_back(i);
    bool simple = true;
    for (std::uint32_t left = n; left > 3; --left) {
      if (tests_ > most_tests)
        throw InputError(location(file, line), fmt::format("a polygon of {} corners that is too intricate to be cut into triangles", n),
                         "polygons of fewer corners, or triangles");
      std::uint32_t ear = n;
      while (ear == n && !next_ones.empty()) {
        const std::uint32_t v = next_ones.front();
        next_ones.pop_front();
        if (alive_[v] && turn(v) > flat_angle && !blocked(v, true)) ear = v;
      }
      if (ear == n)
        ear = last_resort(simple);
      else
        no_touching_ear_ = false;
      out_.push_back({before_[ear], ear, after_[ear]});
      alive_[ear] = false;
      after_[before_[ear]] = after_[ear];
      before_[after_[ear]] = before_[ear];
      some_ = after_[ear];
      for (const auto v : {before_[ear], after_[ear]}) {
        next_ones.push_back(v);
        if (reflex_[v] && turn(v) > flat_angle) reflex_[v] = false, release(v, next_ones);
      }
      release(ear, next_ones);
    }
    out_.push_back({before_[some_], some_, after_[some_]});
    return simple && turn(some_) > -flat_angle;
  }

 private:
  std::vector<std::uint32_t> find_reflex() {
    const auto n = static_cast<std::uint32_t>(points_.size());
    alive_.assign(n, true), reflex_.assign(n, false);
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < n; ++i) {
      before_.push_back((i + n - 1) % n), after_.push_back((i + 1) % n);
    }
    for (std::uint32_t i = 0; i < n; ++i)
      if (turn(i) <= flat_angle) reflex_[i] = true, all.push_back(i);
    return all;
  }

  double turn(std::uint32_t v) const { return area2(points_[before_[v]], points_[v], points_[after_[v]]); }

  /// Whether a corner lies in the triangle of corner v, or on its border if asked; where one does, v waits for it.
  bool blocked(std::uint32_t v, bool border) {
    const Point &a = points_[before_[v]], &b = points_[v], &c = points_[after_[v]];
    const Point low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})}, high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
    const double edge = border ? 0.0 : flat_angle;
    return raster_.any(low, high, [&](std::uint32_t r) {
      ++tests_;
      const Point& p = points_[r];
      if (!alive_[r] || !reflex_[r] || p == a || p == b || p == c) return false;
      if (area2(a, b, p) < edge || area2(b, c, p) < edge || area2(c, a, p) < edge) return false;
      waiting_[r].push_back(v);
      return true;
    });
  }

  void release(std::uint32_t v, std::deque<std::uint32_t>& next_ones) {
    next_ones.insert(next_ones.end(), waiting_[v].begin(), waiting_[v].end());
    waiting_[v].clear();
  }

  /// Where no corner is an ear: one whose cut touches the outline, one that is straight, or, in a polygon that crosses itself, any.
  std::uint32_t last_resort(bool& simple) {
    std::uint32_t straight = no_corner, outward = no_corner, v = some_;
    do {
      ++tests_;
      const double t = turn(v);
      if (t > flat_angle) {
        if (!no_touching_ear_ && !blocked(v, false)) return v;
        if (outward == no_corner) outward = v;
      } else if (t >= -flat_angle && straight == no_corner) {
        straight = v;
        if (no_touching_ear_) return v;
      }
      v = after_[v];
    } while (v != some_);
    no_touching_ear_ = straight != no_corner;  // to cut it off changes nothing for the others
    if (straight != no_corner) return straight;
    simple = false;
    return outward != no_corner ? outward : some_;
  }

  static constexpr std::uint32_t no_corner = 0xffffffffu;
  const std::vector<Point>& points_;
  std::vector<std::array<std::uint32_t, 3>>& out_;
  std::vector<std::uint32_t> before_, after_;
  std::vector<char> alive_, reflex_;
  Raster raster_;                                    ///< corners that turn inwards: only they can lie in an ear
  std::vector<std::vector<std::uint32_t>> waiting_;  ///< corners that would be ears but for this one
  std::uint32_t some_ = 0;                           ///< one that is left
  bool no_touching_ear_ = false;                     ///< the last round of all corners found none
  std::uint64_t tests_ = 0;
};

}  // namespace

/// False where the corners enclose nothing.
bool PolygonCutter::project(const std::vector<Vec3>& vertices, std::span<const std::uint32_t> corners) {
  const Vec3 origin = vertices[corners[0]];
  const std::size_t n = corners.size();
  double size = 0;
  Vec3 longest{0.0};
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 p = vertices[corners[i]] - origin, edge = vertices[corners[(i + 1) % n]] - vertices[corners[i]];
    size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (glm::dot(edge, edge) > glm::dot(longest, longest)) longest = edge;
  }
  if (!(size > 0) || !std::isfinite(size)) return false;
  Vec3 normal{0.0};
  for (std::size_t i = 1; i + 1 < n; ++i)
    normal += glm::cross((vertices[corners[i]] - origin) / size, (vertices[corners[i + 1]] - origin) / size);
  if (!(glm::length(normal) > flat_angle)) {  // a line, or lobes that cancel
    for (std::size_t k = 2; k < n; ++k)
      if (glm::length(glm::cross((vertices[corners[k - 1]] - origin) / size, (vertices[corners[k]] - origin) / size)) > fan_rounding) {
        ++crossing_;
        break;
      }
    return false;
  }
  normal = glm::normalize(normal);
  // along the longest edge, so that the teeth of a comb lie along the raster
  Vec3 u = longest - glm::dot(longest, normal) * normal;
  if (!(glm::length(u) > 0) || !std::isfinite(glm::length(u))) return false;
  u = glm::normalize(u);
  const Vec3 v = glm::cross(normal, u);
  points_.clear();
  double below = 0, above = 0;
  for (const auto c : corners) {
    const Vec3 p = (vertices[c] - origin) / size;
    points_.push_back({glm::dot(u, p), glm::dot(v, p)});
    below = std::min(below, glm::dot(normal, p));
    above = std::max(above, glm::dot(normal, p));
  }
  if (above - below > 2 * warp) ++warped_;
  return true;
}

bool PolygonCutter::fan_covers() const {
  double all = 0, against = 0;
  for (std::size_t k = 2; k < points_.size(); ++k) {
    const double a = area2(points_[0], points_[k - 1], points_[k]);
    all += std::abs(a);
    if (a < 0) against -= a;
  }
  return against <= fan_rounding * all;
}

const std::vector<std::array<std::uint32_t, 3>>& PolygonCutter::cut(const std::vector<Vec3>& vertices,
                                                                    std::span<const std::uint32_t> corners, const std::string& file,
                                                                    long line) {
  triangles_.clear();
  const auto n = static_cast<std::uint32_t>(corners.size());
  if (n > 3 && project(vertices, corners) && !fan_covers()) {
    if (!EarClipper(points_, triangles_).clip(file, line)) ++crossing_;
  } else {
    for (std::uint32_t k = 2; k < n; ++k) triangles_.push_back({0, k - 1, k});
  }
  for (auto& t : triangles_)
    for (auto& i : t) i = corners[i];
  return triangles_;
}

void PolygonCutter::note(const std::string& file, std::vector<std::string>& notes) const {
  const auto some = [](std::size_t n, const char* does, const char* do_it) {
    return n == 1 ? fmt::format("1 polygon {}", does) : fmt::format("{} polygons {}", n, do_it);
  };
  if (crossing_ > 0)
    notes.push_back(fmt::format("{}: {}: cut into triangles that overlap or have another area than what its outline encloses", file,
                                some(crossing_, "crosses itself", "cross themselves")));
  if (warped_ > 0)
    notes.push_back(
        fmt::format("{}: {} (a corner lies more than a tenth of the polygon's size from its mean plane): its area depends on how "
                    "it is cut into triangles",
                    file, some(warped_, "is far from flat", "are far from flat")));
}

}  // namespace sunfleck
