#include "policy/similarity.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace sunfleck {

namespace {

using Matrix = Eigen::Matrix3d;

Matrix to_eigen(const Mat3& m) {
  Matrix e;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) e(r, c) = m[c][r];
  return e;
}
Mat3 from_eigen(const Matrix& e) {
  Mat3 m;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) m[c][r] = e(r, c);
  return m;
}

Vec3 middle(const std::vector<Triangle>& facets) {
  Vec3 sum{0.0};
  for (const auto& t : facets) sum += t[0] + t[1] + t[2];
  return sum / (3.0 * static_cast<double>(facets.size()));
}

double spread(const std::vector<Triangle>& facets, const Vec3& centre) {
  double sum = 0;
  for (const auto& t : facets)
    for (const auto& p : t) sum += glm::dot(p - centre, p - centre);
  return std::sqrt(sum / (3.0 * static_cast<double>(facets.size())));
}

/// The orthogonal matrix of the sign given that is nearest to m.
Mat3 orthogonal_part(const Mat3& m, double sign) {
  const Eigen::JacobiSVD<Matrix> svd(to_eigen(m), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix d = Matrix::Identity();
  d(2, 2) = svd.matrixU().determinant() * svd.matrixV().determinant() * sign > 0 ? 1.0 : -1.0;
  return from_eigen(svd.matrixU() * d * svd.matrixV().transpose());
}

}  // namespace

std::optional<Similarity> find_similarity(const std::vector<Triangle>& from, const std::vector<Triangle>& to, double tolerance) {
  if (from.empty() || from.size() != to.size()) return {};
  const Vec3 a = middle(from), b = middle(to);
  const double size_a = spread(from, a), size_b = spread(to, b);
  if (!(size_a > 0 && size_b > 0)) return {};
  const double scale = size_b / size_a, allowed = tolerance * size_b;
  for (const bool mirrors : {false, true}) {
    const auto corner = [mirrors](std::size_t k) { return mirrors && k > 0 ? 3 - k : k; };
    Mat3 sum{0.0};
    for (std::size_t i = 0; i < from.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) sum += glm::outerProduct(to[i][corner(k)] - b, from[i][k] - a);
    const Mat3 turn = orthogonal_part(sum, mirrors ? -1.0 : 1.0), linear = scale * turn;
    bool fits = true;
    for (std::size_t i = 0; i < from.size() && fits; ++i)
      for (std::size_t k = 0; k < 3 && fits; ++k) fits = glm::length(linear * (from[i][k] - a) + b - to[i][corner(k)]) <= allowed;
    if (fits) return Similarity{scale, turn, b - linear * a};
  }
  return {};
}

std::optional<double> uniform_scale(const Mat3& linear) {
  const auto found = similarity_of({linear, Vec3{0.0}}, 1e-9);
  return found ? std::optional(found->scale) : std::nullopt;
}

Mat3 alignment(Alignment align, const Affine& frame) {
  const Mat3 own = nearest_rotation(frame.linear);
  if (align == Alignment::frame) return own;
  const bool vertical = std::hypot(own[2].x, own[2].y) < 1e-6;
  const Vec3& along = vertical ? own[0] : own[2];
  return Affine::turn(std::atan2(along.y, along.x)).linear;
}

Mat3 nearest_rotation(const Mat3& linear) {
  return orthogonal_part(linear, glm::determinant(linear) < 0 ? -1.0 : 1.0);
}

}  // namespace sunfleck
