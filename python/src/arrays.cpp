#include "arrays.hpp"

#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace sunfleck::python {

namespace {

std::string shape_text(const std::vector<std::ptrdiff_t>& shape) {
  std::string text;
  char name = 'n';
  for (const auto s : shape) text += (text.empty() ? "" : ", ") + (s < 0 ? std::string(1, name++) : std::to_string(s));
  return "(" + text + (shape.size() == 1 ? ",)" : ")");
}

std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape"));
}

std::string index_text(std::size_t at, const std::vector<std::size_t>& shape) {
  std::string text;
  for (std::size_t d = shape.size(); d-- > 0;) {
    text = std::to_string(at % shape[d]) + (text.empty() ? "" : ", ") + text;
    at /= shape[d];
  }
  return "[" + text + "]";
}

}  // namespace

template <class T>
Values<T> values(const py::handle& given, const std::string& name, const std::vector<std::ptrdiff_t>& shape) {
  constexpr bool real = std::is_same_v<T, double>;
  const std::string type = real ? "float64" : "int64";
  if (!py::isinstance<py::array>(given))
    throw py::value_error(fmt::format("{}: found {}; expected a numpy array of shape {} and dtype {}", name,
                                      std::string(py::str(py::type::of(given).attr("__name__"))), shape_text(shape), type));
  const auto array = py::reinterpret_borrow<py::array>(given);
  bool fits = static_cast<std::size_t>(array.ndim()) == shape.size();
  for (std::size_t d = 0; fits && d < shape.size(); ++d) fits = shape[d] < 0 || array.shape(static_cast<py::ssize_t>(d)) == shape[d];
  if (!fits) throw py::value_error(fmt::format("{}: found shape {}; expected {}", name, shape_text(array), shape_text(shape)));
  if (!py::isinstance<py::array_t<T>>(given))
    throw py::value_error(fmt::format("{}: found dtype {}; expected {} ({}.astype({}) converts it)", name,
                                      std::string(py::str(array.dtype())), type, name, real ? "float" : "int"));
  if (!(array.flags() & py::array::c_style) || reinterpret_cast<std::uintptr_t>(array.data()) % alignof(T) != 0)
    throw py::value_error(
        fmt::format("{}: found an array that is not contiguous; expected C order (numpy.ascontiguousarray copies it)", name));
  Values<T> out{array, static_cast<const T*>(array.data()), {}};
  for (py::ssize_t d = 0; d < array.ndim(); ++d) out.shape.push_back(static_cast<std::size_t>(array.shape(d)));
  if constexpr (real) {
    const std::size_t n = out.size();
    for (std::size_t i = 0; i < n; ++i)
      if (!std::isfinite(out.data[i]))
        throw py::value_error(fmt::format("{}{}: found {}; expected a finite number", name, index_text(i, out.shape), out.data[i]));
  }
  return out;
}

template Values<double> values(const py::handle&, const std::string&, const std::vector<std::ptrdiff_t>&);
template Values<std::int64_t> values(const py::handle&, const std::string&, const std::vector<std::ptrdiff_t>&);

Mesh mesh_from(const py::handle& points, const py::handle& indices, const std::string& name) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  Mesh mesh;
  if (indices.is_none()) {
    const auto corners = values<double>(points, name.empty() ? "triangles" : name + ".triangles", {-1, 3, 3});
    const std::size_t n = corners.shape[0];
    mesh.vertices.resize(3 * n);
    std::memcpy(static_cast<void*>(mesh.vertices.data()), corners.data, 9 * n * sizeof(double));
    mesh.triangles.resize(n);
    for (std::uint32_t t = 0; t < n; ++t) mesh.triangles[t] = {3 * t, 3 * t + 1, 3 * t + 2};
    return mesh;
  }
  const auto vertices = values<double>(points, name.empty() ? "vertices" : name + ".vertices", {-1, 3});
  const auto rows = values<std::int64_t>(indices, name.empty() ? "indices" : name + ".indices", {-1, 3});
  mesh.vertices.resize(vertices.shape[0]);
  std::memcpy(static_cast<void*>(mesh.vertices.data()), vertices.data, vertices.size() * sizeof(double));
  mesh.triangles.resize(rows.shape[0]);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows.data[i] < 0 || static_cast<std::size_t>(rows.data[i]) >= mesh.vertices.size())
      throw py::value_error(fmt::format("indices{}: found {}; expected a row of the {} vertices", index_text(i, rows.shape), rows.data[i],
                                        mesh.vertices.size()));
    mesh.triangles[i / 3][i % 3] = static_cast<std::uint32_t>(rows.data[i]);
  }
  return mesh;
}

}  // namespace sunfleck::python
