#include "result/dataset_reader.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <type_traits>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>

namespace sunfleck::h5 {

namespace {

// Deflate makes at most 1032 bytes out of one: a dataset that claims more than it can hold is a lie.
constexpr double most_inflated = 1100.0;
constexpr double most_chunk_bytes = 64.0 * 1024 * 1024;

}  // namespace

std::string shape_text(const std::vector<std::size_t>& dims) {
  std::string text;
  for (const auto d : dims) text += (text.empty() ? "" : " x ") + std::to_string(d);
  return text.empty() ? "a single value" : text;
}

DatasetReader::DatasetReader(const std::string& path) : path_(path) {
  const Quiet quiet;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(path, "no such file", "a result file");
  if (std::filesystem::is_directory(path, error)) throw InputError(path, "a directory", "a result file");
  if (!std::filesystem::is_regular_file(path, error))
    throw InputError(path, "a pipe, device or socket", "a result file");  // HDF5 would wait at a pipe for ever
  InputRecord::note(path);
  file_ = Id{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)};
  if (file_) return;
  if (::access(path.c_str(), R_OK) != 0) throw InputError(path, "a file that cannot be opened", "permission to read it");
  const bool signature = H5Fis_hdf5(path.c_str()) > 0;
  throw InputError(path, signature ? "a damaged HDF5 file, perhaps cut short" : "something else than HDF5", "a result file");
}

void DatasetReader::fail(const std::string& name, const std::string& found, const std::string& expected) const {
  throw InputError(location(path_, 0, "/" + name), found, expected);
}

bool DatasetReader::has(const std::string& name) const {
  const Quiet quiet;
  if (open_.contains(name)) return true;
  for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    if (H5Lexists(file_.get(), part.c_str(), H5P_DEFAULT) <= 0) return false;
    H5L_info_t info;
    if (H5Lget_info(file_.get(), part.c_str(), &info, H5P_DEFAULT) < 0) return false;
    if (info.type != H5L_TYPE_HARD && info.type != H5L_TYPE_SOFT) fail(part, "a link to another file", "everything in this file");
    if (H5Oexists_by_name(file_.get(), part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

const DatasetReader::Dataset& DatasetReader::open(const std::string& name) const {
  if (const auto known = open_.find(name); known != open_.end()) return known->second;
  const Quiet quiet;
  if (!has(name)) fail(name, "no such dataset", "one, or another choice of [output] when solving");
  Dataset d;
  d.id = Id{H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT)};
  if (!d.id) fail(name, "something else than a dataset, or a damaged one", "a dataset");
  const Id space{H5Dget_space(d.id.get())}, type{H5Dget_type(d.id.get())}, properties{H5Dget_create_plist(d.id.get())};
  if (!space || !type || !properties) fail(name, "a damaged dataset", "one that can be read");
  if (H5Pget_layout(properties.get()) == H5D_VIRTUAL || H5Pget_external_count(properties.get()) > 0)
    fail(name, "values kept in another file", "everything in this file");
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0 || rank > 8) fail(name, "no array", "an array");
  std::vector<hsize_t> dims(static_cast<std::size_t>(rank));
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
  d.dims.assign(dims.begin(), dims.end());
  d.type = H5Tget_class(type.get());
  d.element_size = H5Tget_size(type.get());
  if (H5Tis_variable_str(type.get()) > 0) fail(name, "texts of variable length", "texts of fixed length");

  double claimed = static_cast<double>(d.element_size);
  for (const auto n : dims) claimed *= static_cast<double>(n);
  const auto stored = static_cast<double>(H5Dget_storage_size(d.id.get()));
  const bool may_be_unwritten = name.ends_with("sunlit");  // no sun: zeros that take no room; its rows are checked against the others
  if (claimed > most_inflated * stored + 4096.0 && !(may_be_unwritten && stored == 0.0))
    fail(name, shape_text(d.dims) + " values in " + std::to_string(static_cast<std::uint64_t>(stored)) + " bytes",
         "a size that fits what is stored");
  if (H5Pget_layout(properties.get()) == H5D_CHUNKED && rank > 0) {
    std::vector<hsize_t> chunk(dims.size());
    double bytes = static_cast<double>(d.element_size);
    if (H5Pget_chunk(properties.get(), rank, chunk.data()) == rank)
      for (const auto n : chunk) bytes *= static_cast<double>(n);
    if (bytes > most_chunk_bytes) fail(name, "chunks of more than 64 MiB", "smaller ones");
  }
  return open_.emplace(name, std::move(d)).first->second;
}

std::vector<std::size_t> DatasetReader::shape(const std::string& name) const {
  if (!has(name)) return {};
  return open(name).dims;
}

void DatasetReader::expect(const std::string& name, const std::vector<std::size_t>& wanted) const {
  const auto& dims = open(name).dims;
  if (dims != wanted) fail(name, shape_text(dims), shape_text(wanted));
}

template <class T>
std::vector<T> DatasetReader::block(const std::string& name, const std::vector<std::size_t>& outer, std::size_t first,
                                    std::size_t count) const {
  const Quiet quiet;
  const auto& d = open(name);
  if (d.type != H5T_FLOAT && d.type != H5T_INTEGER) fail(name, "text or another type", "numbers");
  if (std::is_integral_v<T> && d.type != H5T_INTEGER) fail(name, "floating-point numbers", "whole numbers");
  if (d.dims.size() <= outer.size()) fail(name, shape_text(d.dims), "more dimensions");
  std::vector<hsize_t> start(d.dims.size(), 0), size(d.dims.begin(), d.dims.end());
  for (std::size_t i = 0; i < outer.size(); ++i) {
    if (outer[i] >= d.dims[i]) fail(name, shape_text(d.dims), "a row " + std::to_string(outer[i]));
    start[i] = outer[i];
    size[i] = 1;
  }
  const std::size_t axis = outer.size();
  if (first > d.dims[axis] || count > d.dims[axis] - first)
    fail(name, std::to_string(d.dims[axis]) + " rows", "at least " + std::to_string(first + count));
  start[axis] = first;
  size[axis] = count;
  std::size_t total = 1;
  for (const auto n : size) total *= n;
  std::vector<T> out(total);
  if (total == 0) return out;
  const Id space{H5Dget_space(d.id.get())}, memory{H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr)};
  if (H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr) < 0 ||
      H5Dread(d.id.get(), memory_type<T>(), memory.get(), space.get(), H5P_DEFAULT, out.data()) < 0)
    fail(name, "values that cannot be read", "an undamaged dataset");
  if constexpr (std::is_floating_point_v<T>)
    for (const T x : out)
      if (!std::isfinite(x)) fail(name, "a value that is not finite", "finite numbers");
  return out;
}

template <class T>
std::vector<T> DatasetReader::all(const std::string& name) const {
  const auto& d = open(name);
  if (d.dims.empty()) fail(name, "a single value", "an array");
  return block<T>(name, {}, 0, d.dims[0]);
}

#define SUNFLECK_INSTANTIATE(T)                                                                                                         \
  template std::vector<T> DatasetReader::block<T>(const std::string&, const std::vector<std::size_t>&, std::size_t, std::size_t) const; \
  template std::vector<T> DatasetReader::all<T>(const std::string&) const;
SUNFLECK_INSTANTIATE(float)
SUNFLECK_INSTANTIATE(double)
SUNFLECK_INSTANTIATE(std::uint8_t)
SUNFLECK_INSTANTIATE(std::uint32_t)
SUNFLECK_INSTANTIATE(std::uint64_t)
SUNFLECK_INSTANTIATE(std::int64_t)
#undef SUNFLECK_INSTANTIATE

std::vector<std::string> DatasetReader::strings(const std::string& name) const {
  const Quiet quiet;
  const auto& d = open(name);
  if (d.type != H5T_STRING || d.dims.size() != 1) fail(name, "something else than a list of texts", "a list of texts");
  std::vector<char> padded(d.dims[0] * d.element_size);
  const Id type{H5Dget_type(d.id.get())};
  if (!padded.empty() && H5Dread(d.id.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()) < 0)
    fail(name, "texts that cannot be read", "an undamaged dataset");
  std::vector<std::string> out;
  for (std::size_t i = 0; i < d.dims[0]; ++i) {
    std::string text(padded.data() + i * d.element_size, d.element_size);
    text.resize(text.find_last_not_of('\0') + 1);
    out.push_back(std::move(text));
  }
  return out;
}

bool DatasetReader::has_attribute(const std::string& object, const char* name) const {
  const Quiet quiet;
  return H5Aexists_by_name(file_.get(), object.c_str(), name, H5P_DEFAULT) > 0;
}

Id DatasetReader::attribute(const std::string& object, const char* name) const {
  const std::string label = (object == "/" ? "" : object + "/") + std::string("@") + name;
  if (!has_attribute(object, name)) fail(label, "no such attribute", "one");
  Id id{H5Aopen_by_name(file_.get(), object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT)};
  if (!id) fail(label, "a damaged attribute", "one that can be read");
  const Id space{H5Aget_space(id.get())};
  if (!space || H5Aget_storage_size(id.get()) > (hsize_t{1} << 30)) fail(label, "a damaged attribute", "one that can be read");
  return id;
}

std::string DatasetReader::text_attribute(const std::string& object, const char* name) const {
  const Quiet quiet;
  const Id id = attribute(object, name), type{H5Aget_type(id.get())}, space{H5Aget_space(id.get())};
  const std::string label = std::string("@") + name;
  if (H5Tget_class(type.get()) != H5T_STRING) fail(label, "no text", "text");
  if (H5Sget_simple_extent_npoints(space.get()) != 1) fail(label, "several texts", "one");
  std::string text;
  if (H5Tis_variable_str(type.get()) > 0) {
    char* pointer = nullptr;
    if (H5Aread(id.get(), type.get(), &pointer) < 0) fail(label, "a damaged attribute", "one that can be read");
    if (pointer) text = pointer;
    H5free_memory(pointer);
  } else {
    text.resize(H5Tget_size(type.get()));
    if (H5Aread(id.get(), type.get(), text.data()) < 0) fail(label, "a damaged attribute", "one that can be read");
    text.resize(text.find_last_not_of('\0') + 1);
  }
  return text;
}

std::uint64_t DatasetReader::count_attribute(const std::string& object, const char* name) const {
  const Quiet quiet;
  const Id id = attribute(object, name), space{H5Aget_space(id.get())};
  std::uint64_t value = 0;
  if (H5Sget_simple_extent_npoints(space.get()) != 1 || H5Aread(id.get(), H5T_NATIVE_UINT64, &value) < 0)
    fail(std::string("@") + name, "no whole number", "one");
  return value;
}

std::vector<double> DatasetReader::values_attribute(const std::string& object, const char* name) const {
  const Quiet quiet;
  const Id id = attribute(object, name), space{H5Aget_space(id.get())};
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
  if (H5Aread(id.get(), H5T_NATIVE_DOUBLE, values.data()) < 0) fail(object + "/@" + name, "no numbers", "numbers");
  return values;
}

}  // namespace sunfleck::h5
