#include <catch2/catch.hpp>

#include <fstream>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/h5.hpp>
#include <sunfleck/result/compare.hpp>
#include <sunfleck/result/result_reader.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

std::string good_file(const Folder& folder, std::uint32_t leaves = 3) {
  const Scene scene = small_scene(leaves);
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  ResultWriter writer(folder / "r.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
  Values(facets).send(writer, 1000);
  writer.finish(small_report());
  return folder / "r.h5";
}

h5::Id open_file(const std::string& file) {
  return h5::Id{H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)};
}

/// Puts another dataset in the place of one; chunked datasets take no room.
template <class T>
void replace(const std::string& file, const char* name, std::vector<hsize_t> dims, const std::vector<T>& values, hsize_t chunk = 0) {
  const h5::Id f = open_file(file), space{H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr)},
               properties{H5Pcreate(H5P_DATASET_CREATE)};
  if (chunk > 0) {
    std::vector<hsize_t> chunks(dims.size(), 1);
    chunks[0] = chunk;
    H5Pset_chunk(properties.get(), static_cast<int>(chunks.size()), chunks.data());
  }
  H5Ldelete(f.get(), name, H5P_DEFAULT);
  const h5::Id d{H5Dcreate2(f.get(), name, h5::memory_type<T>(), space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT)};
  REQUIRE(d);
  if (chunk == 0) REQUIRE(H5Dwrite(d.get(), h5::memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
}

/// Everything that a verb could ask of a file.
void read_everything(const std::string& file) {
  const Result r(file);
  (void)r.organs(), r.materials(), r.geometry(), r.balance(), r.profile(), r.convergence(), r.timings(), r.counts(), r.memory(),
      r.certificate();
  for (const char* name :
       {"facets/irradiance", "facets/absorbed", "facets/sunlit", "organs/irradiance", "organs/absorbed", "organs/sunlit"})
    (void)r.all<float>(name);
  (void)r.all<double>("facets/centroid");
  (void)r.facet_organs(0, r.facet_count());
  (void)compare(r, r);
}

}  // namespace

TEST_CASE("Files that are no result are refused by name", "[result][hostile]") {
  const Folder folder;
  const std::string text = folder / "text.h5", none = folder / "none.h5", empty = folder / "empty.h5", other = folder / "other.h5";
  std::ofstream(text) << "irradiance,absorbed\n1,2\n";
  std::ofstream(empty).close();
  h5::Id{H5Fcreate(other.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)}.close();
  CHECK_THROWS_WITH(Result(text), text + ": found something else than HDF5; expected a result file");
  CHECK_THROWS_WITH(Result(empty), empty + ": found something else than HDF5; expected a result file");
  CHECK_THROWS_WITH(Result(none), none + ": found no such file; expected a result file");
  CHECK_THROWS_WITH(Result(folder / ""), folder / "" + ": found a directory; expected a result file");
  CHECK_THROWS_WITH(Result(other), other + ": found an HDF5 file without format = \"sunfleck-result\"; expected a result file");
  CHECK_THROWS_AS(Result(text), InputError);
}

TEST_CASE("Files cut short or with flipped bytes end in an InputError or read as they are", "[result][hostile]") {
  const Folder folder;
  const std::string file = good_file(folder, 1200);
  std::ifstream in(file, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  const std::string broken = folder / "broken.h5";
  const auto put = [&](const std::string& bytes) { std::ofstream(broken, std::ios::binary | std::ios::trunc) << bytes; };

  for (const double part : {0.001, 0.1, 0.5, 0.9, 0.999}) {
    put(whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    INFO(part);
    CHECK_THROWS_WITH(Result(broken), broken + ": found a damaged HDF5 file, perhaps cut short; expected a result file");
  }
  // Metadata carry checksums; values do not, so a flipped bit may give another value, but never a crash.
  std::size_t refused = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    std::string bytes = whole;
    for (std::size_t k = 0; k < 40; ++k) bytes[(i * 7919 + k * 104729 * (i + 1)) % bytes.size()] ^= static_cast<char>(1 << (k % 8));
    put(bytes);
    try {
      read_everything(broken);
    } catch (const InputError& error) {
      ++refused;
      CHECK(std::string(error.what()).find(broken) == 0);
    }
  }
  CHECK(refused > 30);
}

TEST_CASE("Datasets that lie are named with what was found", "[result][hostile]") {
  const Folder folder;
  const std::string file = good_file(folder);
  const std::size_t n = 40, m = 22;
  const auto at = [&](const std::string& dataset) { return file + ": /" + dataset + ": found "; };

  SECTION("missing") {
    H5Ldelete(open_file(file).get(), "organs/type", H5P_DEFAULT);
    CHECK_THROWS_WITH(Result(file), at("organs/type") + "no such dataset; expected one, or another choice of [output] when solving");
  }
  SECTION("another shape") {
    replace<float>(file, "facets/absorbed", {2, n, 3}, std::vector<float>(2 * n * 3, 1.0f));
    CHECK_THROWS_WITH(Result(file), at("facets/absorbed") + "2 x 40 x 3; expected 2 x 40 x 2");
  }
  SECTION("a size far beyond what is stored") {
    replace<float>(file, "facets/area", {1ull << 40}, {}, 1024);
    CHECK_THROWS_WITH(Result(file), at("facets/area") + "1099511627776 values in 0 bytes; expected a size that fits what is stored");
  }
  SECTION("sunlit fractions that are not stored must agree with the other rows") {
    replace<float>(file, "facets/sunlit", {2, 1ull << 40, 2}, {}, 1);
    CHECK_THROWS_WITH(Result(file), at("facets/sunlit") + "2 x 1099511627776 x 2; expected 2 x 40 x 2");
  }
  SECTION("huge chunks") {
    replace<float>(file, "facets/sunlit", {1ull << 29, 2, 2}, {}, 1ull << 28);
    CHECK_THROWS_WITH(Result(file), at("facets/sunlit") + "chunks of more than 64 MiB; expected smaller ones");
  }
  SECTION("rows that do not exist") {
    replace<std::uint32_t>(file, "facets/organ", {n}, std::vector<std::uint32_t>(n, 1000));
    CHECK_THROWS_WITH(Result(file).facet_organs(0, n), at("facets/organ") + "row 1000; expected a row below 22");
    replace<std::uint32_t>(file, "organs/plant", {m}, std::vector<std::uint32_t>(m, 9));
    CHECK_THROWS_WITH(Result(file).organs(), at("organs/plant") + "row 9; expected a row below 3");
  }
  SECTION("values that are not finite") {
    replace<float>(file, "organs/absorbed", {2, m, 2}, std::vector<float>(2 * m * 2, std::numeric_limits<float>::infinity()));
    CHECK_THROWS_WITH(compare(Result(file), Result(file)), at("organs/absorbed") + "a value that is not finite; expected finite numbers");
  }
  SECTION("whole numbers that are not") {
    replace<double>(file, "facets/organ", {n}, std::vector<double>(n, 0.5));
    CHECK_THROWS_WITH(Result(file).facet_organs(0, 1), at("facets/organ") + "floating-point numbers; expected whole numbers");
  }
  SECTION("meshes that point outside") {
    const auto triangles = Result(file).shape("geometry/triangles");
    replace<std::uint32_t>(file, "geometry/triangles", {triangles[0], 3}, std::vector<std::uint32_t>(triangles[0] * 3, 77));
    CHECK_THROWS_WITH(Result(file).geometry(), Catch::Contains(file + ": /geometry/triangles: found vertex index 77 in face 1"));
  }
  SECTION("shapes of another mesh") {
    const auto shapes = Result(file).shape("geometry/shape_mesh");
    replace<std::uint32_t>(file, "geometry/shape_mesh", {shapes[0]}, std::vector<std::uint32_t>(shapes[0], 12));
    CHECK_THROWS_WITH(Result(file).geometry(), at("geometry/shape_mesh") + "row 12; expected a row below 3");
  }
  SECTION("links to other files") {
    const auto f = open_file(file);
    H5Ldelete(f.get(), "facets/area", H5P_DEFAULT);
    H5Lcreate_external("other.h5", "/area", f.get(), "facets/area", H5P_DEFAULT, H5P_DEFAULT);
    CHECK_THROWS_WITH(Result(file), Catch::Contains("/facets/area: found a link to another file; expected everything in this file"));
  }
  SECTION("a later format") {
    const auto f = open_file(file);
    const std::uint64_t version = 2;
    const h5::Id attribute{H5Aopen(f.get(), "format_version", H5P_DEFAULT)};
    H5Awrite(attribute.get(), H5T_NATIVE_UINT64, &version);
    H5Fflush(f.get(), H5F_SCOPE_GLOBAL);
    CHECK_THROWS_WITH(Result(file), file + ": format_version: found 2; expected 1: this program is older than the file");
  }
}
