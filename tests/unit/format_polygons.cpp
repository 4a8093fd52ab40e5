#include <format/polygons.hpp>

#include <catch2/catch.hpp>

#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include <format_files.hpp>
#include <sunfleck/format/read_plant.hpp>

using namespace sunfleck;

namespace {

constexpr double pi = std::numbers::pi;

using Corners = std::vector<std::array<std::uint32_t, 3>>;

struct Cut {
  Corners triangles;
  std::vector<std::string> notes;
  double area = 0;         ///< sum over the triangles
  double signed_area = 0;  ///< the same along the polygon's front
};

Cut cut(const std::vector<Vec3>& polygon) {
  PolygonCutter cutter;
  std::vector<std::uint32_t> corners(polygon.size());
  std::iota(corners.begin(), corners.end(), 0u);
  Cut out;
  out.triangles = cutter.cut(polygon, corners, "plant.obj", 7);
  cutter.note("plant.obj", out.notes);
  Vec3 normal{0.0};
  for (std::size_t i = 2; i < polygon.size(); ++i) normal += area_vector({polygon[0], polygon[i - 1], polygon[i]});
  for (const auto& t : out.triangles) {
    const Vec3 a = area_vector({polygon[t[0]], polygon[t[1]], polygon[t[2]]});
    out.area += glm::length(a);
    out.signed_area += glm::dot(a, glm::normalize(normal));
  }
  return out;
}

/// Twice the area that an outline in the plane encloses, by the shoelace formula.
double shoelace(const std::vector<Vec3>& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    sum += p.x * q.y - p.y * q.x;
  }
  return 0.5 * sum;
}

std::vector<Vec3> starting_at(std::vector<Vec3> polygon, std::size_t first) {
  std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(first), polygon.end());
  return polygon;
}

Corners fan(std::uint32_t n) {
  Corners out;
  for (std::uint32_t k = 2; k < n; ++k) out.push_back({0, k - 1, k});
  return out;
}

const std::vector<Vec3> arrow{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}};

}  // namespace

TEST_CASE("A polygon that its first corner sees all of stays a fan, any other is cut without overlap", "[format][polygons]") {
  CHECK(cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).triangles == fan(4));
  CHECK(cut(starting_at(arrow, 3)).triangles == fan(5));  // from the corner that turns inwards
  for (std::size_t first = 0; first < arrow.size(); ++first) {
    const auto polygon = starting_at(arrow, first);
    const auto a = cut(polygon), b = cut(polygon);
    INFO(first);
    CHECK(a.triangles.size() == 3);
    CHECK(a.triangles == b.triangles);
    CHECK(a.area == Approx(2.5).epsilon(1e-14));
    CHECK(a.signed_area == Approx(2.5).epsilon(1e-14));  // the polygon's own front
    CHECK(a.notes.empty());
  }
}

TEST_CASE("Random outlines that see their middle are cut to the area that they enclose, however they lie in space", "[format][polygons]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> radius(0.05, 1.0), angle(0, 2 * pi);
  for (int k = 0; k < 200; ++k) {
    const int n = 4 + k % 60;
    std::vector<Vec3> flat, turned;
    const Affine map = Affine{Mat3{Vec3{0.6, 0, 0.8}, Vec3{0, 1, 0}, Vec3{-0.8, 0, 0.6}}, Vec3{5e5, -3, 7}} * Affine::turn(angle(random));
    for (int i = 0; i < n; ++i) {
      const double r = radius(random), a = 2 * pi * i / n;
      flat.push_back({r * std::cos(a), r * std::sin(a), 0});
      turned.push_back(map.point(flat.back()));
    }
    const auto one = cut(turned);
    INFO(k);
    CHECK(one.triangles.size() == static_cast<std::size_t>(n - 2));
    CHECK(one.area == Approx(shoelace(flat)).epsilon(1e-8));
    CHECK(one.notes.empty());
  }
}

TEST_CASE("Combs, holes behind a bridge and straight corners", "[format][polygons]") {
  SECTION("a comb of many teeth, askew") {
    std::vector<Vec3> comb;
    constexpr int teeth = 2000;
    for (int i = 0; i < teeth; ++i)
      comb.insert(comb.end(), {Vec3{2.0 * i, 0, 0}, Vec3{2.0 * i, 500, 0}, Vec3{2.0 * i + 1, 500, 0}, Vec3{2.0 * i + 1, 1, 0}});
    comb.insert(comb.end(), {Vec3{2.0 * teeth, 1, 0}, Vec3{2.0 * teeth, 0, 0}});
    std::reverse(comb.begin(), comb.end());
    const double area = shoelace(comb);
    REQUIRE(area > 0);
    const Affine map = Affine::turn(0.7);
    for (auto& p : comb) p = map.point(p);
    const auto begin = std::chrono::steady_clock::now();
    const auto one = cut(comb);
    CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < 2);
    CHECK(one.triangles.size() == comb.size() - 2);
    CHECK(one.area == Approx(area).epsilon(1e-9));
    CHECK(one.notes.empty());
  }
  SECTION("a square with a square hole, joined by a pair of edges") {
    const std::vector<Vec3> frame{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                                  {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    for (std::size_t first = 0; first < frame.size(); ++first) {
      const auto one = cut(starting_at(frame, first));
      INFO(first);
      CHECK(one.triangles.size() == 8);
      CHECK(one.area == Approx(12.0).epsilon(1e-12));
      CHECK(one.notes.empty());
    }
  }
  SECTION("corners on straight sides") {
    const std::vector<Vec3> l{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1.5, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    for (std::size_t first = 0; first < l.size(); ++first) {
      const auto one = cut(starting_at(l, first));
      CHECK(one.triangles.size() == 7);
      CHECK(one.area == Approx(3.0).epsilon(1e-12));
      CHECK(one.notes.empty());
    }
  }
  SECTION("a corner twice in a row, and one that runs out and back") {
    const auto one = cut({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}, {0, 3, 0}, {0, 2, 0}});
    CHECK(one.triangles.size() == 6);
    CHECK(one.area == Approx(2.5).epsilon(1e-12));
  }
}

TEST_CASE("Polygons that cross themselves or are far from flat are cut as far as it goes, with a note", "[format][polygons]") {
  const auto star = cut({{0, 3, 0}, {2, -3, 0}, {-3, 1, 0}, {3, 1, 0}, {-2, -3, 0}});
  CHECK(star.triangles.size() == 3);
  REQUIRE(star.notes.size() == 1);
  CHECK(star.notes[0].find("plant.obj: 1 polygon crosses itself: ") == 0);
  const auto bow = cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});  // its lobes cancel
  CHECK(bow.triangles.size() == 2);
  CHECK(bow.notes.size() == 1);
  const auto saddle = cut({{0, 0, 0}, {1, 0, 0.5}, {1, 1, 0}, {0, 1, 0.5}});
  CHECK(saddle.triangles == fan(4));
  REQUIRE(saddle.notes.size() == 1);
  CHECK(saddle.notes[0].find("1 polygon is far from flat") != std::string::npos);
  CHECK(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).triangles == fan(4));  // nothing to enclose
  CHECK(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).notes.empty());
}

TEST_CASE("Concave polygons have the area of their outline in every format that has polygons", "[format][polygons]") {
  const auto area = [](const char* name, const std::string& text) {
    const TextFile file(name, text);
    const Plant plant = read_plant(file.path);
    CHECK(plant.facet_count() == 3);
    CHECK(plant.notes.empty());
    return plant.area();
  };
  CHECK(area("a.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\ng leaf\nf 5 1 2 3 4\n") == Approx(2.5));
  CHECK(area("late.obj", "f 5 1 2 3 4\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\n") == Approx(2.5));
  CHECK(area("a.can", "p 1 100001001000 5  0 2 0  0 0 0  2 0 0  2 2 0  1 0.5 0\n") == Approx(2.5));
  const std::string vertices = "0 0 0\n2 0 0\n2 2 0\n1 0.5 0\n0 2 0\n", face = "5 4 0 1 2 3\n",
                    vertex_element = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n",
                    face_element = "element face 1\nproperty list uchar int vertex_indices\n";
  CHECK(area("a.ply", "ply\nformat ascii 1.0\n" + vertex_element + face_element + "end_header\n" + vertices + face) == Approx(2.5));
  CHECK(area("late.ply", "ply\nformat ascii 1.0\n" + face_element + vertex_element + "end_header\n" + face + vertices) == Approx(2.5));
  CHECK(
      area(
          "a.opf",
          "<opf><meshBDD><mesh Id=\"0\"><points>0 0 0 2 0 0 2 2 0 1 0.5 0 0 2 0</points><faces><face>4 0 1 2 3</face></faces></mesh>"
          "</meshBDD><shapeBDD><shape Id=\"0\"><meshIndex>0</meshIndex></shape></shapeBDD><topology class=\"Plant\"><geometry><shapeIndex>0"
          "</shapeIndex><mat>1 0 0 0 0 1 0 0 0 0 1 0</mat></geometry></topology></opf>") == Approx(2.5));
}

TEST_CASE("A polygon too intricate to be cut in reasonable time is refused with its line", "[format][polygons]") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 1);
  std::vector<Vec3> polygon;
  for (int i = 0; i < 60000; ++i) polygon.push_back({place(random), place(random), 0});
  CHECK_THROWS_WITH(cut(polygon),
                    "plant.obj:7: found a polygon of 60000 corners that is too intricate to be cut into triangles; expected polygons "
                    "of fewer corners, or triangles");
}
