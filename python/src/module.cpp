// sunfleck._core: the library as the Python package sees it.
#include <csignal>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <sunfleck/cli/program.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/version.hpp>
#include <sunfleck/light/sun.hpp>
#include <sunfleck/solver/solution.hpp>

#include "light.hpp"
#include "progress.hpp"
#include "scene.hpp"
#include "session.hpp"

namespace sunfleck::python {

namespace {

/// Messages name arguments; where nothing is a file, they need not say so.
std::string said(const char* what) {
  const std::string text = what, memory = "scene in memory: ";
  return text.rfind(memory, 0) == 0 ? text.substr(memory.size()) : text;
}

RunSettings run_settings(const std::optional<std::string>& method, const std::optional<std::string>& quality,
                         const std::vector<std::pair<std::string, double>>& error, const std::optional<std::int64_t>& seed,
                         const std::optional<bool>& certificate, const std::optional<std::uint32_t>& certificate_organs,
                         const std::optional<std::uint64_t>& certificate_rays, const std::optional<std::uint32_t>& samples, int threads) {
  RunSettings run;
  run.method = method;
  if (quality) {
    run.quality = quality_from_name(*quality);
    if (!run.quality) throw py::value_error(fmt::format("quality: found \"{}\"; expected draft, standard or fine", *quality));
  }
  for (const auto& [band, value] : error) run.error.push_back({band, value});
  if (seed && *seed < 0) throw py::value_error(fmt::format("seed: found {}; expected zero or more", *seed));
  if (seed) run.seed = static_cast<std::uint64_t>(*seed);
  run.certificate = certificate;
  run.certificate_organs = certificate_organs;
  run.certificate_rays = certificate_rays;
  run.samples = samples;
  if (threads < 0) throw py::value_error(fmt::format("threads: found {}; expected zero (all cores) or more", threads));
  run.threads = threads;
  return run;
}

std::shared_ptr<Light> solve_scene(const SceneInMemory& scene, RunSettings run, bool facets, const py::object& progress) {
  run = filled_up(std::move(run), scene.run);
  auto frozen = scene.frozen();
  Solution solution;
  while_python_listens(progress, [&](Progress& relay) { solution = sunfleck::solve(*frozen, run, relay, facets); });
  return light_of(std::move(frozen), std::move(solution), facets);
}

int run_main(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = arguments;
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::signal(SIGINT, SIG_DFL);  // the program has its own ways; Python's would not see a signal before the end
  const py::gil_scoped_release released;
  return run_program(static_cast<int>(words.size()), argv.data());
}

/// Arrays of numpy 2 look otherwise than pybind11 before 2.12 thinks: better no module than wrong numbers.
void refuse_other_numpy() {
#if PYBIND11_VERSION_HEX < 0x020C0000
  const std::string version = py::str(py::module_::import("numpy").attr("__version__"));
  if (std::stoi(version) >= 2) {
    const std::string built = fmt::format("{}.{}", PYBIND11_VERSION_MAJOR, PYBIND11_VERSION_MINOR);
    throw py::import_error(fmt::format("sunfleck was built with pybind11 {}, which knows numpy 1 alone; found numpy {}", built, version));
  }
#endif
}

}  // namespace

}  // namespace sunfleck::python

PYBIND11_MODULE(_core, m) {
  using namespace sunfleck;
  using namespace sunfleck::python;
  refuse_other_numpy();
  m.doc() = "The compiled part of sunfleck; use the package itself.";
  static py::handle error = py::exception<Error>(m, "Error", PyExc_RuntimeError).release();
  static py::handle input_error = py::exception<InputError>(m, "InputError", PyExc_ValueError).release();
  static py::handle stopped = py::exception<Stopped>(m, "Stopped", PyExc_RuntimeError).release();
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const InputError& e) {
      PyErr_SetString(input_error.ptr(), said(e.what()).c_str());
    } catch (const UsageError& e) {
      PyErr_SetString(input_error.ptr(), said(e.what()).c_str());
    } catch (const OutOfMemory& e) {
      PyErr_SetString(PyExc_MemoryError, said(e.what()).c_str());
    } catch (const OutputError& e) {
      PyErr_SetString(PyExc_OSError, said(e.what()).c_str());
    } catch (const Stopped& e) {
      PyErr_SetString(stopped.ptr(), said(e.what()).c_str());
    } catch (const Error& e) {
      PyErr_SetString(error.ptr(), said(e.what()).c_str());
    }
  });
  m.attr("version") = software_version();
  m.def("main", &run_main, py::arg("arguments"));
  m.def(
      "solar_position",
      [](const std::string& time, double latitude, double longitude, double altitude) {
        const auto p = solar_position(time, latitude, longitude, altitude, "time");
        return std::make_pair(p.elevation_deg, p.azimuth_deg);
      },
      py::arg("time"), py::arg("latitude"), py::arg("longitude"), py::arg("altitude"));
  bind_scene(m);
  bind_light(m);
  py::class_<RunSettings>(m, "Run").def(py::init(&run_settings), py::arg("method"), py::arg("quality"), py::arg("error"), py::arg("seed"),
                                        py::arg("certificate"), py::arg("certificate_organs"), py::arg("certificate_rays"),
                                        py::arg("samples"), py::arg("threads"));
  bind_session(m);
  m.def("solve", &solve_scene, py::arg("scene"), py::arg("run"), py::arg("facets"), py::arg("progress"));
}
