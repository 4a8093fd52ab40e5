// Whether an HDF5 file just written can be read. Only for modules that link HDF5.
#pragma once

#include <sunfleck/core/h5.hpp>

#include <string>

namespace sunfleck::h5 {

namespace whole_detail {

/// Counts what cannot be opened, or is a dataset without the storage that its size asks for.
inline herr_t look_at(hid_t root, const char* name, const H5O_info_t* info, void* broken) {
  const Id object{H5Oopen(root, name, H5P_DEFAULT)};
  bool good = static_cast<bool>(object);
  if (good && info->type == H5O_TYPE_DATASET) {
    const Id space{H5Dget_space(object.get())}, type{H5Dget_type(object.get())}, properties{H5Dget_create_plist(object.get())};
    const auto values = space ? H5Sget_simple_extent_npoints(space.get()) : -1;
    good = values >= 0 && type && H5Tget_size(type.get()) > 0 && properties;
    const H5D_layout_t layout = good ? H5Pget_layout(properties.get()) : H5D_LAYOUT_ERROR;
    if (hsize_t chunks = 0; layout == H5D_CHUNKED) good = H5Dget_num_chunks(object.get(), space.get(), &chunks) >= 0;
    if (layout == H5D_CONTIGUOUS) {  // what was never written takes no room
      const hsize_t stored = H5Dget_storage_size(object.get());
      good = stored == 0 || stored == static_cast<hsize_t>(values) * H5Tget_size(type.get());
    }
  }
  if (!good) ++*static_cast<int*>(broken);
  return 0;
}

}  // namespace whole_detail

/// Opens the file anew, walks over all that hangs on its root, and reads the sizes of all datasets. HDF5 may lose a part of a file where
/// memory runs out and say nothing (1.10.8).
inline bool is_whole(const std::string& path) {
  const Quiet quiet;
  const Id access{H5Pcreate(H5P_FILE_ACCESS)};
#if H5_VERSION_GE(1, 12, 1) || (H5_VERSION_GE(1, 10, 7) && !H5_VERSION_GE(1, 12, 0))
  if (!access || H5Pset_file_locking(access.get(), false, true) < 0) return false;  // not every file system has locks; nobody else writes
#endif
  const Id file{H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get())};
  if (!file) return false;
  int broken = 0;
  return H5Ovisit2(file.get(), H5_INDEX_NAME, H5_ITER_NATIVE, whole_detail::look_at, &broken, H5O_INFO_BASIC) >= 0 && broken == 0;
}

}  // namespace sunfleck::h5
