#include <sunfleck/format/read_plant.hpp>

#include <functional>

#include <catch2/catch.hpp>

#include <format_files.hpp>
#include <sunfleck/core/h5.hpp>
#include <sunfleck/plant/build.hpp>

using namespace sunfleck;

namespace {

/// The message of a plant file after someone has changed it with HDF5.
std::string message(const std::function<void(hid_t)>& change) {
  const TextFile folder("anything", "");
  const std::string path = folder.folder() + "/bad.h5";
  write_plant_h5(make_plant(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), path);
  {
    const h5::Id file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    change(file.get());
  }
  return message_of(folder, [&] { read_plant(path); });
}

template <class T>
void put(hid_t file, const char* name, std::vector<T> values, hid_t type, std::vector<hsize_t> size) {
  H5Ldelete(file, name, H5P_DEFAULT);
  const h5::Id space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr));
  const h5::Id creation(H5Pcreate(H5P_DATASET_CREATE));
  std::vector<hsize_t> chunk(size);
  chunk[0] = std::min<hsize_t>(chunk[0], 1024);
  H5Pset_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data());
  const h5::Id dataset(H5Dcreate2(file, name, type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT));
  if (!values.empty()) H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

}  // namespace

TEST_CASE("Plant files that lie are refused before memory is taken", "[format][h5]") {
  CHECK(message([](hid_t) {}).empty());
  CHECK(message([](hid_t file) { H5Adelete(file, "format"); }) ==
        "bad.h5: format: found no such text attribute; expected a plant written by sunfleck");
  CHECK(message([](hid_t file) {
          const std::int64_t version = 9;
          const h5::Id attribute(H5Aopen(file, "format_version", H5P_DEFAULT));
          H5Awrite(attribute.get(), H5T_NATIVE_INT64, &version);
        }) == "bad.h5: format_version: found 9; expected 1");
  CHECK(message([](hid_t file) { H5Ldelete(file, "/meshes/vertices", H5P_DEFAULT); }) ==
        "bad.h5: /meshes/vertices: found no such dataset; expected a plant written by sunfleck");
  CHECK(message([](hid_t file) {
          put<double>(file, "/meshes/vertices", {}, H5T_NATIVE_DOUBLE, {hsize_t{1} << 40, 3});
        }) == "bad.h5: /meshes/vertices: found 1099511627776 rows in 0 stored bytes; expected rows that are there");
  CHECK(message([](hid_t file) {
          put<double>(file, "/meshes/vertices", {1, 2, 3, 4}, H5T_NATIVE_DOUBLE, {2, 2});
        }) == "bad.h5: /meshes/vertices: found a shape of [2, 2]; expected [n, 3]");
  CHECK(message([](hid_t file) {
          put<float>(file, "/meshes/vertices", {1, 2, 3}, H5T_NATIVE_FLOAT, {1, 3});
        }) == "bad.h5: /meshes/vertices: found values of another type; expected float64");
  CHECK(message([](hid_t file) { put<std::uint64_t>(file, "/meshes/vertex_count", {4}, H5T_NATIVE_UINT64, {1}); }) ==
        "bad.h5: /meshes/vertices: found 3 rows; expected 4");
  CHECK(message([](hid_t file) { put<std::uint64_t>(file, "/meshes/vertex_count", {1}, H5T_NATIVE_UINT64, {1}); }) ==
        "bad.h5: /meshes/vertices: found 3 rows; expected 1");
  CHECK(message([](hid_t file) {
          put<std::uint32_t>(file, "/meshes/triangles", {0, 1, 3}, H5T_NATIVE_UINT32, {1, 3});
        }) == "bad.h5: found vertex index 3 in face 1; expected an index below the number of vertices, 3");
  CHECK(message([](hid_t file) { put<std::uint32_t>(file, "/shapes/mesh", {1}, H5T_NATIVE_UINT32, {1}); }) ==
        "bad.h5: found shape 0 with mesh 1; expected a listed mesh");
  CHECK(message([](hid_t file) {
          put<std::uint32_t>(file, "/shapes/mesh", {0, 0}, H5T_NATIVE_UINT32, {2});
        }) == "bad.h5: /shapes/mesh: found 2 rows; expected 1");
  CHECK(message([](hid_t file) {
          put<std::uint32_t>(file, "/structures/name", {0, 7}, H5T_NATIVE_UINT32, {2});
        }) == "bad.h5: /structures/name: found row 7 of a table; expected less than 1");
}

TEST_CASE("What is no HDF5 or only a part of one is refused", "[format][h5]") {
  const TextFile text("bad.h5", "hello");
  CHECK(message_of(text, [&] { read_plant(text.path); }) == "bad.h5: found no HDF5 file; expected a plant written by sunfleck");
  write_plant_h5(make_plant(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), text.path);
  const auto size = std::filesystem::file_size(text.path);
  for (const std::uintmax_t part : {size / 2, size - 1}) {
    std::filesystem::resize_file(text.path, part);
    CHECK(message_of(text, [&] { read_plant(text.path); }) ==
          "bad.h5: found a damaged HDF5 file, perhaps cut short; expected a whole file written by sunfleck");
  }
}
