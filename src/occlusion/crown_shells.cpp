#include <sunfleck/occlusion/crown_shells.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <Eigen/Eigenvalues>
#include <tbb/parallel_invoke.h>

namespace sunfleck {

namespace {

constexpr std::uint32_t run_facets = 64;        // a leaf of a fine mesh has about as many
constexpr std::size_t fewest_runs = 32;         // of fewer, moments say little
constexpr int most_levels = 6;                  // 64 shells
constexpr double worth_splitting = 0.7;         // of the volume
constexpr double thinnest = 0.1;                // least over greatest half axis
constexpr double variance_of_ball = 1.0 / 5.0;  // of its squared radius

/// Area, and its first and second moments.
struct AreaMoments {
  double area = 0, square_area = 0;
  Vec3 first{0.0};
  std::array<double, 6> second{};  ///< xx yy zz xy xz yz

  void add(const AreaMoments& o) {
    area += o.area, square_area += o.square_area, first += o.first;
    for (std::size_t i = 0; i < 6; ++i) second[i] += o.second[i];
  }
  Vec3 centre() const { return area > 0.0 ? first / area : Vec3{0.0}; }
};

/// Integrals over a triangle: A / 12 (sum of v v^T over the corners, and of their sum with itself).
AreaMoments moments_of(const Triangle& t) {
  AreaMoments m;
  m.area = glm::length(area_vector(t));
  const Vec3 sum = t[0] + t[1] + t[2];
  m.first = m.area / 3.0 * sum;
  const auto product = [&](int i, int j) {
    double all = sum[i] * sum[j];
    for (const auto& v : t) all += v[i] * v[j];
    return m.area / 12.0 * all;
  };
  m.second = {product(0, 0), product(1, 1), product(2, 2), product(0, 1), product(0, 2), product(1, 2)};
  return m;
}

struct Axes {
  Eigen::Matrix3d directions;  ///< columns, by rising length
  Eigen::Vector3d half;        ///< half axes [m]
  double volume() const { return 4.0 / 3.0 * std::numbers::pi * half.prod(); }
};

Axes axes_of(const AreaMoments& m) {
  const Vec3 c = m.centre();
  const double a = m.area > 0.0 ? 1.0 / m.area : 0.0;
  Eigen::Matrix3d covariance;
  const auto entry = [&](std::size_t k, int i, int j) { return a * m.second[k] - c[i] * c[j]; };
  const double xy = entry(3, 0, 1), xz = entry(4, 0, 2), yz = entry(5, 1, 2);
  covariance << entry(0, 0, 0), xy, xz, xy, entry(1, 1, 1), yz, xz, yz, entry(2, 2, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  Axes axes;
  axes.directions = solver.eigenvectors();
  const double longest = std::sqrt(std::max(solver.eigenvalues()[2], 1e-300) / variance_of_ball);
  for (int i = 0; i < 3; ++i)
    axes.half[i] = std::max(std::sqrt(std::max(solver.eigenvalues()[i], 0.0) / variance_of_ball), thinnest * longest);
  return axes;
}

CrownShell shell_of(const AreaMoments& m) {
  const Axes axes = axes_of(m);
  CrownShell shell;
  shell.centre = m.centre();
  const Eigen::Matrix3d to_ball = axes.directions * axes.half.cwiseInverse().asDiagonal() * axes.directions.transpose();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) shell.to_ball[j][i] = to_ball(i, j);
  shell.radius = std::cbrt(axes.half.prod());
  shell.leaf_area = m.area;
  shell.other_leaves = m.area > 0.0 ? std::max(0.0, 1.0 - m.square_area / (m.area * m.area)) : 0.0;
  return shell;
}

/// Runs of facets, split in two again and again.
class Splitting {
 public:
  explicit Splitting(std::vector<AreaMoments> runs) : runs_(std::move(runs)), order_(runs_.size()), shell_of_run_(runs_.size(), 0) {
    std::iota(order_.begin(), order_.end(), 0u);
  }

  CrownShells shells() {
    CrownShells out;
    const auto found = split(0, order_.size(), 0);
    for (const auto& part : found.parts) {
      for (std::size_t i = part.begin; i < part.end; ++i) shell_of_run_[order_[i]] = static_cast<std::uint8_t>(out.shells.size());
      out.shells.push_back(shell_of(sum(part.begin, part.end)));
    }
    return out;
  }
  std::uint8_t shell_of_run(std::size_t run) const { return shell_of_run_[run]; }

 private:
  struct Part {
    std::size_t begin, end;
  };
  struct Found {
    std::vector<Part> parts;
    double volume = 0;
  };

  AreaMoments sum(std::size_t begin, std::size_t end) const {
    AreaMoments all;
    for (std::size_t i = begin; i < end; ++i) all.add(runs_[order_[i]]);
    return all;
  }

  Found split(std::size_t begin, std::size_t end, int level) {
    const AreaMoments all = sum(begin, end);
    const Axes axes = axes_of(all);
    Found whole{{{begin, end}}, axes.volume()};
    if (level == most_levels || end - begin < 2 * fewest_runs) return whole;
    const Vec3 axis{axes.directions(0, 2), axes.directions(1, 2), axes.directions(2, 2)};
    const double middle = glm::dot(axis, all.centre());
    const auto at =
        std::stable_partition(order_.begin() + static_cast<std::ptrdiff_t>(begin), order_.begin() + static_cast<std::ptrdiff_t>(end),
                              [&](std::uint32_t r) { return glm::dot(axis, runs_[r].centre()) < middle; });
    const auto cut = static_cast<std::size_t>(at - order_.begin());
    if (cut - begin < fewest_runs || end - cut < fewest_runs) return whole;
    Found low, high;
    tbb::parallel_invoke([&] { low = split(begin, cut, level + 1); }, [&] { high = split(cut, end, level + 1); });
    if (low.volume + high.volume > worth_splitting * whole.volume) return whole;
    low.parts.insert(low.parts.end(), high.parts.begin(), high.parts.end());
    low.volume += high.volume;
    return low;
  }

  std::vector<AreaMoments> runs_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint8_t> shell_of_run_;
};

}  // namespace

double CrownShell::extinction() const {
  const double volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  return volume > 0.0 ? 0.5 * leaf_area * other_leaves / volume : 0.0;
}

double CrownShell::chord(const Vec3& origin, const Vec3& direction, double from, double to) const {
  const Vec3 o = to_ball * (origin - centre), d = to_ball * direction;
  const double a = glm::dot(d, d), b = glm::dot(o, d), c = glm::dot(o, o) - 1.0, root = b * b - a * c;
  if (!(root > 0.0)) return 0.0;
  const double half = std::sqrt(root);
  return std::max(0.0, std::min(to, (half - b) / a) - std::max(from, (-half - b) / a));
}

Vec3 CrownShell::half_extent() const {
  const Mat3 from_ball = glm::inverse(to_ball);
  Vec3 out;
  for (int i = 0; i < 3; ++i)
    out[i] = std::sqrt(from_ball[0][i] * from_ball[0][i] + from_ball[1][i] * from_ball[1][i] + from_ball[2][i] * from_ball[2][i]);
  return out;
}

CrownShell CrownShell::placed(const Affine& map) const {
  CrownShell out = *this;
  const double scale = std::cbrt(std::abs(glm::determinant(map.linear)));
  out.centre = map.point(centre);
  out.to_ball = to_ball * glm::inverse(map.linear);
  out.radius = radius * scale;
  out.leaf_area = leaf_area * scale * scale;
  return out;
}

CrownShells crown_shells(const Plant& plant) {
  std::vector<AreaMoments> runs;
  std::vector<std::uint32_t> facets_of_run;
  std::uint32_t organ = no_parent;
  for (const auto& shape : plant.shapes) {
    const Mesh& mesh = plant.meshes[shape.mesh];
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) {
      Triangle corners = mesh.corners(shape.first_triangle + t);
      for (auto& p : corners) p = shape.placement.point(p);
      if (runs.empty() || shape.structure != organ || facets_of_run.back() == run_facets) {
        runs.emplace_back();
        facets_of_run.push_back(0);
        organ = shape.structure;
      }
      runs.back().add(moments_of(corners));
      ++facets_of_run.back();
    }
  }
  for (auto& run : runs) run.square_area = run.area * run.area;
  Splitting splitting(std::move(runs));
  CrownShells out = splitting.shells();
  out.of_facet.reserve(plant.facet_count());
  for (std::size_t r = 0; r < facets_of_run.size(); ++r)
    out.of_facet.insert(out.of_facet.end(), facets_of_run[r], splitting.shell_of_run(r));
  return out;
}

}  // namespace sunfleck
