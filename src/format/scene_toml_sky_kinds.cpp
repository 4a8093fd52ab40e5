// Skies by weather and by picture: model = "perez" and "image".
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include <format/panorama.hpp>
#include <format/scene_toml_parts.hpp>

namespace sunfleck {

namespace {

/// The sum of all bands, if all are energy.
std::optional<double> shortwave_of(const std::vector<double>& per_band, const Scene& scene) {
  for (const auto& unit : scene.band_units)
    if (unit != "W m^-2") return std::nullopt;
  return std::accumulate(per_band.begin(), per_band.end(), 0.0);
}

double elevation_deg(const Vec3& sun) {
  return std::asin(std::clamp(sun.z, -1.0, 1.0)) * 180.0 / 3.14159265358979323846;
}

}  // namespace

PerezWeather read_perez_weather(const TomlValue& sky, Scene& scene, const StateAround& around, const std::vector<double>& irradiance) {
  const auto clearness = sky.get("clearness"), brightness = sky.get("brightness"), direct = sky.get("direct"), diffuse = sky.get("diffuse");
  const auto day = sky.get("day");
  const char* ways =
      "one of: `clearness` and `brightness`; `direct` and `diffuse` [W m^-2]; neither, where [sun] and [sky] or [global] tell";
  if ((clearness || brightness) && (direct || diffuse)) throw InputError(sky.where(), "several kinds of weather", ways);
  if (clearness || brightness) {
    if (day) day->fail("`day` beside `clearness`", "one of them");
    const double e = sky.need("clearness", "a number of 1 or more, as `brightness` is given").number(1, 1e6);
    const auto given = sky.need("brightness", "a number above 0, as `clearness` is given");
    const double d = given.number(0, 1e6);
    if (d == 0) given.fail("a number above 0");
    return {e, d};
  }
  int day_of_year = around.day_of_year;
  if (day) {
    if (day_of_year > 0) day->fail("`day` beside another date", "one date");
    day_of_year = static_cast<int>(day->integer(1, 366));
  }
  if (!around.sun) return {};  // which prepare_sky() refuses
  const auto weather = [&](double beam, double from_sky) {
    return perez_weather(beam, from_sky, elevation_deg(*around.sun), day_of_year, sky.where());
  };
  if (direct || diffuse) {
    const double beam = sky.need("direct", "the sun's beam on a plane that faces it [W m^-2], as `diffuse` is given").up_to(1e4, "W m^-2");
    const auto given = sky.need("diffuse", "the sky's light on a horizontal plane [W m^-2], as `direct` is given");
    const double from_sky = given.up_to(1e4, "W m^-2");
    if (from_sky == 0) given.fail("a number above 0");
    return weather(beam, from_sky);
  }
  if (around.shortwave) return weather((*around.shortwave)[0], (*around.shortwave)[1]);
  const auto beam = shortwave_of(around.beam, scene), from_sky = shortwave_of(irradiance, scene);
  if (!beam || !from_sky)
    throw InputError(sky.where("direct"), "nothing", "`direct` and `diffuse` of all wavelengths [W m^-2], as a band counts photons");
  scene.notes.push_back(
      fmt::format("{}: no `direct` and `diffuse`: the bands' sums, {:.6g} and {:.6g} W m^-2, are taken as those of all wavelengths",
                  sky.where(), *beam, *from_sky));
  return weather(*beam, *from_sky);
}

PicturedSky read_sky_picture(const TomlValue& sky, Scene& scene, bool has_sun) {
  const auto file = sky.need("file", "a picture of the sky");
  const std::string path = read_path(file, scene, "a picture of the sky in HDR, EXR or PNG");
  const auto code = sky.get("encoding"), turn = sky.get("turn"), sun = sky.get("sun");
  const std::string name = code ? code->one_of({"linear", "srgb"}) : "";
  Panorama picture = read_panorama(path, name.empty() ? PictureCode::by_depth : name == "srgb" ? PictureCode::srgb : PictureCode::linear);
  picture.turn_deg = turn ? turn->number(-360, 360, "degrees") : 0.0;
  check_panorama(picture, path);
  const bool keep = sun ? sun->one_of({"keep", "cut"}) == "keep" : !has_sun;
  if (sun && keep && has_sun) sun->fail("\"keep\" beside [sun]", "\"cut\", or no [sun]: there is one sun");
  PicturedSky out;
  const auto found = take_sun(picture);
  if (found && keep) out.sun = found;
  if (found)
    scene.notes.push_back(
        fmt::format("{}: the picture's sun, at elevation {:.2f} degrees with {:.1f} % of the horizontal irradiance, is {}", sky.where(),
                    elevation_deg(found->direction), 100 * found->horizontal_share, keep ? "followed as a sun" : "cut out"));
  else if (sun && !keep)
    scene.notes.push_back(fmt::format("{}: no sun was found in the picture: nothing is cut out", sun->where()));
  const auto lit = [&](float v) { return v > 0; };
  const auto end = picture.value.begin() + std::ptrdiff_t{picture.columns} * picture.rows_up();
  if (found && std::none_of(picture.value.begin(), end, lit)) {
    if (!keep) throw InputError(path, "a picture that is dark but for its sun, which is cut out", "some light of the sky");
    return out;
  }
  out.image = std::make_shared<const SkyImage>(std::move(picture), path);
  return out;
}

}  // namespace sunfleck
