#include "result/output_driver.hpp"

#include <cerrno>
#include <cstring>
#include <algorithm>
#include <new>

#include <unistd.h>

namespace sunfleck::h5 {

namespace {

struct DriverFile {
  H5FD_t base;  // first: HDF5 sees this
  DriverState* state;
  haddr_t end_of_allocation, end_of_file;
};

DriverFile& self(H5FD_t* file) {
  return *reinterpret_cast<DriverFile*>(file);
}
const DriverFile& self(const H5FD_t* file) {
  return *reinterpret_cast<const DriverFile*>(file);
}

H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
  const auto* info = static_cast<DriverState* const*>(H5Pget_driver_info(access));
  if (!info) return nullptr;
  auto* file = new (std::nothrow) DriverFile{};
  if (file) file->state = *info;
  return reinterpret_cast<H5FD_t*>(file);
}

herr_t close_file(H5FD_t* file) {
  delete &self(file);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA |
           H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t get_eoa(const H5FD_t* file, H5FD_mem_t) {
  return self(file).end_of_allocation;
}
herr_t set_eoa(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  self(file).end_of_allocation = address;
  return 0;
}
haddr_t get_eof(const H5FD_t* file, H5FD_mem_t) {
  return self(file).end_of_file;
}

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, size_t size, void* buffer) {
  auto* bytes = static_cast<char*>(buffer);
  while (size > 0) {
    const ssize_t got = ::pread(self(file).state->descriptor, bytes, size, static_cast<off_t>(address));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) {  // past the end: zeros, as a file with holes has them
      std::memset(bytes, 0, size);
      return 0;
    }
    bytes += got;
    address += static_cast<haddr_t>(got);
    size -= static_cast<size_t>(got);
  }
  return 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, size_t size, const void* buffer) {
  auto& f = self(file);
  const auto* bytes = static_cast<const char*>(buffer);
  while (size > 0 && f.state->error == 0) {
    const ssize_t put = ::pwrite(f.state->descriptor, bytes, size, static_cast<off_t>(address));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) {
      f.state->error = put < 0 ? errno : ENOSPC;
      break;
    }
    bytes += put;
    address += static_cast<haddr_t>(put);
    size -= static_cast<size_t>(put);
  }
  f.end_of_file = std::max(f.end_of_file, address + size);
  return 0;
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  auto& f = self(file);
  if (f.end_of_allocation == f.end_of_file) return 0;
  if (f.state->error == 0 && ::ftruncate(f.state->descriptor, static_cast<off_t>(f.end_of_allocation)) != 0) f.state->error = errno;
  f.end_of_file = f.end_of_allocation;
  return 0;
}

H5FD_class_t describe() {
  H5FD_class_t c;
  std::memset(&c, 0, sizeof c);
#ifdef H5FD_CLASS_VERSION  // HDF5 1.14 and later
  c.version = H5FD_CLASS_VERSION;
  c.value = static_cast<H5FD_class_value_t>(512);
#endif
  c.name = "sunfleck_output";
  c.maxaddr = (haddr_t{1} << 62) - 1;
  c.fc_degree = H5F_CLOSE_STRONG;
  c.fapl_size = sizeof(DriverState*);
  c.open = open_file;
  c.close = close_file;
  c.query = query;
  c.get_eoa = get_eoa;
  c.set_eoa = set_eoa;
  c.get_eof = get_eof;
  c.read = read;
  c.write = write;
  c.truncate = truncate;
  const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
  std::memcpy(c.fl_map, map, sizeof map);
  return c;
}

}  // namespace

Id output_access(DriverState& state) {
  static const H5FD_class_t driver = describe();
  static const hid_t registered = H5FDregister(&driver);
  Id access{H5Pcreate(H5P_FILE_ACCESS)};
  DriverState* info = &state;
  if (!access || registered < 0 || H5Pset_driver(access.get(), registered, &info) < 0) return Id{};
  return access;
}

}  // namespace sunfleck::h5
