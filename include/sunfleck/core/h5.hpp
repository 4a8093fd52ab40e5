// Handles of HDF5 that close themselves, and types of its datasets. Only for modules that link HDF5.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <utility>

namespace sunfleck::h5 {

/// How often, on this thread, HDF5 could not close what it was asked to: what that held may not have reached its file.
inline thread_local std::uint64_t failed_closes = 0;

/// Owns an identifier of any kind.
class Id {
 public:
  Id() = default;
  explicit Id(hid_t id) : id_(id) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Id() { close(); }
  void close() {
    if (id_ >= 0 && H5Idec_ref(std::exchange(id_, H5I_INVALID_HID)) < 0) ++failed_closes;
  }
  explicit operator bool() const { return id_ >= 0; }
  hid_t get() const { return id_; }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

/// HDF5 prints its error stack by default; our errors say what happened instead.
class Quiet {
 public:
  Quiet() {
    // What damaged files leave behind inside HDF5 makes its exit handler complain; we close our files ourselves.
    [[maybe_unused]] static const herr_t no_exit_handler = H5dont_atexit();
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

template <class T>
hid_t memory_type();
template <>
inline hid_t memory_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
inline hid_t memory_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t memory_type<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}
template <>
inline hid_t memory_type<std::uint32_t>() {
  return H5T_NATIVE_UINT32;
}
template <>
inline hid_t memory_type<std::uint64_t>() {
  return H5T_NATIVE_UINT64;
}
template <>
inline hid_t memory_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}

}  // namespace sunfleck::h5
