#include "session.hpp"

#include <mutex>

#include <pybind11/stl.h>

#include <sunfleck/solver/session.hpp>

#include "light.hpp"
#include "progress.hpp"
#include "scene.hpp"

namespace sunfleck::python {

namespace {

class PythonSession {
 public:
  PythonSession(RunSettings run, std::uint64_t most_bytes, std::string folder)
      : run_(std::move(run)), session_(run_, SessionSettings{most_bytes, std::move(folder)}) {}

  std::shared_ptr<Light> solve(const SceneInMemory& scene, bool facets, const py::object& progress) {
    auto frozen = scene.frozen();
    const std::unique_lock lock(busy_, std::try_to_lock);
    if (!lock) throw py::value_error("session: found a solve that goes on in another thread; expected one at a time");
    session_.run = filled_up(run_, scene.run);
    Solution solution;
    while_python_listens(progress, [&](Progress& relay) { solution = session_.solve(*frozen, relay, facets); });
    reuse_ = session_.reused();
    return light_of(std::move(frozen), std::move(solution), facets);
  }
  const Reuse& reuse() const { return reuse_; }

 private:
  std::mutex busy_;
  RunSettings run_;
  Session session_;
  Reuse reuse_;
};

py::dict numbers(const std::vector<std::pair<std::string, std::uint64_t>>& pairs) {
  py::dict out;
  for (const auto& [name, number] : pairs) out[py::str(name)] = number;
  return out;
}

}  // namespace

void bind_session(py::module_& m) {
  py::class_<PythonSession>(m, "Session")
      .def(py::init<RunSettings, std::uint64_t, std::string>(), py::arg("run"), py::arg("memory"), py::arg("folder"))
      .def("solve", &PythonSession::solve, py::arg("scene"), py::arg("facets"), py::arg("progress"))
      .def_property_readonly("reused", [](const PythonSession& s) { return numbers(s.reuse().reused); })
      .def_property_readonly("made", [](const PythonSession& s) { return numbers(s.reuse().made); })
      .def_property_readonly("saved_seconds", [](const PythonSession& s) { return s.reuse().saved_seconds; });
}

}  // namespace sunfleck::python
