// A scene that Python makes: the library's, and what is only known when it is solved.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include <sunfleck/scene/run_settings.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck::python {

namespace py = pybind11;

class SceneInMemory {
 public:
  SceneInMemory(std::vector<std::string> bands, const std::vector<std::string>& units);
  explicit SceneInMemory(const std::string& file);

  Scene scene;
  RunSettings run;  ///< what a scene file says of it
  struct Lamp {
    std::string text;
    std::optional<Mesh> mesh;
  };
  std::vector<Lamp> lamps;  ///< read when the states are known

  /// As it is now, for a solve.
  std::shared_ptr<const Scene> frozen() const;
};

void bind_scene(py::module_& module);

}  // namespace sunfleck::python
