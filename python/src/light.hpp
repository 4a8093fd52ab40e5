// Light that was found, in memory: of a solve, or read from a result file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/solver/solution.hpp>

namespace sunfleck::python {

namespace py = pybind11;

struct Light {
  std::shared_ptr<const Scene> scene;  ///< null if read from a file
  Solution solution;
  bool has_facets = true;

  std::vector<std::string> bands, units;
  std::vector<LightState> states;
  std::string file;  ///< that it was read from
  std::vector<StoredSensor> sensors;
  std::string status;
  std::optional<OrganTable> table;  ///< if read from a file: names of the organs
};

std::shared_ptr<Light> light_of(std::shared_ptr<const Scene> scene, Solution solution, bool has_facets);
std::shared_ptr<Light> read_light_file(const std::string& file);

void bind_light(py::module_& module);

}  // namespace sunfleck::python
