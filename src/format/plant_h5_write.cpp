#include <sunfleck/format/read_plant.hpp>

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include <format/plant_h5.hpp>
#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/h5.hpp>
#include <sunfleck/core/h5_whole.hpp>
#include <sunfleck/core/replaced_file.hpp>

namespace sunfleck {

namespace {

using namespace plant_h5;

/// Packs a plant as an HDF5 file in memory: HDF5 may hang or crash at exit if a disk fills up under it.
class PlantPacker {
 public:
  std::string pack(const Plant& plant) {
    const h5::Id access(H5Pcreate(H5P_FILE_ACCESS));
    // The oldest layout: its superblock has no checksum, which an image of newer ones has stale (HDF5 1.10.8, H5Fget_file_image).
    check(H5Pset_fapl_core(access.get(), std::size_t{1} << 20, false));
    file_ = h5::Id(H5Fcreate("plant", H5F_ACC_TRUNC, H5P_DEFAULT, access.get()));
    check(file_ ? 0 : -1);
    write_attributes(plant);
    write_structures(plant);
    write_meshes(plant);
    write_shapes(plant);
    check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL));
    const auto size = H5Fget_file_image(file_.get(), nullptr, 0);
    check(size > 0 ? 0 : -1);
    std::string image(static_cast<std::size_t>(size), '\0');
    check(H5Fget_file_image(file_.get(), image.data(), image.size()) == size ? 0 : -1);
    return image;
  }

 private:
  static void check(herr_t status) {
    if (status < 0) throw OutOfMemory("HDF5, which could not pack a plant");
  }

  void write_raw(const std::string& path, hid_t type, const void* data, const std::vector<hsize_t>& size, hsize_t bytes_per_row) {
    const h5::Id links(H5Pcreate(H5P_LINK_CREATE));
    check(H5Pset_create_intermediate_group(links.get(), 1));
    const h5::Id creation(H5Pcreate(H5P_DATASET_CREATE));
    check(H5Pset_obj_track_times(creation.get(), false));                   // the same plant gives the same bytes
    if (constexpr hsize_t small = 4096; size[0] * bytes_per_row > small) {  // below, chunks cost more than they save
      std::vector<hsize_t> chunk = size;
      chunk[0] = std::clamp<hsize_t>((hsize_t{1} << 20) / std::max<hsize_t>(bytes_per_row, 1), 1, size[0]);
      check(H5Pset_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data()));
      check(H5Pset_shuffle(creation.get()));
      check(H5Pset_deflate(creation.get(), 4));
    }
    const h5::Id space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr));
    const h5::Id dataset(H5Dcreate2(file_.get(), path.c_str(), type, space.get(), links.get(), creation.get(), H5P_DEFAULT));
    check(dataset ? 0 : -1);
    if (size[0] > 0) check(H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
  }

  template <class T>
  void write_values(const std::string& path, const std::vector<T>& values) {
    write_raw(path, h5::memory_type<T>(), values.data(), {values.size()}, sizeof(T));
  }

  void write_matrices(const std::string& path, const std::vector<FrameRows>& values) {
    write_raw(path, H5T_NATIVE_DOUBLE, values.data(), {values.size(), 3, 4}, sizeof(FrameRows));
  }

  static h5::Id text_type(std::size_t width) {
    h5::Id type(H5Tcopy(H5T_C_S1));
    check(H5Tset_size(type.get(), width));
    check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD));
    check(H5Tset_cset(type.get(), H5T_CSET_UTF8));
    return type;
  }

  void write_strings(const std::string& path, const std::vector<std::string>& rows) {
    std::size_t width = 1;
    for (const auto& row : rows) width = std::max(width, row.size());
    std::string bytes(width * rows.size(), '\0');
    for (std::size_t i = 0; i < rows.size(); ++i)
      std::copy(rows[i].begin(), rows[i].end(), bytes.begin() + static_cast<std::ptrdiff_t>(i * width));
    const h5::Id type = text_type(width);
    write_raw(path, type.get(), bytes.data(), {rows.size()}, width);
  }

  void write_text_attribute(const char* name, const std::string& value) {
    const h5::Id type = text_type(std::max<std::size_t>(value.size(), 1));
    write_attribute(name, type.get(), value.c_str());
  }

  void write_attribute(const char* name, hid_t type, const void* value) {
    const h5::Id space(H5Screate(H5S_SCALAR));
    const h5::Id attribute(H5Acreate2(file_.get(), name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT));
    check(attribute ? H5Awrite(attribute.get(), type, value) : -1);
  }

  void write_attributes(const Plant& plant) {
    write_text_attribute("format", format_name);
    write_attribute("format_version", H5T_NATIVE_INT64, &format_version);
    write_text_attribute("name", plant.name);
    write_strings("/names/type", plant.types);
    write_strings("/names/attribute", plant.attribute_names);
    write_strings("/names/material", plant.materials);
  }

  void write_structures(const Plant& plant) {
    std::vector<std::string> names, texts;  // each distinct one once
    NameIndex name_row(names), text_row(texts);
    std::vector<std::uint32_t> parent, type, name, owner, key;
    std::vector<std::uint8_t> kind;
    std::vector<std::int64_t> wholes;
    std::vector<double> numbers;
    std::vector<FrameRows> frame;
    for (std::size_t i = 0; i < plant.structures.size(); ++i) {
      const Structure& s = plant.structures[i];
      parent.push_back(s.parent);
      type.push_back(s.type);
      name.push_back(name_row(s.name));
      frame.push_back(matrix_of(s.frame));
      for (const auto& [k, value] : s.attributes) {
        owner.push_back(static_cast<std::uint32_t>(i));
        key.push_back(k);
        kind.push_back(static_cast<std::uint8_t>(value.index()));
        const auto* real = std::get_if<double>(&value);
        numbers.push_back(real ? *real : 0.0);
        std::int64_t whole_value = 0;
        if (const auto* b = std::get_if<bool>(&value)) whole_value = *b;
        if (const auto* i64 = std::get_if<std::int64_t>(&value)) whole_value = *i64;
        if (const auto* string = std::get_if<std::string>(&value)) whole_value = text_row(*string);
        wholes.push_back(whole_value);
      }
    }
    write_strings("/names/structure", names);
    write_strings("/names/text", texts);
    write_values("/structures/parent", parent);
    write_values("/structures/type", type);
    write_values("/structures/name", name);
    write_matrices("/structures/frame", frame);
    write_values("/attributes/structure", owner);
    write_values("/attributes/key", key);
    write_values("/attributes/kind", kind);
    write_values("/attributes/whole", wholes);
    write_values("/attributes/number", numbers);
  }

  void write_meshes(const Plant& plant) {
    std::vector<std::uint64_t> vertex_count, triangle_count;
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const auto& mesh : plant.meshes) {
      vertex_count.push_back(mesh.vertices.size());
      triangle_count.push_back(mesh.triangles.size());
      vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
      triangles.insert(triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
    }
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    write_values("/meshes/vertex_count", vertex_count);
    write_values("/meshes/triangle_count", triangle_count);
    write_raw("/meshes/vertices", H5T_NATIVE_DOUBLE, vertices.data(), {vertices.size(), 3}, sizeof(Vec3));
    write_raw("/meshes/triangles", H5T_NATIVE_UINT32, triangles.data(), {triangles.size(), 3}, 12);
  }

  void write_shapes(const Plant& plant) {
    std::vector<std::uint32_t> structure, mesh, first, count, material;
    std::vector<FrameRows> placement;
    for (const auto& s : plant.shapes) {
      structure.push_back(s.structure);
      mesh.push_back(s.mesh);
      first.push_back(s.first_triangle);
      count.push_back(s.triangle_count);
      material.push_back(s.material);
      placement.push_back(matrix_of(s.placement));
    }
    write_values("/shapes/structure", structure);
    write_values("/shapes/mesh", mesh);
    write_values("/shapes/first_triangle", first);
    write_values("/shapes/triangle_count", count);
    write_values("/shapes/material", material);
    write_matrices("/shapes/placement", placement);
  }

  h5::Id file_;
};

}  // namespace

void write_plant_h5(const Plant& plant, const std::string& file) {
  check_plant(plant);
  const h5::Quiet quiet;
  const auto closes_failed_before = h5::failed_closes;
  const std::string image = PlantPacker().pack(plant);
  ReplacedFile out(file);
  out.write(image);
  out.flush();
  if (h5::failed_closes != closes_failed_before || !h5::is_whole(out.temporary()))
    throw OutOfMemory("HDF5, which has lost a part of " + file + ", as was noticed when it was read again");
  out.commit();
}

}  // namespace sunfleck
