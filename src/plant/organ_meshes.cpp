#include <plant/organ_meshes.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunfleck {

namespace {

using std::numbers::pi;
using Corner = std::uint32_t;

Corner add(Mesh& mesh, const Vec3& p) {
  mesh.vertices.push_back(p);
  return static_cast<Corner>(mesh.vertices.size() - 1);
}

/// Tangent and front normal in the y-z plane after turning down by an angle.
Vec3 tangent(double down_rad) {
  return {0, -std::sin(down_rad), std::cos(down_rad)};
}
Vec3 normal(double down_rad) {
  return {0, std::cos(down_rad), std::sin(down_rad)};
}

}  // namespace

Mesh blade_mesh(const Outline& outline, const BladeForm& form) {
  Mesh mesh;
  Vec3 p{0.0};
  if (form.petiole_ratio > 0) {
    const double w = 0.5 * form.petiole_width_ratio, half = 0.5 * form.petiole_ratio;
    Corner left[3], right[3];
    double angle = 0;
    for (int i = 0; i < 3; ++i) {
      left[i] = add(mesh, p - Vec3{w, 0, 0});
      right[i] = add(mesh, p + Vec3{w, 0, 0});
      if (i < 2) p += half * tangent(angle);
      angle += 0.25 * form.hinge_rad;
    }
    for (int i = 0; i < 2; ++i) {
      mesh.triangles.push_back({left[i], left[i + 1], right[i]});
      mesh.triangles.push_back({right[i], left[i + 1], right[i + 1]});
    }
  }
  struct Station {
    Corner middle, left, right;
    bool wide;
  };
  Station before{};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& [s, w] = outline[i];
    const double angle = form.hinge_rad + form.curvature_rad * std::pow(s, 1.5);
    if (i > 0) {
      const double s0 = outline[i - 1][0];
      p += (s - s0) * tangent(form.hinge_rad + form.curvature_rad * std::pow(0.5 * (s + s0), 1.5));
    }
    const double half = 0.5 * form.width_ratio * w;
    Station now{add(mesh, p), 0, 0, half > 0};
    if (now.wide) {
      const Vec3 rise = half * std::sin(form.fold_rad) * normal(angle), across{half * std::cos(form.fold_rad), 0, 0};
      now.left = add(mesh, p + rise - across);
      now.right = add(mesh, p + rise + across);
    }
    if (i > 0) {
      if (before.wide) {
        mesh.triangles.push_back({before.middle, now.middle, before.right});
        mesh.triangles.push_back({before.middle, before.left, now.middle});
      }
      if (now.wide) {
        const Corner right = before.wide ? before.right : before.middle, left = before.wide ? before.left : before.middle;
        mesh.triangles.push_back({right, now.middle, now.right});
        mesh.triangles.push_back({left, now.left, now.middle});
      }
    }
    before = now;
  }
  return mesh;
}

Outline resample(const Outline& outline, std::int64_t segments) {
  Outline even;
  std::size_t k = 1;
  for (std::int64_t i = 0; i <= segments; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(segments);
    while (k + 1 < outline.size() && outline[k][0] < s) ++k;
    const auto &a = outline[k - 1], &b = outline[k];
    const double t = std::clamp((s - a[0]) / (b[0] - a[0]), 0.0, 1.0);
    even.push_back({s, a[1] + t * (b[1] - a[1])});
  }
  return even;
}

Mesh frustum_mesh(std::int64_t sides, double top) {
  Mesh mesh;
  const auto n = static_cast<Corner>(sides);
  for (Corner i = 0; i < n; ++i) {
    const double a = 2 * pi * i / n;
    add(mesh, {std::cos(a), std::sin(a), 0});
    add(mesh, {top * std::cos(a), top * std::sin(a), 1});
  }
  for (Corner i = 0; i < n; ++i) {
    const Corner j = (i + 1) % n;
    mesh.triangles.push_back({2 * i, 2 * j, 2 * i + 1});
    mesh.triangles.push_back({2 * j, 2 * j + 1, 2 * i + 1});
  }
  return mesh;
}

RachisPoint rachis_point(double curvature_rad, double s) {
  const double a = curvature_rad * s;
  if (std::abs(curvature_rad) < 1e-9) return {{0, 0, s}, tangent(a)};
  return {{0, (std::cos(a) - 1) / curvature_rad, std::sin(a) / curvature_rad}, tangent(a)};
}

Mesh rachis_mesh(double curvature_rad, double radius, std::int64_t segments) {
  Mesh mesh;
  const auto n = static_cast<Corner>(segments);
  for (Corner i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n, r = radius * (1 - 0.5 * s);
    const auto point = rachis_point(curvature_rad, s);
    for (Corner k = 0; k < 3; ++k) {
      const double a = 2 * pi * k / 3 - pi / 2;
      add(mesh, point.position + r * (std::cos(a) * Vec3{1, 0, 0} + std::sin(a) * normal(curvature_rad * s)));
    }
  }
  for (Corner i = 0; i < n; ++i)
    for (Corner k = 0; k < 3; ++k) {
      const Corner a = 3 * i + k, b = 3 * i + (k + 1) % 3;
      mesh.triangles.push_back({a, b, a + 3});
      mesh.triangles.push_back({b, b + 3, a + 3});
    }
  return mesh;
}

Mesh spindle_mesh(double radius, std::int64_t sides, std::int64_t rings) {
  Mesh mesh;
  const auto n = static_cast<Corner>(sides), m = static_cast<Corner>(rings);
  const Corner base = add(mesh, {0, 0, 0});
  for (Corner i = 0; i < m; ++i) {
    const double z = (i + 0.5) / m, r = radius * std::pow(std::sin(pi * std::pow(z, 0.8)), 0.6);
    for (Corner k = 0; k < n; ++k) add(mesh, {r * std::cos(2 * pi * k / n), r * std::sin(2 * pi * k / n), z});
  }
  const Corner tip = add(mesh, {0, 0, 1});
  for (Corner k = 0; k < n; ++k) {
    const Corner j = (k + 1) % n;
    mesh.triangles.push_back({base, 1 + j, 1 + k});
    for (Corner i = 0; i + 1 < m; ++i) {
      const Corner a = 1 + i * n + k, b = 1 + i * n + j;
      mesh.triangles.push_back({a, b, a + n});
      mesh.triangles.push_back({b, b + n, a + n});
    }
    mesh.triangles.push_back({1 + (m - 1) * n + k, 1 + (m - 1) * n + j, tip});
  }
  return mesh;
}

Mesh spike_mesh(double radius, std::int64_t spikelets, double awn) {
  const Mesh body = spindle_mesh(0.5, 4, 1);  // an octahedron
  Mesh mesh;
  const double pitch = 1.0 / static_cast<double>(spikelets + 1);
  for (std::int64_t i = 0; i < spikelets; ++i) {
    const double side = i % 2 == 0 ? 1 : -1, z = pitch * static_cast<double>(i), length = 2.2 * pitch;
    // Leans outwards by 20 degrees and touches the axis of the spike with its base.
    const double lean = side * 20 * pi / 180, c = std::cos(lean), s = std::sin(lean);
    const Mat3 lean_map{Vec3{c, 0, -s}, Vec3{0, 1, 0}, Vec3{s, 0, c}};
    const Mat3 stretch{Vec3{1.1 * radius, 0, 0}, Vec3{0, 1.4 * radius, 0}, Vec3{0, 0, length}};
    const Affine map{lean_map * stretch, {side * 0.3 * radius, 0, z}};
    append(mesh, body, map);
    if (awn > 0) {
      const Vec3 from = map.point({0, 0, 0.98}), along = glm::normalize(Vec3{side * 0.22, 0.1 * std::sin(2.4 * static_cast<double>(i)), 1});
      const Corner a = add(mesh, from - Vec3{0, 0.05 * radius, 0}), b = add(mesh, from + Vec3{0, 0.05 * radius, 0});
      mesh.triangles.push_back({a, b, add(mesh, from + awn * along)});
    }
  }
  return mesh;
}

void append(Mesh& a, const Mesh& b, const Affine& map) {
  const auto first = static_cast<Corner>(a.vertices.size());
  for (const auto& v : b.vertices) a.vertices.push_back(map.point(v));
  for (const auto& t : b.triangles) a.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace sunfleck
