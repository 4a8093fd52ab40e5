#include <sunfleck/format/read_plant.hpp>

#include <algorithm>
#include <bit>
#include <cstring>

#include <catch2/catch.hpp>

#include <format_files.hpp>

using namespace sunfleck;

namespace {

/// Bytes of numbers, in the order of this machine or reversed.
struct Bytes {
  bool reversed = false;
  std::string text;
  template <class T>
  Bytes& operator<<(T value) {
    std::string raw(sizeof(T), '\0');
    std::memcpy(raw.data(), &value, sizeof(T));
    if (reversed) std::reverse(raw.begin(), raw.end());
    text += raw;
    return *this;
  }
};

}  // namespace

TEST_CASE("PLY: ascii with properties in any order, foreign elements and polygons", "[format][ply]") {
  const TextFile file(
      "square.ply",
      "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty float z\nproperty uchar red\nproperty double x\n"
      "property float y\nelement edge 1\nproperty int a\nproperty list uchar float weights\nelement face 2\n"
      "property float quality\nproperty list uchar int vertex_index\nend_header\n"
      "0 255 0.1 0\n0 255 1 0\n0 255 1 1\n0 255 0 1\n1 255 0 0\n7 2 0.5 0.25\n0.5 4 0 1 2 3\n\n0.5 3 2 3 4\n");
  const Plant plant = read_plant(file.path);
  REQUIRE(plant.meshes.size() == 1);
  CHECK(plant.meshes[0].vertices[0] == Vec3{0.1, 0, 0});
  CHECK(plant.meshes[0].vertices[4] == Vec3{0, 0, 1});
  using T = std::array<std::uint32_t, 3>;
  CHECK(plant.meshes[0].triangles == std::vector<T>{{0, 1, 2}, {0, 2, 3}, {2, 3, 4}});
  CHECK(plant.structures.size() == 2);  // all share vertices: one organ
  CHECK(plant.structures[1].name == "1");
}

TEST_CASE("PLY: both binary orders give the same plant; a face property groups organs", "[format][ply]") {
  for (const bool reversed : {false, true}) {
    const bool big = reversed == (std::endian::native == std::endian::little);
    Bytes body{reversed, {}};
    for (const double v : {0.0, 0.0, 0.1, 1.0, 0.0, 0.1, 0.0, 1.0, 0.1}) body << v;
    body << std::uint8_t{3} << std::uint16_t{0} << std::uint16_t{1} << std::uint16_t{2} << std::int32_t{-7};
    body << std::uint8_t{3} << std::uint16_t{2} << std::uint16_t{1} << std::uint16_t{0} << std::int32_t{40};
    body << std::uint8_t{3} << std::uint16_t{1} << std::uint16_t{2} << std::uint16_t{0} << std::int32_t{-7};
    const TextFile file("binary.ply", std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
                                          " 1.0\nelement vertex 3\nproperty float64 x\nproperty float64 y\nproperty float64 z\n"
                                          "element face 3\nproperty list uint8 uint16 vertex_indices\nproperty int32 organ\nend_header\n" +
                                          body.text);
    const Plant plant = read_plant(file.path);
    CHECK(plant.meshes[0].vertices[2] == Vec3{0, 1, 0.1});
    REQUIRE(plant.structures.size() == 3);
    CHECK(plant.structures[1].name == "-7");
    CHECK(plant.structures[2].name == "40");
    REQUIRE(plant.shapes.size() == 3);
    CHECK(plant.shapes[0].structure == 1);
    CHECK(plant.shapes[1].structure == 2);
    CHECK(plant.shapes[2].structure == 1);
  }
}
