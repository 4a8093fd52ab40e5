// Nothing that the file says about itself is believed: sizes are held against the bytes stored before memory is taken.
#include <sunfleck/format/read_plant.hpp>

#include <unistd.h>

#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <format/plant_h5.hpp>
#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/h5.hpp>

namespace sunfleck {

namespace {

using namespace plant_h5;

/// The number that a row is made of.
template <class T>
struct Scalar {
  using type = T;
};
template <>
struct Scalar<Vec3> {
  using type = double;
};
template <class T, std::size_t n>
struct Scalar<std::array<T, n>> {
  using type = T;
};

class PlantReader {
 public:
  explicit PlantReader(const std::string& path) : path_(path) {}

  Plant read() {
    check_readable(path_);
    if (::access(path_.c_str(), R_OK) != 0) throw InputError(path_, "a file that cannot be opened", "permission to read it");
    if (H5Fis_hdf5(path_.c_str()) <= 0) throw InputError(path_, "no HDF5 file", "a plant written by sunfleck");
    file_ = h5::Id(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!file_) throw InputError(path_, "a damaged HDF5 file, perhaps cut short", "a whole file written by sunfleck");
    check_format();
    Plant plant;
    plant.file = path_;
    plant.name = text_attribute("name");
    plant.types = strings("/names/type");
    plant.attribute_names = strings("/names/attribute");
    plant.materials = strings("/names/material");
    read_structures(plant);
    read_attributes(plant);
    read_meshes(plant);
    read_shapes(plant);
    check_plant(plant);
    return plant;
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected) const {
    throw InputError(location(path_, 0, key), found, expected);
  }

  // ---- attributes of the file

  std::string text_attribute(const char* name) const {
    const h5::Id attribute(H5Aopen(file_.get(), name, H5P_DEFAULT));
    const h5::Id type(attribute ? H5Aget_type(attribute.get()) : H5I_INVALID_HID);
    if (!type || H5Tget_class(type.get()) != H5T_STRING) fail(name, "no such text attribute", "a plant written by sunfleck");
    if (H5Tis_variable_str(type.get()) > 0 || H5Tget_size(type.get()) > 65536)
      fail(name, "a text of no fixed length", "a plant written by sunfleck");
    const h5::Id space(H5Aget_space(attribute.get()));
    if (H5Sget_simple_extent_npoints(space.get()) != 1) fail(name, "a list", "one text");
    std::string value(H5Tget_size(type.get()), '\0');
    if (H5Aread(attribute.get(), type.get(), value.data()) < 0) fail(name, "an attribute that cannot be read", "a whole file");
    return value.substr(0, value.find('\0'));
  }

  void check_format() const {
    const std::string format = text_attribute("format");
    if (format != format_name) fail("format", in_quotes(format), in_quotes(format_name));
    const h5::Id attribute(H5Aopen(file_.get(), "format_version", H5P_DEFAULT));
    const h5::Id space(attribute ? H5Aget_space(attribute.get()) : H5I_INVALID_HID);
    std::int64_t version = 0;
    if (!space || H5Sget_simple_extent_npoints(space.get()) != 1 || H5Aread(attribute.get(), H5T_NATIVE_INT64, &version) < 0)
      fail("format_version", "no number", fmt::format("{}", format_version));
    if (version != format_version) fail("format_version", fmt::format("{}", version), fmt::format("{}", format_version));
  }

  // ---- datasets

  /// Opens a dataset whose extents after the first are `row_shape`, and gives its number of rows.
  h5::Id open(const std::string& name, const std::vector<hsize_t>& row_shape, hsize_t& rows) const {
    h5::Id dataset(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT));
    if (!dataset) fail(name, "no such dataset", "a plant written by sunfleck");
    const h5::Id space(H5Dget_space(dataset.get()));
    const int rank = H5Sget_simple_extent_ndims(space.get());
    std::vector<hsize_t> size(rank > 0 ? static_cast<std::size_t>(rank) : 0);
    if (rank > 0) H5Sget_simple_extent_dims(space.get(), size.data(), nullptr);
    if (size.empty() || std::vector<hsize_t>(size.begin() + 1, size.end()) != row_shape)
      fail(name, fmt::format("a shape of [{}]", fmt::join(size, ", ")),
           row_shape.empty() ? "[n]" : fmt::format("[n, {}]", fmt::join(row_shape, ", ")));
    rows = size[0];
    const h5::Id type(H5Dget_type(dataset.get()));
    hsize_t row_bytes = H5Tget_size(type.get());
    for (const auto n : row_shape) row_bytes *= n;
    constexpr hsize_t best_ratio = 1040;  // deflate packs 1032 bytes into one at best
    const hsize_t stored = H5Dget_storage_size(dataset.get());
    if (rows > 0 && (row_bytes == 0 || rows > stored * best_ratio / row_bytes))
      fail(name, fmt::format("{} rows in {} stored bytes", rows, stored), "rows that are there");
    return dataset;
  }

  template <class T>
  std::vector<T> values(const std::string& name, const std::vector<hsize_t>& row_shape = {}) const {
    using Number = typename Scalar<T>::type;
    hsize_t rows = 0;
    const h5::Id dataset = open(name, row_shape, rows);
    const h5::Id type(H5Dget_type(dataset.get()));
    const H5T_class_t expected = std::is_floating_point_v<Number> ? H5T_FLOAT : H5T_INTEGER;
    if (H5Tget_class(type.get()) != expected || H5Tget_size(type.get()) != sizeof(Number))
      fail(name, "values of another type",
           std::is_floating_point_v<Number> ? fmt::format("float{}", 8 * sizeof(Number))
                                            : fmt::format("{}int{}", std::is_signed_v<Number> ? "" : "u", 8 * sizeof(Number)));
    std::vector<T> result(rows);
    if (rows > 0 && H5Dread(dataset.get(), h5::memory_type<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, result.data()) < 0)
      fail(name, "data that cannot be unpacked", "a whole file");
    return result;
  }

  std::vector<std::string> strings(const std::string& name) const {
    hsize_t rows = 0;
    const h5::Id dataset = open(name, {}, rows);
    const h5::Id type(H5Dget_type(dataset.get()));
    if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0)
      fail(name, "values of another type", "text of fixed length");
    const std::size_t width = H5Tget_size(type.get());
    std::string bytes(width * rows, '\0');
    if (rows > 0 && H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
      fail(name, "data that cannot be unpacked", "a whole file");
    std::vector<std::string> result;
    for (hsize_t i = 0; i < rows; ++i) {
      const std::string_view row(bytes.data() + i * width, width);
      result.emplace_back(row.substr(0, row.find('\0')));
    }
    return result;
  }

  void same_rows(const std::string& name, std::size_t found, std::size_t expected) const {
    if (found != expected) fail(name, fmt::format("{} rows", found), fmt::format("{}", expected));
  }

  const std::string& row_of(const std::vector<std::string>& table, std::uint64_t row, const std::string& name) const {
    if (row >= table.size()) fail(name, fmt::format("row {} of a table", row), fmt::format("less than {}", table.size()));
    return table[row];
  }

  // ---- parts of the plant

  void read_structures(Plant& plant) const {
    const auto names = strings("/names/structure");
    const auto parent = values<std::uint32_t>("/structures/parent");
    const auto type = values<std::uint32_t>("/structures/type");
    const auto name = values<std::uint32_t>("/structures/name");
    const auto frame = values<FrameRows>("/structures/frame", {3, 4});
    same_rows("/structures/type", type.size(), parent.size());
    same_rows("/structures/name", name.size(), parent.size());
    same_rows("/structures/frame", frame.size(), parent.size());
    plant.structures.resize(parent.size());
    for (std::size_t i = 0; i < parent.size(); ++i) {
      Structure& s = plant.structures[i];
      s.parent = parent[i];
      s.type = type[i];
      s.name = row_of(names, name[i], "/structures/name");
      s.frame = affine_of(frame[i]);
    }
  }

  void read_attributes(Plant& plant) const {
    const auto texts = strings("/names/text");
    const auto owner = values<std::uint32_t>("/attributes/structure");
    const auto key = values<std::uint32_t>("/attributes/key");
    const auto kind = values<std::uint8_t>("/attributes/kind");
    const auto wholes = values<std::int64_t>("/attributes/whole");
    const auto numbers = values<double>("/attributes/number");
    same_rows("/attributes/key", key.size(), owner.size());
    same_rows("/attributes/kind", kind.size(), owner.size());
    same_rows("/attributes/whole", wholes.size(), owner.size());
    same_rows("/attributes/number", numbers.size(), owner.size());
    for (std::size_t i = 0; i < owner.size(); ++i) {
      if (owner[i] >= plant.structures.size())
        fail("/attributes/structure", fmt::format("structure {}", owner[i]), fmt::format("less than {}", plant.structures.size()));
      AttributeValue value;
      switch (kind[i]) {
        case truth:
          value = wholes[i] != 0;
          break;
        case whole:
          value = wholes[i];
          break;
        case number:
          value = numbers[i];
          break;
        case text:
          value = row_of(texts, static_cast<std::uint64_t>(wholes[i]), "/attributes/whole");
          break;
        default:
          fail("/attributes/kind", fmt::format("kind {}", kind[i]), "0 to 3");
      }
      plant.structures[owner[i]].attributes.emplace_back(key[i], std::move(value));
    }
  }

  void read_meshes(Plant& plant) const {
    const auto vertex_count = values<std::uint64_t>("/meshes/vertex_count");
    const auto triangle_count = values<std::uint64_t>("/meshes/triangle_count");
    const auto vertices = values<Vec3>("/meshes/vertices", {3});
    const auto triangles = values<std::array<std::uint32_t, 3>>("/meshes/triangles", {3});
    same_rows("/meshes/triangle_count", triangle_count.size(), vertex_count.size());
    std::size_t v = 0, t = 0;
    for (std::size_t m = 0; m < vertex_count.size(); ++m) {
      if (vertex_count[m] > vertices.size() - v) same_rows("/meshes/vertices", vertices.size(), v + vertex_count[m]);
      if (triangle_count[m] > triangles.size() - t) same_rows("/meshes/triangles", triangles.size(), t + triangle_count[m]);
      Mesh mesh;
      const auto first_vertex = vertices.begin() + static_cast<std::ptrdiff_t>(v);
      const auto first_triangle = triangles.begin() + static_cast<std::ptrdiff_t>(t);
      mesh.vertices.assign(first_vertex, first_vertex + static_cast<std::ptrdiff_t>(vertex_count[m]));
      mesh.triangles.assign(first_triangle, first_triangle + static_cast<std::ptrdiff_t>(triangle_count[m]));
      v += vertex_count[m];
      t += triangle_count[m];
      plant.meshes.push_back(std::move(mesh));
    }
    same_rows("/meshes/vertices", vertices.size(), v);
    same_rows("/meshes/triangles", triangles.size(), t);
  }

  void read_shapes(Plant& plant) const {
    const auto structure = values<std::uint32_t>("/shapes/structure");
    const auto mesh = values<std::uint32_t>("/shapes/mesh");
    const auto first = values<std::uint32_t>("/shapes/first_triangle");
    const auto count = values<std::uint32_t>("/shapes/triangle_count");
    const auto material = values<std::uint32_t>("/shapes/material");
    const auto placement = values<FrameRows>("/shapes/placement", {3, 4});
    same_rows("/shapes/mesh", mesh.size(), structure.size());
    same_rows("/shapes/first_triangle", first.size(), structure.size());
    same_rows("/shapes/triangle_count", count.size(), structure.size());
    same_rows("/shapes/material", material.size(), structure.size());
    same_rows("/shapes/placement", placement.size(), structure.size());
    for (std::size_t i = 0; i < structure.size(); ++i)
      plant.shapes.push_back({structure[i], mesh[i], first[i], count[i], material[i], affine_of(placement[i])});
  }

  const std::string& path_;
  h5::Id file_;
};

}  // namespace

Plant read_plant_h5(const std::string& file) {
  const h5::Quiet quiet;
  return PlantReader(file).read();
}

}  // namespace sunfleck
