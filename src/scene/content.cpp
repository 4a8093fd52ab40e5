#include <sunfleck/scene/content.hpp>

#include <map>
#include <variant>

#include <sunfleck/core/sha256.hpp>

namespace sunfleck {

namespace {

void put_mesh(ContentKey& key, const Mesh& mesh) {
  key.put(mesh.vertices);
  key.put(static_cast<std::uint64_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles)
    for (const auto i : t) key.put(i);
}

void put_placements(ContentKey& key, const std::vector<Placement>& placements) {
  key.put(static_cast<std::uint64_t>(placements.size()));
  for (const auto& p : placements) key.put(p.map);
}

template <class T>
void put_optional(ContentKey& key, const std::optional<T>& value, const auto& put) {
  key.put(value.has_value());
  if (value) put(*value);
}

void put_pair(ContentKey& key, const std::array<double, 2>& pair) {
  key.put(pair[0]), key.put(pair[1]);
}

void put_ground(ContentKey& key, const Ground& ground) {
  put_optics(key, ground.optics);
  put_optional(key, ground.mesh, [&](const Mesh& mesh) { put_mesh(key, mesh); });
  if (ground.mesh) return;
  put_pair(key, ground.size), put_pair(key, ground.centre);
  key.put(ground.cells[0]), key.put(ground.cells[1]), key.put(ground.height);
}

void put_sensor(ContentKey& key, const SensorEntry& sensor) {
  const auto pair = [&](const std::optional<std::array<double, 2>>& p) { put_optional(key, p, [&](const auto& v) { put_pair(key, v); }); };
  const auto number = [&](const std::optional<double>& v) { put_optional(key, v, [&](double x) { key.put(x); }); };
  key.put(sensor.name), key.put(sensor.both_sides), key.put(sensor.samples);
  key.put(static_cast<std::uint64_t>(sensor.shape.index()));
  if (const auto* grid = std::get_if<SensorGrid>(&sensor.shape)) {
    key.put(grid->z), key.put(grid->cells[0]), key.put(grid->cells[1]);
    pair(grid->size), pair(grid->centre);
  } else if (const auto* profile = std::get_if<SensorProfile>(&sensor.shape)) {
    key.put(profile->step), number(profile->low), number(profile->high);
    pair(profile->size), pair(profile->centre);
  } else {
    put_mesh(key, std::get<Mesh>(sensor.shape));
  }
}

void put_geometry(ContentKey& key, const Scene& scene) {
  key.put(static_cast<std::uint64_t>(scene.band_count()));
  put_optional(key, scene.periodic, [&](const PeriodicCell& c) {
    key.put(c.x_low), key.put(c.y_low), key.put(c.x_high), key.put(c.y_high), key.put(c.slope_x), key.put(c.slope_y);
  });
  key.put(static_cast<std::uint64_t>(scene.optics.size()));
  for (const auto& o : scene.optics) put_optics(key, o);
  put_optional(key, scene.ground, [&](const Ground& g) { put_ground(key, g); });
  key.put(static_cast<std::uint64_t>(scene.plants.size()));
  std::map<const Plant*, std::string> known;  // entries often share one
  for (const auto& entry : scene.plants) {
    auto& plant = known[entry.plant.get()];
    if (plant.empty()) {
      ContentKey of_plant("plant");
      put_plant(of_plant, *entry.plant);
      plant = of_plant.hex();
    }
    key.put(plant), key.put(entry.shape_optics), key.put(entry.policy_file);
    put_placements(key, entry.placements);
  }
  key.put(static_cast<std::uint64_t>(scene.groups.size()));
  for (const auto& group : scene.groups) {
    key.put(static_cast<std::uint64_t>(group.members.size()));
    for (const auto& m : group.members) key.put(m.is_group), key.put(m.index), key.put(m.placement.map);
    put_placements(key, group.placements);
  }
  key.put(static_cast<std::uint64_t>(scene.lamps.size()));
  for (const auto& lamp : scene.lamps) put_mesh(key, lamp.mesh), put_placements(key, lamp.placements);
  key.put(static_cast<std::uint64_t>(scene.sensors.size()));
  for (const auto& s : scene.sensors) put_sensor(key, s);
}

void put_sky(ContentKey& key, const Sky& sky) {
  key.put(sky.model), key.put(sky.irradiance);
  put_optional(key, sky.sun, [&](const Vec3& d) { key.put(d); });
  key.put(sky.table != nullptr);
  if (sky.table) key.put(sky.table->directions()), key.put(sky.table->radiances());
  put_optional(key, sky.weather, [&](const PerezWeather& w) { key.put(w.clearness), key.put(w.brightness); });
  key.put(sky.horizon);
  key.put(sky.image != nullptr);
  if (sky.image) {
    const auto& picture = sky.image->picture();
    key.put(picture.columns), key.put(picture.turn_deg), key.put(picture.value);
  }
}

void put_photometry(ContentKey& key, const Photometry& p) {
  key.put(p.vertical_deg), key.put(p.horizontal_deg), key.put(p.candela);
  key.put(p.length_m), key.put(p.width_m), key.put(p.round);
}

}  // namespace

void ContentKey::append(const void* bytes, std::size_t count) {
  constexpr std::size_t longest = std::size_t{1} << 20;
  piece_.append(static_cast<const char*>(bytes), count);
  if (piece_.size() > longest) piece_ = sha256_hex(piece_);
}

std::string ContentKey::hex() const {
  return sha256_hex(piece_);
}

void put_plant(ContentKey& key, const Plant& plant) {
  key.put(static_cast<std::uint64_t>(plant.structures.size()));
  for (const auto& s : plant.structures) key.put(s.parent), key.put(s.type);
  key.put(plant.types);
  key.put(static_cast<std::uint64_t>(plant.meshes.size()));
  for (const auto& m : plant.meshes) put_mesh(key, m);
  key.put(static_cast<std::uint64_t>(plant.shapes.size()));
  for (const auto& s : plant.shapes) {
    key.put(s.structure), key.put(s.mesh), key.put(s.first_triangle), key.put(s.triangle_count);
    key.put(s.placement);
  }
}

void put_optics(ContentKey& key, const Optics& optics) {
  key.put(optics.reflectance_front), key.put(optics.reflectance_back), key.put(optics.transmittance);
}

std::string geometry_key(const Scene& scene) {
  ContentKey key("geometry");
  put_geometry(key, scene);
  return key.hex();
}

std::string scene_key(const Scene& scene, const std::string& geometry) {
  ContentKey key("scene");
  key.put(geometry);
  key.put(scene.bands), key.put(scene.band_units);
  key.put(static_cast<std::uint64_t>(scene.states.size()));
  for (const auto& state : scene.states) {
    key.put(state.name), key.put(state.duration_s);
    put_optional(key, state.sun,
                 [&](const Sun& sun) { key.put(sun.direction), key.put(sun.irradiance), key.put(sun.angular_diameter_deg); });
    put_optional(key, state.sky, [&](const Sky& sky) { put_sky(key, sky); });
  }
  for (const auto& lamp : scene.lamps) {
    key.put(lamp.by_power), key.put(lamp.strength), key.put(lamp.states);
    key.put(lamp.photometry != nullptr);
    if (lamp.photometry) put_photometry(key, *lamp.photometry);
  }
  for (const auto& o : scene.optics) key.put(o.name), key.put(o.counts_as_leaf);
  for (const auto& p : scene.plants) key.put(p.name);
  for (const auto& g : scene.groups) key.put(g.name);
  return key.hex();
}

}  // namespace sunfleck
