#include "original/hull.hpp"

#include <cmath>
#include <cstdio>

#include <Eigen/Eigenvalues>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

constexpr double least_thickness = 1e-6;

/// Points as rows of three, relative to `centre`, in units of their largest distance from it; flat directions are given a thickness.
std::vector<double> solid_points(const std::vector<Triangle>& facets, const Vec3& centre, double largest) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& t : facets)
    for (const auto& p : t) {
      const Eigen::Vector3d v = Eigen::Vector3d(p.x - centre.x, p.y - centre.y, p.z - centre.z) / largest;
      spread += v * v.transpose();
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  std::vector<Eigen::Vector3d> shifts{Eigen::Vector3d::Zero()};
  const double size = std::sqrt(axes.eigenvalues()(2));
  for (int k = 0; k < 2; ++k) {
    if (std::sqrt(std::max(axes.eigenvalues()(k), 0.0)) > 10 * least_thickness * size) continue;
    std::vector<Eigen::Vector3d> both;
    for (const auto& s : shifts)
      for (const double sign : {-1.0, 1.0}) both.push_back(s + 0.5 * sign * least_thickness * axes.eigenvectors().col(k));
    shifts = both;
  }
  std::vector<double> points;
  points.reserve(9 * facets.size() * shifts.size());
  for (const auto& t : facets)
    for (const auto& p : t)
      for (const auto& s : shifts)
        for (int c = 0; c < 3; ++c) points.push_back((p[c] - centre[c]) / largest + s(c));
  return points;
}

}  // namespace

std::vector<Triangle> convex_hull(const std::vector<Triangle>& facets) {
  if (facets.empty()) throw Error("the convex hull of nothing");
  Vec3 centre{0.0};
  for (const auto& t : facets) centre += (t[0] + t[1] + t[2]) / (3.0 * static_cast<double>(facets.size()));
  double largest = 0;
  for (const auto& t : facets)
    for (const auto& p : t) largest = std::max(largest, glm::length(p - centre));
  if (!(largest > 0)) throw Error("the convex hull of a single point");
  std::vector<double> points = solid_points(facets, centre, largest);

  qhT state;
  qhT* qh = &state;
  qh_zero(qh, stderr);
  std::FILE* silent = std::fopen("/dev/null", "w");
  char command[] = "qhull Qt Pp";
  const int failed =
      qh_new_qhull(qh, 3, static_cast<int>(points.size() / 3), points.data(), False, command, nullptr, silent ? silent : stderr);
  std::vector<Triangle> hull;
  if (!failed) {
    for (facetT* facet = qh->facet_list; facet && facet->next; facet = facet->next) {
      Triangle t;
      std::size_t k = 0;
      for (int i = 0; k < 3 && facet->vertices->e[i].p; ++i) {
        const coordT* p = static_cast<vertexT*>(facet->vertices->e[i].p)->point;
        t[k++] = centre + largest * Vec3{p[0], p[1], p[2]};
      }
      if (glm::dot(area_vector(t), Vec3{facet->normal[0], facet->normal[1], facet->normal[2]}) < 0) std::swap(t[1], t[2]);
      hull.push_back(t);
    }
  }
  qh_freeqhull(qh, !qh_ALL);
  int kept = 0, total = 0;
  qh_memfreeshort(qh, &kept, &total);
  if (silent) std::fclose(silent);
  if (failed || hull.size() < 4)
    throw Error("no convex hull of " + std::to_string(facets.size()) + " facets (Qhull error " + std::to_string(failed) + ")");
  return hull;
}

}  // namespace sunfleck
