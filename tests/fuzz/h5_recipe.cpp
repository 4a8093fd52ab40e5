#include "fuzz/h5_recipe.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include <sunfleck/core/h5.hpp>
#include <sunfleck/format/read_plant.hpp>

#include "result_scene.hpp"

namespace sunfleck::fuzz {

namespace {

using Bytes = std::span<const std::uint8_t>;
using File = std::vector<std::uint8_t>;
constexpr std::size_t most_rows = 4096;  ///< larger datasets are claims without values

File read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Takes numbers from the front of the bytes; zeros when they are used up.
class Recipe {
 public:
  explicit Recipe(Bytes bytes) : rest_(bytes) {}
  bool empty() const { return rest_.empty(); }
  std::uint64_t take(std::size_t bytes) {
    std::uint64_t value = 0;
    const std::size_t n = std::min(bytes, rest_.size());
    std::memcpy(&value, rest_.data(), n);
    rest_ = rest_.subspan(n);
    return value;
  }
  Bytes values(std::size_t bytes) {
    const auto part = rest_.first(std::min(bytes, rest_.size()));
    rest_ = rest_.subspan(part.size());
    return part;
  }

 private:
  Bytes rest_;
};

std::vector<std::string> dataset_names(hid_t file) {
  std::vector<std::string> names;
  H5Ovisit2(
      file, H5_INDEX_NAME, H5_ITER_INC,
      [](hid_t, const char* name, const H5O_info_t* info, void* out) -> herr_t {
        if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(out)->emplace_back(name);
        return 0;
      },
      &names, H5O_INFO_BASIC);
  return names;
}

hid_t type_of(std::uint64_t choice) {
  switch (choice % 8) {
    case 0:
      return H5T_NATIVE_FLOAT;
    case 1:
      return H5T_NATIVE_DOUBLE;
    case 2:
      return H5T_NATIVE_UINT8;
    case 3:
      return H5T_NATIVE_UINT32;
    case 4:
      return H5T_NATIVE_UINT64;
    case 5:
      return H5T_NATIVE_INT64;
    case 6:
      return H5T_C_S1;
    default:
      return H5T_NATIVE_INT16;
  }
}

void replace(hid_t file, const std::string& name, Recipe& recipe) {
  const hid_t type = type_of(recipe.take(1));
  const auto rank = static_cast<int>(recipe.take(1) % 5);
  std::vector<hsize_t> dims;
  std::size_t rows = 1;
  for (int i = 0; i < rank; ++i) {
    const auto bits = recipe.take(1);
    dims.push_back(bits < 128 ? bits : bits < 200 ? recipe.take(2) : recipe.take(6));
    rows = rows > most_rows ? rows : rows * dims.back();
  }
  const bool chunked = recipe.take(1) % 2 == 1 && rank > 0;
  const h5::Id space(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, dims.data(), nullptr)),
      creation(H5Pcreate(H5P_DATASET_CREATE));
  if (chunked) {
    std::vector<hsize_t> chunk(dims.size(), 1);
    chunk[0] = std::clamp<hsize_t>(recipe.take(2), 1, std::max<hsize_t>(dims[0], 1));
    H5Pset_chunk(creation.get(), rank, chunk.data());
    if (recipe.take(1) % 2) H5Pset_deflate(creation.get(), 1);
  }
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const h5::Id dataset(H5Dcreate2(file, name.c_str(), type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT));
  const std::size_t bytes = rows * H5Tget_size(type);
  if (!dataset || rows > most_rows || bytes == 0) return;  // a claim, without values
  File values(bytes);
  const auto given = recipe.values(bytes);
  std::copy(given.begin(), given.end(), values.begin());
  H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

/// Other values in the same place.
void overwrite(hid_t file, const std::string& name, Recipe& recipe) {
  const h5::Id dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT)), type(H5Dget_type(dataset.get())), space(H5Dget_space(dataset.get()));
  const auto points = H5Sget_simple_extent_npoints(space.get());
  if (!dataset || points <= 0 || static_cast<std::size_t>(points) > most_rows) return;
  File values(static_cast<std::size_t>(points) * H5Tget_size(type.get()));
  if (H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return;
  const std::size_t at = recipe.take(2) % values.size();
  const auto given = recipe.values(std::min<std::size_t>(values.size() - at, 1 + recipe.take(1) % 64));
  std::copy(given.begin(), given.end(), values.begin() + static_cast<std::ptrdiff_t>(at));
  H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

/// Where the good file is changed: in memory where there is such a folder.
std::string scratch() {
  static const test::Folder slow;
  const std::filesystem::path memory = "/dev/shm";
  return std::filesystem::is_directory(memory) ? (memory / ("sunfleck_fuzz_" + std::to_string(::getpid()) + ".h5")).string()
                                               : slow / "changed.h5";
}

File changed(const File& image, Bytes bytes) {
  constexpr std::uint8_t signature[] = {0x89, 'H', 'D', 'F'};
  if (bytes.size() >= 4 && std::equal(signature, signature + 4, bytes.begin())) return {bytes.begin(), bytes.end()};
  static const std::string path = scratch();
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
  const h5::Quiet quiet;
  h5::Id file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
  Recipe recipe(bytes);
  for (int change = 0; change < 8 && !recipe.empty(); ++change) {
    const auto names = dataset_names(file.get());
    if (names.empty()) break;
    const auto& name = names[recipe.take(1) % names.size()];
    switch (recipe.take(1) % 6) {
      case 0:
        H5Ldelete(file.get(), name.c_str(), H5P_DEFAULT);
        break;
      case 1: {  // a group, or a link that leads nowhere, in its place
        H5Ldelete(file.get(), name.c_str(), H5P_DEFAULT);
        if (recipe.take(1) % 2)
          h5::Id(H5Gcreate2(file.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
        else
          H5Lcreate_soft(("/" + name).c_str(), file.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
        break;
      }
      case 2:
      case 3:
        replace(file.get(), name, recipe);
        break;
      default:
        overwrite(file.get(), name, recipe);
    }
  }
  file.close();
  return read_bytes(path);
}

}  // namespace

std::vector<std::uint8_t> changed_plant_file(Bytes bytes) {
  static const File good = [] {
    const test::Folder folder;
    Plant plant = *test::small_plant(3);
    const auto key = plant.attribute_index("length");
    plant.structures[1].attributes = {
        {key, 1.5}, {plant.attribute_index("rank"), std::int64_t{2}}, {plant.attribute_index("note"), std::string("first")}};
    write_plant_h5(plant, folder / "plant.h5");
    return read_bytes(folder / "plant.h5");
  }();
  return changed(good, bytes);
}

std::vector<std::uint8_t> changed_result_file(Bytes bytes) {
  static const File good = [] {
    const test::Folder folder;
    const Scene scene = test::small_scene(3);
    const PlacedScene placed = place(scene);
    ResultWriter writer(folder / "r.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
    test::Values(expand(scene)).send(writer, 1000);
    const Certificate certificate = [] {
      Certificate c;
      c.organs = {1, 3};
      c.solved = c.reference = c.standard_error = std::vector<float>(8, 1.5f);
      c.rmse = c.rmse_low = c.rmse_high = c.bias = {0.001, 0.002};
      return c;
    }();
    writer.finish(test::small_report(), &certificate);
    return read_bytes(folder / "r.h5");
  }();
  return changed(good, bytes);
}

}  // namespace sunfleck::fuzz
