// [sun], [sky], [global] and [[state]].
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/light/split.hpp>
#include <sunfleck/light/time.hpp>

#include <format/scene_toml_parts.hpp>

namespace sunfleck {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

double irradiance_value(const TomlValue& value) {
  return value.up_to(brightest);
}

/// Where the sun stands, also below the horizon.
struct SunPosition {
  Vec3 direction;
  int day_of_year = 0;  ///< 0 = the scene gives no date
};

SunPosition read_sun_position(const TomlValue& sun) {
  const auto direction = sun.get("direction"), elevation = sun.get("elevation"), azimuth = sun.get("azimuth"),
             latitude = sun.get("latitude"), longitude = sun.get("longitude"), time = sun.get("time"), altitude = sun.get("altitude");
  const std::string ways = "one of: `direction`; `elevation` and `azimuth`; `latitude`, `longitude` and `time`";
  const bool by_direction = direction.has_value(), by_angles = elevation || azimuth, by_time = latitude || longitude || time || altitude;
  if (by_direction + by_angles + by_time != 1)
    throw InputError(sun.where(), by_direction + by_angles + by_time == 0 ? "no position of the sun" : "several positions of the sun",
                     ways);
  if (by_direction) {
    const auto v = direction->numbers(3, "x (east), y (north), z (up), towards the sun");
    const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (largest == 0) direction->fail("[0, 0, 0]", "a vector towards the sun that is not zero");
    return {glm::normalize(Vec3{v[0] / largest, v[1] / largest, v[2] / largest}), 0};
  }
  if (by_angles) {
    const double e = sun.need("elevation", "the sun's angle above the horizon [degrees], as `azimuth` is given").number(-90, 90, "degrees");
    const double a =
        sun.need("azimuth", "the sun's angle from north over east [degrees], as `elevation` is given").number(-360, 360, "degrees");
    return {direction_from_angles(e, a), 0};
  }
  const std::string needed = "all of `latitude`, `longitude` and `time`";
  const double north = sun.need("latitude", needed).number(-90, 90, "degrees"),
               east = sun.need("longitude", needed).number(-180, 360, "degrees");
  const auto when = sun.need("time", needed);
  const double height = altitude ? altitude->number(-500, 9000, "metres") : 0.0;
  const SolarPosition position = solar_position(when.date_time(), north, east, height, when.where());
  return {direction_from_angles(position.elevation_deg, position.azimuth_deg), parse_time(when.date_time(), when.where()).day_of_year};
}

/// Irradiance of sun and sky per band, where the scene gives global radiation alone.
struct Shares {
  std::vector<double> beam, sky;
  std::array<double, 2> shortwave{};  ///< beam and sky of all wavelengths [W m^-2]
};

Shares split(const TomlValue& global, const SunPosition& sun, Scene& scene) {
  const auto per_band =
      read_per_band(global.need("irradiance", "the global irradiance per band, on a horizontal plane"), scene, irradiance_value);
  double shortwave = 0;
  if (const auto given = global.get("shortwave")) {
    shortwave = given->up_to(brightest, "W m^-2");
  } else {
    for (std::size_t b = 0; b < per_band.size(); ++b) {
      if (scene.band_units[b] != "W m^-2")
        throw InputError(global.where("shortwave"), "nothing",
                         "the global radiation of all wavelengths [W m^-2], as band \"" + scene.bands[b] + "\" counts photons");
      shortwave += per_band[b];
    }
    scene.notes.push_back(
        fmt::format("{}: no `shortwave`: the bands' sum, {:.6g} W m^-2, is taken as the global radiation of all wavelengths",
                    global.where(), shortwave));
  }
  int day = sun.day_of_year;
  if (const auto given = global.get("day")) {
    if (day > 0) given->fail("`day` beside the sun's `time`", "one date");
    day = static_cast<int>(given->integer(1, 366));
  } else if (day == 0) {
    throw InputError(global.where("day"), "nothing", "the day of the year from 1 to 366, or a sun with `time`");
  }
  const double elevation = std::asin(std::clamp(sun.direction.z, -1.0, 1.0)) / degree;
  const GlobalSplit shares = split_global(shortwave, elevation, day, global.where().c_str());
  Shares out;
  const auto beam = [&](double e) { return shares.direct > 0 ? e * shares.direct / sun.direction.z : 0.0; };
  for (const double e : per_band) {
    out.beam.push_back(beam(e));
    out.sky.push_back(e * shares.diffuse);
  }
  out.shortwave = {beam(shortwave), shortwave * shares.diffuse};
  return out;
}

/// Keys of a sky that only some models have.
void check_sky_keys(const TomlValue& table, const std::string& model) {
  const std::vector<std::pair<std::string, std::vector<const char*>>> keys = {
      {"file", {"file", "directions"}},
      {"image", {"file", "turn", "sun", "encoding"}},
      {"perez", {"clearness", "brightness", "direct", "diffuse", "day"}}};
  const auto has = [](const std::vector<const char*>& names, const std::string& key) {
    return std::find(names.begin(), names.end(), key) != names.end();
  };
  for (const auto& [of_model, names] : keys)
    for (const char* key : names) {
      const auto value = table.get(key);
      if (!value || std::any_of(keys.begin(), keys.end(), [&](const auto& k) { return k.first == model && has(k.second, key); })) continue;
      value->fail(fmt::format("`{}` beside model = \"{}\"", key, model), fmt::format("model = \"{}\"", of_model));
    }
}

/// Sky, and sun if the sky is a picture with one, of a state. Neither where they give no light, so that a night may keep the day's model.
void read_sky(const TomlValue& table, Scene& scene, const StateAround& around, const std::optional<Shares>& shares, LightState& state) {
  Sky sky;
  const auto model = table.need("model", "one of " + joined(sky_model_names()));
  sky.model = *sky_model_from_name(model.one_of(sky_model_names()));
  check_sky_keys(table, name_of(sky.model));
  if (sky.model == SkyModel::file) sky.table = read_sky_table(table, scene);
  if (shares) {
    if (const auto irradiance = table.get("irradiance"))
      irradiance->fail("`irradiance` beside `global`", "one of them: `global` is split into sun and sky");
    sky.irradiance = shares->sky;
  } else {
    sky.irradiance =
        read_per_band(table.need("irradiance", "the irradiance per band, on an unobstructed horizontal plane"), scene, irradiance_value);
  }
  if (std::all_of(sky.irradiance.begin(), sky.irradiance.end(), [](double e) { return e == 0; })) return;
  if (around.sun && sky.needs_sun()) sky.sun = around.sun;
  if (sky.model == SkyModel::perez) sky.weather = read_perez_weather(table, scene, around, sky.irradiance);
  if (sky.model == SkyModel::image) {
    PicturedSky pictured = read_sky_picture(table, scene, around.sun.has_value());
    if (const auto& of_picture = pictured.sun) {
      Sun sun{of_picture->direction, {}};
      for (auto& e : sky.irradiance) {
        sun.irradiance.push_back(e * of_picture->horizontal_share / sun.direction.z);
        e *= 1.0 - of_picture->horizontal_share;
      }
      state.sun = std::move(sun);
    }
    sky.image = std::move(pictured.image);
    if (!sky.image) return;
  }
  prepare_sky(sky, model.where());
  state.sky = std::move(sky);
}

/// `owner` holds sun, sky and global: the scene itself or one [[state]].
LightState read_state(const TomlValue& owner, Scene& scene) {
  LightState state;
  const auto sun_table = owner.get("sun"), sky_table = owner.get("sky"), global = owner.get("global");
  std::optional<SunPosition> position;
  std::optional<Shares> shares;
  StateAround around;
  double diameter = Sun{}.angular_diameter_deg;
  if (sun_table) {
    position = read_sun_position(*sun_table);
    if (const auto given = sun_table->get("angular_diameter")) diameter = given->number(0, 90, "degrees");
  }
  if (global) {
    if (!sun_table || !sky_table)
      global->fail("`global` without " + std::string(sun_table ? "`sky`" : "`sun`"),
                   "a sun with its position and a sky with its model, between which it is split");
    shares = split(*global, *position, scene);
  }
  if (sun_table) {
    const auto given = sun_table->get("irradiance");
    if (shares && given) given->fail("`irradiance` beside `global`", "one of them: `global` is split into sun and sky");
    Sun sun{position->direction, {}, diameter};
    sun.irradiance = shares ? shares->beam
                            : read_per_band(sun_table->need("irradiance", "the irradiance per band, on a plane that faces the sun"), scene,
                                            irradiance_value);
    around.beam = sun.irradiance;
    if (sun.direction.z > 0)
      state.sun = std::move(sun);
    else
      scene.notes.push_back(fmt::format("{}: the sun is {:.2f} degrees below the horizon: no sun", sun_table->where(),
                                        0.0 - std::asin(sun.direction.z) / degree));
  }
  if (!sky_table) return state;
  if (position) around.sun = position->direction, around.day_of_year = position->day_of_year;
  if (shares) around.shortwave = shares->shortwave;
  if (around.day_of_year == 0 && global && global->has("day")) around.day_of_year = static_cast<int>(global->get("day")->integer(1, 366));
  read_sky(*sky_table, scene, around, shares, state);
  return state;
}

}  // namespace

TomlSchema sun_schema(const TomlSchema& per_band) {
  return TomlSchema::of({"direction", "elevation", "azimuth", "latitude", "longitude", "time", "altitude", "angular_diameter"},
                        {{"irradiance", per_band}});
}
TomlSchema global_schema(const TomlSchema& per_band) {
  return TomlSchema::of({"shortwave", "day"}, {{"irradiance", per_band}});
}

void read_light(const TomlValue& root, Scene& scene) {
  const auto states = root.get("state");
  if (!states) {
    if (!root.has("sun") && !root.has("sky") && !root.has("global") && !root.has("lamp"))
      throw InputError(location(scene.file), "no light", "[sun], [sky], [[lamp]], or any number of [[state]]");
    scene.states.push_back(read_state(root, scene));
    return;
  }
  for (const char* name : {"sun", "sky", "global"})
    if (const auto value = root.get(name))
      value->fail(fmt::format("[{}] beside [[state]]", name), "one of them: each [[state]] has its own light");
  std::set<std::string> seen;
  for (const auto& table : states->tables()) {
    if (!table.has("sun") && !table.has("sky") && !table.has("global") && !root.has("lamp")) table.fail("no light", "`sun`, `sky` or both");
    LightState state = read_state(table, scene);
    const auto name = table.get("name");
    state.name = name ? name->text() : fmt::format("state {}", scene.states.size() + 1);
    if (!seen.insert(state.name).second)
      (name ? *name : table).fail(fmt::format("the name \"{}\" twice", state.name), "a name for every state");
    if (const auto duration = table.get("duration_s")) state.duration_s = duration->up_to(longest_duration_s, "seconds");
    scene.states.push_back(std::move(state));
  }
  if (scene.states.empty()) states->fail("at least one state");
}

}  // namespace sunfleck
