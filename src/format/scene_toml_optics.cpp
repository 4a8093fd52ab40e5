// [optics.NAME] and [ground].
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/scene/build.hpp>

#include <format/scene_toml_parts.hpp>

namespace sunfleck {

namespace {

double fraction(const TomlValue& value) {
  return value.number(0, 1);
}

std::vector<float> floats(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

void read_ground_plane(const TomlValue& table, const Scene& scene, Ground& ground) {
  if (const auto size = table.get("size")) {
    const auto v = size->numbers(2, "width along x, depth along y [m]");
    if (!(v[0] > 0 && v[1] > 0)) size->fail(fmt::format("[{}, {}]", v[0], v[1]), "two lengths above zero [m]");
    ground.size = {v[0], v[1]};
  } else if (scene.periodic) {
    ground.size = {scene.periodic->width(), scene.periodic->depth()};
  } else {
    throw InputError(table.where("size"), "nothing", "[width, depth] of the ground [m]");
  }
  if (scene.periodic)
    ground.centre = {0.5 * (scene.periodic->x_low + scene.periodic->x_high), 0.5 * (scene.periodic->y_low + scene.periodic->y_high)};
  if (const auto centre = table.get("center")) {
    const auto v = centre->numbers(2, "x, y [m]");
    ground.centre = {v[0], v[1]};
  }
  ground.cells = {10, 10};
  if (const auto cells = table.get("cells")) {
    const auto items = cells->is_array() ? cells->items() : std::vector<TomlValue>{};
    if (items.size() != 2) cells->fail("an array of 2 whole numbers: cells along x, cells along y");
    for (std::size_t i = 0; i < 2; ++i) ground.cells[i] = static_cast<std::uint32_t>(items[i].integer(1, 30000));
  }
  if (const auto height = table.get("height")) ground.height = height->number();
}

}  // namespace

Mesh read_flat_mesh(const std::string& file, double unit_m, std::vector<std::string>& notes) {
  const Plant plant = read_plant(file, unit_m);
  notes.insert(notes.end(), plant.notes.begin(), plant.notes.end());
  check_plant(plant);
  Mesh mesh;
  for (const auto& shape : plant.shapes)
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const auto& corner : shape_triangle(plant, shape, t)) mesh.vertices.push_back(corner);
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  return mesh;
}

TomlSchema optics_schema(const TomlSchema& per_band) {
  return TomlSchema::of(
      {"counts_as"},
      {{"reflectance", per_band}, {"reflectance_front", per_band}, {"reflectance_back", per_band}, {"transmittance", per_band}});
}

TomlSchema ground_schema(const TomlSchema& per_band) {
  return TomlSchema::of({"size", "center", "cells", "height", "mesh", "unit"}, {{"reflectance", per_band}});
}

void read_optics(const TomlValue& root, Scene& scene) {
  const auto all = root.get("optics");
  if (!all) return;
  for (const auto& [name, table] : all->members()) {
    Optics optics;
    optics.name = name;
    const auto both = table.get("reflectance"), front = table.get("reflectance_front"), back = table.get("reflectance_back");
    if (both && (front || back))
      (front ? front : back)
          ->fail("a value beside `reflectance`", "either `reflectance`, or both of `reflectance_front` and `reflectance_back`");
    if (both) {
      optics.reflectance_front = optics.reflectance_back = floats(read_per_band(*both, scene, fraction));
    } else {
      if (!front && !back)
        throw InputError(table.where("reflectance"), "nothing", "a reflectance per band, or `reflectance_front` and `reflectance_back`");
      optics.reflectance_front =
          floats(read_per_band(table.need("reflectance_front", "a reflectance per band, as `reflectance_back` is given"), scene, fraction));
      optics.reflectance_back =
          floats(read_per_band(table.need("reflectance_back", "a reflectance per band, as `reflectance_front` is given"), scene, fraction));
    }
    const auto transmittance = table.get("transmittance");
    optics.transmittance =
        transmittance ? floats(read_per_band(*transmittance, scene, fraction)) : std::vector<float>(scene.bands.size(), 0.0f);
    for (std::size_t b = 0; b < scene.bands.size(); ++b)
      for (const auto* rho : {&optics.reflectance_front, &optics.reflectance_back}) {
        const float sum = (*rho)[b] + optics.transmittance[b];
        if (sum <= 1.0f + 1e-6f) continue;
        const bool is_front = rho == &optics.reflectance_front;
        const auto at = both ? *both : is_front ? *front : *back;
        throw InputError(at.where(scene.bands[b]),
                         fmt::format("reflectance {} + transmittance {} = {:.6g}", (*rho)[b], optics.transmittance[b], sum),
                         "a sum of at most 1");
      }
    if (const auto counts_as = table.get("counts_as")) {
      const auto what = counts_as->text();
      if (what != "leaf" && what != "other") counts_as->fail("\"" + what + "\"", "\"leaf\" or \"other\"");
      optics.counts_as_leaf = what == "leaf";
    }
    scene.optics.push_back(std::move(optics));
  }
}

void read_ground(const TomlValue& root, Scene& scene, const Mesh* given) {
  const auto table = root.get("ground");
  if (!table) return;
  Ground ground;
  if (const auto mesh = table->get("mesh"); mesh || given) {
    for (const char* key : {"size", "center", "cells", "height"})
      if (const auto value = table->get(key)) value->fail(fmt::format("`{}` beside `mesh`", key), "one of them: the mesh has its own");
    ground.mesh = given ? *given : read_flat_mesh(read_path(*mesh, scene, "a mesh file"), read_unit(*table), scene.notes);
  } else {
    if (const auto unit = table->get("unit")) unit->fail("`unit` without `mesh`", "no unit: lengths of the scene are metres");
    read_ground_plane(*table, scene, ground);
  }
  if (scene.periodic) check_ground_fills(ground, *scene.periodic, (table->get("mesh") ? *table->get("mesh") : *table).where());
  ground.optics.name = "ground";
  const auto reflectance = table->need("reflectance", "a reflectance per band");
  ground.optics.reflectance_front = ground.optics.reflectance_back = floats(read_per_band(reflectance, scene, fraction));
  ground.optics.transmittance.assign(scene.bands.size(), 0.0f);
  scene.ground = std::move(ground);
}

}  // namespace sunfleck
