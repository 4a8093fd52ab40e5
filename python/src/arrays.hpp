// numpy arrays in and out, without copies that nobody asked for.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <sunfleck/plant/mesh.hpp>

namespace sunfleck::python {

namespace py = pybind11;

/// An array that was checked: C-contiguous, of the type and shape that was asked for.
template <class T>
struct Values {
  py::array owner;
  const T* data = nullptr;
  std::vector<std::size_t> shape;
  std::size_t size() const {
    std::size_t n = 1;
    for (const auto s : shape) n *= s;
    return n;
  }
};

/// `shape`: -1 is any length. T is double or std::int64_t. Throws ValueError that names the argument, and the index of a value that is not
/// finite.
template <class T>
Values<T> values(const py::handle& array, const std::string& name, const std::vector<std::ptrdiff_t>& shape);

/// Triangles (n, 3, 3), or with indices vertices (v, 3) and indices (n, 3). [m]
Mesh mesh_from(const py::handle& points, const py::handle& indices, const std::string& name);

/// The vector's memory as an array; `owner` lives as long as the array does. Read only.
template <class T>
py::array view(const std::vector<T>& data, const std::vector<std::size_t>& shape, std::shared_ptr<const void> owner) {
  auto* held = new std::shared_ptr<const void>(std::move(owner));
  py::capsule keeper(held, [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
  std::vector<py::ssize_t> sizes(shape.begin(), shape.end());
  py::array out(py::dtype::of<T>(), sizes, data.data(), keeper);
  out.attr("flags").attr("writeable") = false;
  return out;
}

}  // namespace sunfleck::python
