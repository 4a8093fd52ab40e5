// Which sky a list of directions stands for.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include <format/import_parts.hpp>
#include <sunfleck/light/sky.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t least_of_a_sky = 6;
constexpr std::size_t most_of_a_sky = 20000;  // more would only cost time to compare
constexpr double alike = 0.03;                // half the sum of differences of shares: CARIBU's own skies differ by .0005 to .018 from
                                              // the model they stand for, and by .08 from the other
constexpr double sun_share = 1.0 / 3.0;       // of the irradiance: no cell of a sky of six or more directions has as much

/// Directions that cover the sky as evenly as the cells of a sky do, if they do: 3 times the radius of caps that would share the hemisphere
/// leave no gap, nor 50 degrees. The suns of a day leave the other half of the sky empty.
std::optional<SkyTable> cells_of_a_sky(const std::vector<LightDirection>& directions) {
  if (directions.size() < least_of_a_sky || directions.size() > most_of_a_sky) return std::nullopt;
  std::vector<Vec3> towards;
  for (const auto& d : directions) towards.push_back(d.towards);
  SkyTable table(std::move(towards), std::vector<double>(directions.size(), 1.0), "directions of the light");
  const double widest = std::min(3 * std::sqrt(2.0 / static_cast<double>(directions.size())), 50 * std::numbers::pi / 180);
  if (table.widest_gap() > widest) return std::nullopt;
  const auto cells = table.cell_integrals([](const Vec3&) { return 1.0; });
  if (*std::min_element(cells.begin(), cells.end()) <= 0) return std::nullopt;  // whose light would be lost
  return table;
}

/// Half the sum of |share in the file - share of the cell under the model|.
double distance_to(const std::vector<LightDirection>& directions, const SkyTable& table, SkyModel model) {
  Sky sky;
  sky.model = model;
  const auto share = table.cell_integrals([&](const Vec3& d) { return sky.relative_radiance(d); });
  const double total = std::accumulate(share.begin(), share.end(), 0.0);
  double file_total = 0;
  for (const auto& d : directions) file_total += d.irradiance;
  double sum = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) sum += std::fabs(share[i] / total - directions[i].irradiance / file_total);
  return 0.5 * sum;
}

/// The model that the cells of a sky have, if any.
std::optional<SkyModel> model_of(const std::vector<LightDirection>& directions, const SkyTable& table) {
  const double uniform = distance_to(directions, table, SkyModel::uniform);
  const double overcast = distance_to(directions, table, SkyModel::standard_overcast);
  if (std::min(uniform, overcast) > alike) return std::nullopt;
  return uniform < overcast ? SkyModel::uniform : SkyModel::standard_overcast;
}

/// Lines of the same direction, to 1e-6, as one.
std::vector<LightDirection> merged(const std::vector<LightDirection>& directions) {
  std::map<std::tuple<long, long, long>, std::size_t> rows;
  std::vector<LightDirection> out;
  for (const auto& d : directions) {
    const auto [at, fresh] =
        rows.try_emplace({std::lround(1e6 * d.towards.x), std::lround(1e6 * d.towards.y), std::lround(1e6 * d.towards.z)}, out.size());
    if (fresh)
      out.push_back(d);
    else
      out[at->second].irradiance += d.irradiance;
  }
  return out;
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

std::string light_tables(const std::vector<LightDirection>& lines, const std::vector<std::string>& bands, bool states,
                         std::vector<std::string>& notes) {
  const auto directions = merged(lines);
  const auto sky_table = [&](const std::string& model, const std::vector<LightDirection>& list) {
    const double sum = std::accumulate(list.begin(), list.end(), 0.0, [](double e, const LightDirection& d) { return e + d.irradiance; });
    return fmt::format("[sky]\nmodel = \"{}\"\nirradiance = {}\n", model, band_table(bands, every_band(bands, sum)));
  };
  /// Cells of the sky with the radiance that gives each the irradiance of its line.
  const auto file_sky = [&](const SkyTable& table, const std::vector<LightDirection>& list) {
    const auto cell = table.cell_integrals([](const Vec3&) { return 1.0; });
    std::string text = sky_table("file", list) + "directions = [\n";
    for (std::size_t i = 0; i < list.size(); ++i)
      text += fmt::format("  [{}, {}, {}, {}],\n", list[i].towards.x, list[i].towards.y, list[i].towards.z,
                          cell[i] > 0 ? list[i].irradiance / cell[i] : 0.0);
    return text + "]\n";
  };
  if (!states) {
    if (directions.size() == 1) return "[sun]\n" + sun_values(directions[0], bands, "\n") + "\n";
    const auto all = cells_of_a_sky(directions);
    if (const auto model = all ? model_of(directions, *all) : std::nullopt) {
      notes.push_back(
          fmt::format("the {} directions of the light are those of a {} sky: that continuous sky takes their place (--light-states keeps "
                      "them apart)",
                      directions.size(), name_of(*model)));
      return sky_table(name_of(*model), directions);
    }
    // a sky and a sun: the sun's line is the brightest that leaves a sky behind
    std::vector<std::size_t> order(directions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return directions[a].irradiance > directions[b].irradiance; });
    const double total =
        std::accumulate(directions.begin(), directions.end(), 0.0, [](double e, const auto& d) { return e + d.irradiance; });
    for (std::size_t i = 0; i < std::min<std::size_t>(3, order.size()); ++i) {
      auto rest = directions;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(order[i]));
      const auto table = cells_of_a_sky(rest);
      if (!table) continue;
      const auto model = model_of(rest, *table);
      const auto& sun = directions[order[i]];
      if (!model && !(i == 0 && sun.irradiance > sun_share * total)) continue;
      notes.push_back(fmt::format("line {} of the light is taken for the sun, the other {} for {} (--light-states keeps all apart)",
                                  sun.line, rest.size(), model ? "a " + name_of(*model) + " sky" : "the cells of a sky"));
      return "[sun]\n" + sun_values(sun, bands, "\n") + "\n\n" + (model ? sky_table(name_of(*model), rest) : file_sky(*table, rest));
    }
    if (all) {
      notes.push_back(
          fmt::format("the {} directions of the light are the cells of a sky: each shines from all of the sky that is nearest to it "
                      "(--light-states keeps them apart)",
                      directions.size()));
      return file_sky(*all, directions);
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
