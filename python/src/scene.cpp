#include "scene.hpp"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/format/caribu_files.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/scene_parts.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/slope.hpp>

#include "arrays.hpp"

namespace sunfleck::python {

namespace {

const std::vector<std::string> watts{"W m^-2", "W m-2", "W/m2"}, photons{"umol m^-2 s^-1", "umol m-2 s-1", "umol/m2/s"};

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void refuse_taken(const Scene& scene, const std::string& name, const std::string& kind) {
  if (name.empty() || name.find('/') != std::string::npos)
    throw py::value_error(fmt::format("{}.name: found \"{}\"; expected a name without \"/\"", kind, name));
  const auto same = [&](const auto& entry) { return entry.name == name; };
  if (std::any_of(scene.plants.begin(), scene.plants.end(), same) || std::any_of(scene.groups.begin(), scene.groups.end(), same))
    throw py::value_error(fmt::format("{}.name: found \"{}\" twice; expected a name of its own for every plant and group", kind, name));
}

std::uint32_t optics_row(const Scene& scene, const std::string& name, const std::string& where) {
  std::vector<std::string> known;
  for (std::uint32_t o = 0; o < scene.optics.size(); ++o) {
    if (scene.optics[o].name == name) return o;
    known.push_back(scene.optics[o].name);
  }
  const std::string nearest = nearest_name(name, known);
  throw py::value_error(
      fmt::format("{}: found \"{}\"; expected {}{}", where, name,
                  known.empty() ? "optics of the scene, which has none: scene.optics(...) first" : "one of " + joined(known),
                  nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
}

AttributeValue attribute_from(const py::handle& value, const std::string& where) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::int_>(value)) return value.cast<std::int64_t>();
  if (py::isinstance<py::float_>(value)) return value.cast<double>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  throw py::value_error(
      fmt::format("{}: found {}; expected bool, int, float or str", where, std::string(py::str(py::type::of(value).attr("__name__")))));
}

/// Structures with a parent each (rows before their own), and the structure that owns each triangle.
std::size_t add_arrays(SceneInMemory& self, const std::string& name, const py::object& points, const py::object& indices,
                       const py::object& owner, const std::vector<std::uint32_t>& parents, const std::vector<std::string>& types,
                       const std::vector<std::string>& names, const std::vector<std::string>& optics, const py::list& attributes,
                       const std::string& policy) {
  Scene& scene = self.scene;
  refuse_taken(scene, name, "plant");
  Mesh mesh = mesh_from(points, indices, "");
  const std::size_t n = mesh.triangles.size();
  if (n == 0) throw py::value_error((indices.is_none() ? "triangles" : "indices") + std::string(": found none; expected at least one"));
  const auto rows = values<std::int64_t>(owner, "organ", {static_cast<std::ptrdiff_t>(n)});
  Plant plant;
  plant.name = name;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    const auto at = add_structure(plant, i == 0 ? no_parent : parents[i], types[i], names[i]);
    if (i < attributes.size() && !attributes[i].is_none())
      for (const auto& [key, value] : attributes[i].cast<py::dict>())
        set_attribute(plant, at, key.cast<std::string>(), attribute_from(value, "attributes." + key.cast<std::string>()));
  }
  std::vector<std::uint32_t> material_of(parents.size(), 0);
  std::unordered_map<std::string, std::uint32_t> material;
  for (std::size_t i = 0; i < parents.size(); ++i)
    if (!optics[i].empty()) {
      const auto [at, fresh] = material.try_emplace(optics[i], 0);
      if (fresh) at->second = plant.material_index(optics[i]);
      material_of[i] = at->second;
    }
  std::vector<std::uint32_t> structure(n), used(n);
  for (std::size_t t = 0; t < n; ++t) {
    structure[t] = static_cast<std::uint32_t>(rows.data[t]);
    if (structure[t] >= parents.size() || optics[structure[t]].empty())
      throw py::value_error(fmt::format("organ[{}]: found structure {} without optics; expected one with", t, rows.data[t]));
    used[t] = material_of[structure[t]];
  }
  add_mesh(plant, std::move(mesh), structure, used);
  PlantEntry entry;
  entry.name = name;
  std::vector<std::uint32_t> row;
  for (const auto& m : plant.materials) row.push_back(optics_row(scene, m, "plant.optics"));
  for (const auto& shape : plant.shapes) entry.shape_optics.push_back(row[shape.material]);
  entry.policy_file = policy;
  entry.plant = std::make_shared<const Plant>(std::move(plant));
  scene.plants.push_back(std::move(entry));
  return scene.plants.size() - 1;
}

std::vector<Placement> stances(const py::object& position, const py::object& turn, const py::object& scale, const py::object& tilt,
                               const py::object& tilt_azimuth, bool mirror) {
  const auto at = values<double>(position, "position", {-1, 3});
  const std::size_t k = at.shape[0];
  const auto column = [&](const py::object& values_of, const char* name, auto&& set, std::vector<Stance>& out, double low, double high,
                          const char* expected) {
    const auto v = values<double>(values_of, name, {-1});
    if (v.shape[0] != 1 && v.shape[0] != k)
      throw py::value_error(fmt::format("{}: found {} values; expected one, or one for each of {} positions", name, v.shape[0], k));
    for (std::size_t i = 0; i < k; ++i) {
      const double x = v.data[v.shape[0] == 1 ? 0 : i];
      if (!(x >= low && x <= high))
        throw py::value_error(v.shape[0] == 1 ? fmt::format("{}: found {}; expected {}", name, x, expected)
                                              : fmt::format("{}[{}]: found {}; expected {}", name, i, x, expected));
      set(out[i], x);
    }
  };
  std::vector<Stance> all(k);
  for (std::size_t i = 0; i < k; ++i) all[i].position = {at.data[3 * i], at.data[3 * i + 1], at.data[3 * i + 2]}, all[i].mirror = mirror;
  constexpr double any = 1e300, least = std::numeric_limits<double>::min();
  column(
      turn, "turn", [](Stance& s, double x) { s.turn_deg = x; }, all, -any, any, "degrees");
  column(
      scale, "scale", [](Stance& s, double x) { s.scale = x; }, all, least, any, "a number above zero");
  column(
      tilt, "tilt", [](Stance& s, double x) { s.tilt_deg = x; }, all, 0, 180, "0 to 180 degrees");
  column(
      tilt_azimuth, "tilt_azimuth", [](Stance& s, double x) { s.tilt_azimuth_deg = x; }, all, -any, any, "degrees");
  std::vector<Placement> out;
  for (const auto& stance : all) out.push_back(placed(stance));
  return out;
}

/// Maps (k, 3, 4): rows of a matrix whose last column is the move.
std::vector<Placement> affines(const py::object& maps) {
  const auto m = values<double>(maps, "affine", {-1, 3, 4});
  std::vector<Placement> out(m.shape[0]);
  for (std::size_t i = 0; i < out.size(); ++i)
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) out[i].map.linear[c][r] = m.data[12 * i + 4 * r + c];
      out[i].map.translation[r] = m.data[12 * i + 4 * r + 3];
    }
  return out;
}

class Places {
 public:
  explicit Places(std::vector<Placement> all_places) : all(std::move(all_places)) {}
  std::vector<Placement> all;
};

/// Rows of organs by the order in which their ids come first.
py::tuple organ_rows(const py::object& organ) {
  const auto ids = values<std::int64_t>(organ, "organ", {-1});
  auto rows = std::make_shared<std::vector<std::int64_t>>(ids.shape[0]);
  auto first = std::make_shared<std::vector<std::int64_t>>();
  std::unordered_map<std::int64_t, std::int64_t> row;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const auto [at, fresh] = row.try_emplace(ids.data[i], static_cast<std::int64_t>(row.size()));
    if (fresh) first->push_back(ids.data[i]);
    (*rows)[i] = at->second;
  }
  return py::make_tuple(view(*rows, {rows->size()}, rows), view(*first, {first->size()}, first));
}

/// All facets of a plant file: corners (n, 3, 3), the organ of each, and of each organ its name, type, material and attribute "label".
py::tuple plant_arrays(const std::string& file) {
  const Plant plant = read_plant(file, 1.0);
  check_plant(plant);
  auto corners = std::make_shared<std::vector<double>>();
  auto owner = std::make_shared<std::vector<std::int64_t>>();
  std::unordered_map<std::uint32_t, std::int64_t> row;
  py::list organs;
  for (const auto& shape : plant.shapes) {
    const auto [at, fresh] = row.try_emplace(shape.structure, static_cast<std::int64_t>(row.size()));
    if (fresh) {
      const auto* label = plant.attribute(shape.structure, "label");
      const auto* text = label ? std::get_if<std::string>(label) : nullptr;
      const auto& structure = plant.structures[shape.structure];
      organs.append(py::make_tuple(structure.name, plant.types[structure.type], plant.materials[shape.material], text ? *text : ""));
    }
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) {
      for (const auto& p : shape_triangle(plant, shape, t)) corners->insert(corners->end(), {p.x, p.y, p.z});
      owner->push_back(at->second);
    }
  }
  return py::make_tuple(view(*corners, {owner->size(), 3, 3}, corners), view(*owner, {owner->size()}, owner), organs);
}

std::optional<Mesh> mesh_if_any(const py::object& points, const py::object& indices, const char* name) {
  if (points.is_none()) return std::nullopt;
  return mesh_from(points, indices, name);
}

const Mesh* pointer(const std::optional<Mesh>& mesh) {
  return mesh ? &*mesh : nullptr;
}

}  // namespace

SceneInMemory::SceneInMemory(std::vector<std::string> bands, const std::vector<std::string>& units) {
  if (bands.empty()) throw py::value_error("bands: found none; expected at least one name");
  for (std::size_t b = 0; b < bands.size(); ++b)
    if (bands[b].empty() || std::count(bands.begin(), bands.end(), bands[b]) > 1)
      throw py::value_error(
          fmt::format("bands[{}]: found \"{}\"{}; expected names, each once", b, bands[b], bands[b].empty() ? "" : " twice"));
  for (std::size_t b = 0; b < units.size(); ++b) {
    if (holds(watts, units[b])) {
      scene.band_units.push_back(watts.front());
    } else if (holds(photons, units[b])) {
      scene.band_units.push_back(photons.front());
    } else {
      throw py::value_error(fmt::format("units[\"{}\"]: found \"{}\"; expected \"W m^-2\" or \"umol m^-2 s^-1\"",
                                        b < bands.size() ? bands[b] : "", units[b]));
    }
  }
  scene.bands = std::move(bands);
}

SceneInMemory::SceneInMemory(const std::string& file) {
  auto read = read_scene_file(file);
  scene = std::move(read.scene);
  run = std::move(read.run);
}

std::shared_ptr<const Scene> SceneInMemory::frozen() const {
  auto out = std::make_shared<Scene>(scene);
  if (out->states.empty() && (!lamps.empty() || !out->lamps.empty())) out->states.emplace_back();
  for (const auto& lamp : lamps) add_lamp(*out, lamp.text, pointer(lamp.mesh));
  if (out->plants.empty() && out->groups.empty() && !out->ground && out->sensors.empty())
    throw py::value_error("scene: found no plant, ground or sensor; expected at least one");
  return out;
}

void bind_scene(py::module_& m) {
  m.def("organ_rows", &organ_rows, py::arg("organ"));
  m.def(
      "read_opt",
      [](const std::string& file) {
        const CaribuOptics opt = read_opt(file);
        std::vector<std::array<double, 5>> species;
        for (const auto& s : opt.species)
          species.push_back({s.stem, s.upper_reflectance, s.upper_transmittance, s.lower_reflectance, s.lower_transmittance});
        return std::make_pair(opt.soil, species);
      },
      py::arg("file"));
  m.def(
      "read_light_file",
      [](const std::string& file) {
        std::vector<std::pair<double, std::array<double, 3>>> out;
        for (const auto& d : read_light_file(file))
          out.emplace_back(d.irradiance, std::array<double, 3>{d.towards.x, d.towards.y, d.towards.z});
        return out;
      },
      py::arg("file"));
  m.def("read_pattern_file", &read_pattern_file, py::arg("file"));
  m.def("read_plant", &plant_arrays, py::arg("file"));
  py::class_<Places>(m, "Places").def("__len__", [](const Places& p) { return p.all.size(); });
  m.def(
      "stances",
      [](const py::object& position, const py::object& turn, const py::object& scale, const py::object& tilt,
         const py::object& tilt_azimuth, bool mirror) { return Places(stances(position, turn, scale, tilt, tilt_azimuth, mirror)); },
      py::arg("position"), py::arg("turn"), py::arg("scale"), py::arg("tilt"), py::arg("tilt_azimuth"), py::arg("mirror"));
  m.def(
      "affines", [](const py::object& maps) { return Places(affines(maps)); }, py::arg("maps"));

  py::class_<SceneInMemory>(m, "Scene")
      .def(py::init<std::vector<std::string>, const std::vector<std::string>&>(), py::arg("bands"), py::arg("units"))
      .def(py::init<const std::string&>(), py::arg("file"))
      .def_property_readonly("bands", [](const SceneInMemory& s) { return s.scene.bands; })
      .def_property_readonly("units", [](const SceneInMemory& s) { return s.scene.band_units; })
      .def_property_readonly("notes", [](const SceneInMemory& s) { return s.scene.notes; })
      .def_property_readonly("states",
                             [](const SceneInMemory& s) {
                               std::vector<std::pair<std::string, double>> out;
                               for (const auto& state : s.scene.states) out.emplace_back(state.name, state.duration_s);
                               return out;
                             })
      .def_property_readonly("optics_names",
                             [](const SceneInMemory& s) {
                               std::vector<std::string> out;
                               for (const auto& o : s.scene.optics) out.push_back(o.name);
                               return out;
                             })
      .def_property_readonly("plant_names",
                             [](const SceneInMemory& s) {
                               std::vector<std::string> out;
                               for (const auto& o : s.scene.plants) out.push_back(o.name);
                               return out;
                             })
      .def_property_readonly("group_names",
                             [](const SceneInMemory& s) {
                               std::vector<std::string> out;
                               for (const auto& o : s.scene.groups) out.push_back(o.name);
                               return out;
                             })
      .def_property(
          "periodic",
          [](const SceneInMemory& s) -> std::optional<std::array<double, 4>> {
            if (!s.scene.periodic) return std::nullopt;
            const auto& p = *s.scene.periodic;
            return std::array<double, 4>{p.x_low, p.y_low, p.x_high, p.y_high};
          },
          [](SceneInMemory& s, const std::optional<std::array<double, 4>>& cell) {
            if (!cell) {
              s.scene.periodic.reset();
              return;
            }
            const auto& c = *cell;
            if (!(std::isfinite(c[0] + c[1] + c[2] + c[3]) && c[2] > c[0] && c[3] > c[1]))
              throw py::value_error(
                  fmt::format("periodic: found ({}, {}, {}, {}); expected xmin, ymin, xmax, ymax [m], xmax above xmin and ymax above ymin",
                              c[0], c[1], c[2], c[3]));
            const double slope[2] = {s.scene.periodic ? s.scene.periodic->slope_x : 0.0,
                                     s.scene.periodic ? s.scene.periodic->slope_y : 0.0};
            s.scene.periodic = PeriodicCell{c[0], c[1], c[2], c[3], slope[0], slope[1]};
          })
      .def_property(
          "slope",
          [](const SceneInMemory& s) {
            const PeriodicCell cell = s.scene.periodic.value_or(PeriodicCell{});
            return std::make_tuple(cell.slope_x, cell.slope_y);
          },
          [](SceneInMemory& s, const std::array<double, 2>& rise) {
            if (!(std::hypot(rise[0], rise[1]) <= steepest_slope))
              throw py::value_error(fmt::format("slope: found ({}, {}); expected dz/dx and dz/dy of a slope of at most {:g}", rise[0],
                                                rise[1], steepest_slope));
            if (!s.scene.periodic)
              throw py::value_error("slope: found no periodic cell; expected periodic before, which repeats along the slope");
            s.scene.periodic->slope_x = rise[0], s.scene.periodic->slope_y = rise[1];
          })
      .def(
          "light", [](SceneInMemory& s, const std::string& text) { return replace_light(s.scene, text); }, py::arg("text"))
      .def("no_light", [](SceneInMemory& s) { s.scene.states.clear(); })
      .def(
          "optics", [](SceneInMemory& s, const std::string& text, bool replace) { return add_optics(s.scene, text, replace); },
          py::arg("text"), py::arg("replace"))
      .def(
          "ground",
          [](SceneInMemory& s, const std::string& text, const py::object& points, const py::object& indices) {
            const auto mesh = mesh_if_any(points, indices, "ground");
            return replace_ground(s.scene, text, pointer(mesh));
          },
          py::arg("text"), py::arg("points"), py::arg("indices"))
      .def("no_ground", [](SceneInMemory& s) { s.scene.ground.reset(); })
      .def(
          "lamp",
          [](SceneInMemory& s, const std::string& text, const py::object& points, const py::object& indices) {
            SceneInMemory::Lamp lamp{text, mesh_if_any(points, indices, "lamp")};
            Scene trial = s.scene;
            for (const auto& other : s.lamps) add_lamp(trial, other.text, pointer(other.mesh));
            auto notes = add_lamp(trial, text, pointer(lamp.mesh));
            s.lamps.push_back(std::move(lamp));
            return notes;
          },
          py::arg("text"), py::arg("points"), py::arg("indices"))
      .def(
          "sensor",
          [](SceneInMemory& s, const std::string& text, const py::object& points, const py::object& indices) {
            const auto mesh = mesh_if_any(points, indices, "sensor");
            return add_sensor(s.scene, text, pointer(mesh));
          },
          py::arg("text"), py::arg("points"), py::arg("indices"))
      .def("plant_arrays", &add_arrays, py::arg("name"), py::arg("points"), py::arg("indices"), py::arg("owner"), py::arg("parents"),
           py::arg("types"), py::arg("names"), py::arg("optics"), py::arg("attributes"), py::arg("policy"))
      .def(
          "plant_file", [](SceneInMemory& s, const std::string& text) { return add_plant(s.scene, text); }, py::arg("text"))
      .def(
          "replace_plant",
          [](SceneInMemory& s, std::size_t row) {  // the last one takes the place of an earlier, whose places it gets
            auto entry = std::move(s.scene.plants.back());
            s.scene.plants.pop_back();
            auto& old = s.scene.plants.at(row);
            entry.placements = std::move(old.placements);
            entry.name = old.name;
            old = std::move(entry);
          },
          py::arg("row"))
      .def(
          "group",
          [](SceneInMemory& s, const std::string& name) {
            refuse_taken(s.scene, name, "group");
            s.scene.groups.emplace_back();
            s.scene.groups.back().name = name;
            return s.scene.groups.size() - 1;
          },
          py::arg("name"))
      .def(
          "places", [](const SceneInMemory& s, const std::string& text) { return Places(read_places(s.scene, text)); }, py::arg("text"))
      .def(
          "place",
          [](SceneInMemory& s, bool is_group, std::size_t row, const Places& places) {
            auto& all = is_group ? s.scene.groups.at(row).placements : s.scene.plants.at(row).placements;
            all.insert(all.end(), places.all.begin(), places.all.end());
          },
          py::arg("is_group"), py::arg("row"), py::arg("places"))
      .def(
          "clear_places",
          [](SceneInMemory& s, bool is_group, std::size_t row) {
            (is_group ? s.scene.groups.at(row).placements : s.scene.plants.at(row).placements).clear();
          },
          py::arg("is_group"), py::arg("row"))
      .def(
          "place_in",
          [](SceneInMemory& s, std::size_t group, bool is_group, std::size_t row, const Places& places) {
            for (const auto& p : places.all) s.scene.groups.at(group).members.push_back({is_group, static_cast<std::uint32_t>(row), p});
          },
          py::arg("group"), py::arg("is_group"), py::arg("row"), py::arg("places"))
      .def_property_readonly("unplaced", [](const SceneInMemory& s) {
        std::vector<bool> plant(s.scene.plants.size()), group(s.scene.groups.size());
        for (const auto& g : s.scene.groups)
          for (const auto& member : g.members) (member.is_group ? group : plant)[member.index] = true;
        std::vector<std::string> out;
        for (std::size_t p = 0; p < plant.size(); ++p)
          if (!plant[p] && s.scene.plants[p].placements.empty()) out.push_back(s.scene.plants[p].name);
        for (std::size_t g = 0; g < group.size(); ++g)
          if (!group[g] && s.scene.groups[g].placements.empty()) out.push_back(s.scene.groups[g].name);
        return out;
      });
}

}  // namespace sunfleck::python
