#include "light.hpp"

#include <pybind11/stl.h>

#include <fmt/format.h>
#include <sunfleck/core/error.hpp>
#include <sunfleck/solver/organ_views.hpp>
#include <sunfleck/solver/result_file.hpp>

#include "arrays.hpp"
#include "picture.hpp"
#include "progress.hpp"

namespace sunfleck::python {

namespace {

/// Names of the organs, a list each: "name", "type", "plant" or "placement".
py::list organ_names_of(const Light& light, const std::string& what) {
  const auto& organs = light.solution.organs;
  py::list out;
  if (light.table) {
    const auto& t = *light.table;
    const auto& rows = what == "name" ? t.name : what == "type" ? t.type : what == "plant" ? t.plant : t.placement;
    const auto& names = what == "name" ? t.names : what == "type" ? t.types : what == "plant" ? t.plants : t.placements;
    std::vector<py::str> texts(names.begin(), names.end());
    for (const auto row : rows) out.append(texts.at(row));
    return out;
  }
  for (std::size_t o = 0; o < organs.count; ++o) {
    if (what == "name")
      out.append(organs.name(o));
    else if (what == "type")
      out.append(organs.type(o));
    else if (what == "placement")
      out.append(organs.placement(o));
    else
      out.append(organs.plant[o] == of_ground ? std::string("ground") : light.scene->plants[organs.plant[o]].name);
  }
  return out;
}

py::object array_of(const std::shared_ptr<Light>& light, const std::string& name) {
  const auto& f = light->solution.facets;
  const auto& o = light->solution.organs;
  const std::size_t s = o.states, b = o.bands, n = f.count, m = o.count;
  const std::shared_ptr<const void> owner = light;
  if (name == "organs.absorbed") return view(o.absorbed, {s, m, b}, owner);
  if (name == "organs.irradiance") return view(o.irradiance, {s, m, 2, b}, owner);
  if (name == "organs.sunlit") return view(o.sunlit, {s, m, 2}, owner);
  if (name == "organs.area") return view(o.area, {m}, owner);
  if (name == "organs.variance") return o.variance.empty() ? py::object(py::none()) : view(o.variance, {s, m, b}, owner);
  if (name == "organs.member" && !light->table) return view(o.member, {m}, owner);
  if (!light->has_facets) return py::none();
  if (name == "facets.absorbed") return view(f.absorbed, {s, n, b}, owner);
  if (name == "facets.irradiance") return view(f.irradiance, {s, n, 2, b}, owner);
  if (name == "facets.sunlit") return view(f.sunlit, {s, n, 2}, owner);
  if (name == "facets.area") return view(f.area, {n}, owner);
  if (name == "facets.organ") return view(f.organ, {n}, owner);
  if (name == "facets.variance") return f.variance.empty() ? py::object(py::none()) : view(f.variance, {s, n, b}, owner);
  throw py::key_error(name);
}

py::dict balance_of(const Light& light) {
  py::dict out;
  const auto& report = light.solution.report;
  const std::size_t s = report.balance.size(), b = light.bands.size();
  const auto column = [&](const char* name, auto&& value) {
    py::array_t<double> values({s, b});
    auto at = values.template mutable_unchecked<2>();
    for (std::size_t i = 0; i < s; ++i)
      for (std::size_t j = 0; j < b; ++j) at(i, j) = value(report.balance[i][j]);
    out[name] = values;
  };
  column("incident", [](const Balance& x) { return x.incident; });
  column("leaves", [](const Balance& x) { return x.leaves; });
  column("ground", [](const Balance& x) { return x.ground; });
  column("escaped", [](const Balance& x) { return x.escaped; });
  column("residual", [](const Balance& x) { return x.residual(); });
  return out;
}

py::object certificate_of(const std::shared_ptr<Light>& light) {
  if (!light->solution.certificate) return py::none();
  const auto& c = *light->solution.certificate;
  const std::size_t k = c.organs.size(), b = light->bands.size(), s = light->states.size();
  const std::shared_ptr<const void> owner = light;
  py::dict out;
  out["organs"] = view(c.organs, {k}, owner);
  out["solved"] = view(c.solved, {s, k, b}, owner);
  out["reference"] = view(c.reference, {s, k, b}, owner);
  out["standard_error"] = view(c.standard_error, {s, k, b}, owner);
  out["rmse"] = view(c.rmse, {b}, owner);
  out["rmse_low"] = view(c.rmse_low, {b}, owner);
  out["rmse_high"] = view(c.rmse_high, {b}, owner);
  out["bias"] = view(c.bias, {b}, owner);
  out["rays"] = c.rays;
  return out;
}

py::dict sensors_of(const std::shared_ptr<Light>& light) {
  py::dict out;
  const std::size_t s = light->states.size(), b = light->bands.size();
  const std::shared_ptr<const void> owner = light;
  for (const auto& sensor : light->sensors) {
    py::dict one;
    const std::size_t k = sensor.area.size();
    one["area"] = view(sensor.area, {k}, owner);
    one["centroid"] = view(sensor.centroid, {k, 3}, owner);
    one["irradiance"] = view(sensor.reading.irradiance, {s, k, b}, owner);
    if (!sensor.reading.standard_error.empty()) one["standard_error"] = view(sensor.reading.standard_error, {s, k, b}, owner);
    if (!sensor.reading.back.empty()) one["irradiance_back"] = view(sensor.reading.back, {s, k, b}, owner);
    out[py::str(sensor.name)] = one;
  }
  return out;
}

template <class Pairs>
py::dict dict_of(const Pairs& pairs) {
  py::dict out;
  for (const auto& [name, value] : pairs) out[py::str(name)] = value;
  return out;
}

}  // namespace

std::shared_ptr<Light> light_of(std::shared_ptr<const Scene> scene, Solution solution, bool has_facets) {
  auto out = std::make_shared<Light>();
  out->solution = std::move(solution);
  out->has_facets = has_facets;
  out->bands = scene->bands;
  out->units = scene->band_units;
  out->units.resize(out->bands.size(), "W m^-2");
  out->states = scene->states;
  out->status = name_of(out->solution.report.status);
  for (std::size_t i = 0; i < out->solution.report.sensors.size(); ++i) {
    StoredSensor sensor;
    sensor.name = scene->sensors[i].name;
    sensor.reading = out->solution.report.sensors[i];
    for (const auto& cell : sensor.reading.cells) {
      sensor.area.push_back(static_cast<float>(cell.area()));
      const Vec3 c = cell.centroid();
      sensor.centroid.insert(sensor.centroid.end(), {c.x, c.y, c.z});
    }
    out->sensors.push_back(std::move(sensor));
  }
  out->scene = std::move(scene);
  return out;
}

std::shared_ptr<Light> read_light_file(const std::string& file) {
  const Result result(file);
  auto out = std::make_shared<Light>();
  out->file = file;
  out->bands = result.bands();
  out->units = result.band_units();
  out->states = result.states();
  out->sensors = result.sensors();
  out->status = result.header().status;
  out->table = result.organs();
  Solution& solution = out->solution;
  auto& report = solution.report;
  report.method = solution.choice.method = result.header().method;
  report.balance = result.balance();
  report.convergence = result.convergence();
  report.counts = result.counts();
  report.memory = result.memory();
  report.timings = result.timings();
  solution.certificate = result.certificate();
  auto& o = solution.organs;
  o.states = out->states.size(), o.bands = out->bands.size(), o.count = result.organ_count();
  const auto need = [&](const char* name) {
    if (!result.has(name)) throw InputError(file + ": " + name, "nothing", "a result that keeps it");
  };
  for (const char* name : {"organs/absorbed", "organs/irradiance", "organs/area"}) need(name);
  o.absorbed = result.all<double>("organs/absorbed");
  o.irradiance = result.all<double>("organs/irradiance");
  o.area = result.all<double>("organs/area");
  if (result.has("organs/sunlit")) o.sunlit = result.all<double>("organs/sunlit");
  o.sunlit.resize(o.states * o.count * 2);
  auto& f = solution.facets;
  f.states = o.states, f.bands = o.bands;
  out->has_facets = result.facet_count() > 0 && result.has("facets/absorbed") && result.has("facets/irradiance") &&
                    result.has("facets/area") && result.has("facets/organ");
  if (!out->has_facets) return out;
  f.count = result.facet_count();
  f.absorbed = result.all<float>("facets/absorbed");
  f.irradiance = result.all<float>("facets/irradiance");
  f.area = result.all<float>("facets/area");
  f.organ = result.facet_organs(0, f.count);
  if (result.has("facets/sunlit")) f.sunlit = result.all<float>("facets/sunlit");
  f.sunlit.resize(f.states * f.count * 2);
  return out;
}

void bind_light(py::module_& m) {
  m.def("read_result", &read_light_file, py::arg("file"));
  py::class_<Light, std::shared_ptr<Light>>(m, "Light")
      .def_readonly("bands", &Light::bands)
      .def_readonly("units", &Light::units)
      .def_readonly("status", &Light::status)
      .def_readonly("file", &Light::file)
      .def_readonly("has_facets", &Light::has_facets)
      .def_property_readonly("method", [](const Light& l) { return l.solution.report.method; })
      .def_property_readonly("why", [](const Light& l) { return l.solution.choice.why; })
      .def_property_readonly("verdict", [](const Light& l) { return l.solution.verdict; })
      .def_property_readonly("states",
                             [](const Light& l) {
                               std::vector<std::pair<std::string, double>> out;
                               for (const auto& s : l.states) out.emplace_back(s.name, s.duration_s);
                               return out;
                             })
      .def_property_readonly("organ_count", [](const Light& l) { return l.solution.organs.count; })
      .def_property_readonly("balance", &balance_of)
      .def_property_readonly("certificate", &certificate_of)
      .def_property_readonly("sensors", &sensors_of)
      .def_property_readonly("timings", [](const Light& l) { return dict_of(l.solution.report.timings); })
      .def_property_readonly("counts", [](const Light& l) { return dict_of(l.solution.report.counts); })
      .def_property_readonly("memory", [](const Light& l) { return dict_of(l.solution.report.memory); })
      .def("array", &array_of, py::arg("name"))
      .def("names", &organ_names_of, py::arg("what"))
      .def(
          "write",
          [](const std::shared_ptr<Light>& l, const std::string& file) {
            if (!l->scene)
              throw py::value_error("write: found a result of " + l->file + "; expected one that was solved here (copy the file)");
            while_python_listens(py::none(), [&](Progress&) { write_result(*l->scene, l->solution, file); });
          },
          py::arg("file"))
      .def(
          "views",
          [](const std::shared_ptr<Light>& l, std::uint32_t rays, std::int64_t seed) {
            if (!l->scene) throw py::value_error("views: found a result of " + l->file + "; expected one that was solved here");
            auto views = std::make_shared<OrganViews>();
            while_python_listens(
                py::none(), [&](Progress& progress) { *views = organ_views(*l->scene, rays, static_cast<std::uint64_t>(seed), progress); });
            return py::make_tuple(view(views->sky, {views->count, 2}, views), view(views->ground, {views->count, 2}, views));
          },
          py::arg("rays"), py::arg("seed"))
      .def(
          "png",
          [](const std::shared_ptr<Light>& l, std::size_t state, int width, int height, int samples) {
            if (state >= l->states.size())
              throw py::value_error(fmt::format("state: found {}; expected a row of the {} states", state, l->states.size()));
            std::string bytes;
            while_python_listens(py::none(), [&](Progress& progress) {
              const PictureSize size{width, height, samples};
              if (!l->scene) {
                bytes = picture_of_file(l->file, state, size, progress);
              } else {
                const auto& f = l->solution.facets;
                bytes = picture_of_scene(*l->scene, l->solution.depth, f.irradiance, f.sunlit, state, size, progress);
              }
            });
            return py::bytes(bytes);
          },
          py::arg("state"), py::arg("width"), py::arg("height"), py::arg("samples"));
}

}  // namespace sunfleck::python
