// Which sky a list of directions stands for.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include <format/import_parts.hpp>
#include <sunfleck/light/sky.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t least_of_a_sky = 6;
constexpr std::size_t most_of_a_sky = 5000;  // more would only cost time to compare
constexpr double alike = 0.03;               // half the sum of differences of shares: CARIBU's own skies differ by .0005 to .018 from
                                             // the model they stand for, and by .08 from the other
constexpr int rings = 128, sectors = 256;

/// Half the sum of |share in the file - share of the Voronoi cell under the model|.
double distance_to(const std::vector<LightDirection>& directions, const std::vector<std::size_t>& cell, SkyModel model) {
  Sky sky;
  sky.model = model;
  std::vector<double> share(directions.size(), 0.0);
  double total = 0, file_total = 0;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double cosine = (i + 0.5) / rings;
      const double light = sky.relative_radiance({std::sqrt(1 - cosine * cosine), 0, cosine}) * cosine;
      share[cell[static_cast<std::size_t>(i * sectors + j)]] += light;
      total += light;
    }
  for (const auto& d : directions) file_total += d.irradiance;
  double sum = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) sum += std::fabs(share[i] / total - directions[i].irradiance / file_total);
  return 0.5 * sum;
}

/// The model that the directions stand for, if any.
std::optional<SkyModel> sky_of(const std::vector<LightDirection>& directions) {
  if (directions.size() < least_of_a_sky || directions.size() > most_of_a_sky) return std::nullopt;
  std::vector<std::size_t> cell;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double z = (i + 0.5) / rings, s = std::sqrt(1 - z * z), angle = 2 * std::numbers::pi * (j + 0.5) / sectors;
      const Vec3 d{s * std::cos(angle), s * std::sin(angle), z};
      std::size_t nearest = 0;
      double best = -2;
      for (std::size_t k = 0; k < directions.size(); ++k)
        if (const double c = glm::dot(d, directions[k].towards); c > best) best = c, nearest = k;
      cell.push_back(nearest);
    }
  const double uniform = distance_to(directions, cell, SkyModel::uniform);
  const double overcast = distance_to(directions, cell, SkyModel::standard_overcast);
  if (std::min(uniform, overcast) > alike) return std::nullopt;
  return uniform < overcast ? SkyModel::uniform : SkyModel::standard_overcast;
}

std::vector<double> every_band(const std::vector<std::string>& bands, double value) {
  return std::vector<double>(bands.size(), value);
}

/// Direction and irradiance of a sun that gives the horizontal irradiance of the file.
std::string sun_values(const LightDirection& d, const std::vector<std::string>& bands, const char* between) {
  return fmt::format("direction = [{}, {}, {}]{}irradiance = {}{}angular_diameter = 0.0", d.towards.x, d.towards.y, d.towards.z, between,
                     band_table(bands, every_band(bands, d.irradiance / d.towards.z)), between);
}

}  // namespace

std::string light_tables(const std::vector<LightDirection>& directions, const std::vector<std::string>& bands, bool states,
                         std::vector<std::string>& notes) {
  const auto horizontal = [](const std::vector<LightDirection>& list) {
    return std::accumulate(list.begin(), list.end(), 0.0, [](double sum, const LightDirection& d) { return sum + d.irradiance; });
  };
  const auto sky_table = [&](SkyModel model, const std::vector<LightDirection>& list) {
    return fmt::format("[sky]\nmodel = \"{}\"\nirradiance = {}\n", name_of(model), band_table(bands, every_band(bands, horizontal(list))));
  };
  if (!states) {
    if (directions.size() == 1) return "[sun]\n" + sun_values(directions[0], bands, "\n") + "\n";
    if (const auto model = sky_of(directions)) {
      notes.push_back(
          fmt::format("the {} directions of the light are those of a {} sky: that continuous sky takes their place (--light-states keeps "
                      "them apart)",
                      directions.size(), name_of(*model)));
      return sky_table(*model, directions);
    }
    // a sky and a sun: the sun's line is the brightest that leaves a sky behind
    std::vector<std::size_t> brightest(directions.size());
    std::iota(brightest.begin(), brightest.end(), std::size_t{0});
    std::sort(brightest.begin(), brightest.end(), [&](auto a, auto b) { return directions[a].irradiance > directions[b].irradiance; });
    for (std::size_t i = 0; i < std::min<std::size_t>(3, brightest.size()); ++i) {
      auto rest = directions;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(brightest[i]));
      const auto model = sky_of(rest);
      if (!model) continue;
      const auto& sun = directions[brightest[i]];
      notes.push_back(fmt::format("line {} of the light is taken for the sun, the other {} for a {} sky (--light-states keeps all apart)",
                                  sun.line, rest.size(), name_of(*model)));
      return "[sun]\n" + sun_values(sun, bands, "\n") + "\n\n" + sky_table(*model, rest);
    }
  }
  notes.push_back(
      fmt::format("each of the {} directions of the light is a state of one second with a point-like sun: the sums over states, in J, "
                  "are what all of them give together, in W",
                  directions.size()));
  std::string text;
  for (std::size_t i = 0; i < directions.size(); ++i)
    text += fmt::format("[[state]]\nname = \"direction {}\"\nduration_s = 1\nsun = {{ {} }}\n\n", i + 1,
                        sun_values(directions[i], bands, ", "));
  return text;
}

}  // namespace sunfleck
