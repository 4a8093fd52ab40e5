#include "result/describe_scene.hpp"

#include <map>
#include <set>

#include "result/band_units.hpp"

namespace sunfleck::h5 {

void write_light_and_optics(OutputFile& file, ArrayWriter& arrays, const Scene& scene, const std::vector<Optics>& materials) {
  const std::size_t bands = scene.band_count(), states = scene.states.size();
  const Id bands_group = make_group(file, file.id(), "bands");
  arrays.write_strings(bands_group.get(), "name", scene.bands);
  auto units = scene.band_units;
  units.resize(bands, "W m^-2");
  arrays.write_strings(bands_group.get(), "unit", units);

  std::vector<std::string> names, sky_models;
  std::vector<double> duration, sun_direction, sun_irradiance, sun_diameter, sky_irradiance;
  std::vector<std::uint8_t> sun_present, sky_present;
  const auto add_bands = [&](std::vector<double>& out, const std::vector<double>* values) {
    for (std::size_t b = 0; b < bands; ++b) out.push_back(values ? values->at(b) : 0.0);
  };
  for (const auto& state : scene.states) {
    names.push_back(state.name);
    duration.push_back(state.duration_s);
    sun_present.push_back(state.sun.has_value());
    const Vec3 d = state.sun ? state.sun->direction : Vec3{0.0};
    sun_direction.insert(sun_direction.end(), {d.x, d.y, d.z});
    sun_diameter.push_back(state.sun ? state.sun->angular_diameter_deg : 0.0);
    add_bands(sun_irradiance, state.sun ? &state.sun->irradiance : nullptr);
    sky_present.push_back(state.sky.has_value());
    sky_models.push_back(state.sky ? name_of(state.sky->model) : "");
    add_bands(sky_irradiance, state.sky ? &state.sky->irradiance : nullptr);
  }
  const Id group = make_group(file, file.id(), "states");
  arrays.write_strings(group.get(), "name", names);
  arrays.write(group.get(), "duration", duration, "s");
  arrays.write(group.get(), "sun_present", sun_present, "1");
  arrays.write(group.get(), "sun_direction", sun_direction.data(), {states, 3}, "1");
  arrays.write(group.get(), "sun_irradiance", sun_irradiance.data(), {states, bands}, irradiance_unit(scene));
  arrays.write(group.get(), "sun_angular_diameter", sun_diameter, "degree");
  arrays.write(group.get(), "sky_present", sky_present, "1");
  arrays.write_strings(group.get(), "sky_model", sky_models);
  arrays.write(group.get(), "sky_irradiance", sky_irradiance.data(), {states, bands}, irradiance_unit(scene));

  std::vector<std::string> material_names;
  std::vector<float> front, back, transmittance;
  for (const auto& m : materials) {
    material_names.push_back(m.name);
    front.insert(front.end(), m.reflectance_front.begin(), m.reflectance_front.end());
    back.insert(back.end(), m.reflectance_back.begin(), m.reflectance_back.end());
    transmittance.insert(transmittance.end(), m.transmittance.begin(), m.transmittance.end());
  }
  // Which materials the organs of a type have: pairs, since a type may have several.
  std::set<std::pair<std::string, std::uint32_t>> pairs;
  for (const auto& entry : scene.plants)
    for (std::size_t i = 0; i < entry.plant->shapes.size(); ++i) {
      const auto& structure = entry.plant->structures[entry.plant->shapes[i].structure];
      pairs.emplace(entry.plant->types[structure.type], entry.shape_optics[i]);
    }
  if (scene.ground) pairs.emplace("ground", static_cast<std::uint32_t>(materials.size() - 1));
  std::vector<std::string> type;
  std::vector<std::uint32_t> type_material;
  for (const auto& [t, m] : pairs) {
    type.push_back(t);
    type_material.push_back(m);
  }
  const Id optics = make_group(file, file.id(), "optics");
  arrays.write_strings(optics.get(), "name", material_names);
  arrays.write(optics.get(), "reflectance_front", front.data(), {materials.size(), bands}, "1");
  arrays.write(optics.get(), "reflectance_back", back.data(), {materials.size(), bands}, "1");
  arrays.write(optics.get(), "transmittance", transmittance.data(), {materials.size(), bands}, "1");
  arrays.write_strings(optics.get(), "organ_type", type);
  arrays.write(optics.get(), "organ_type_material", type_material, "row of /optics/name");
  arrays.flush();
}

void write_names(OutputFile& file, ArrayWriter& arrays, const OrganNames& names, std::vector<std::string> placements) {
  const Id group = make_group(file, file.id(), "names");
  arrays.write_strings(group.get(), "organ", names.names);
  arrays.write_strings(group.get(), "type", names.types);
  arrays.write_strings(group.get(), "plant", names.plants);
  if (!names.ground.name.empty()) placements.push_back("ground");
  arrays.write_strings(group.get(), "placement", placements);
  arrays.flush();
}

}  // namespace sunfleck::h5
