// A sky of directions: model = "file", with `file` (CSV) or `directions`.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/light/sun.hpp>

#include <format/scene_toml_parts.hpp>
#include <format/text.hpp>

namespace sunfleck {

namespace {

constexpr const char* columns_of_sky = "x, y, z (towards the sky) or elevation, azimuth (from north over east) [degrees], and radiance";

/// Directions and radiances as rows come in.
struct SkyRows {
  std::vector<Vec3> directions;
  std::vector<double> radiances;

  void add(const Vec3& v, double radiance, const std::string& where) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0)) throw InputError(where, "[0, 0, 0]", "a vector that is not zero");
    directions.push_back(glm::normalize(v / largest));
    radiances.push_back(radiance);
    if (!(v.z >= 0)) throw InputError(where, fmt::format("[{}, {}, {}]", v.x, v.y, v.z), "a direction at or above the horizon");
    if (!(radiance >= 0)) throw InputError(where, fmt::format("radiance {}", radiance), "zero or more");
  }
};

/// Which columns hold x, y, z (or elevation and azimuth) and the radiance.
struct SkyColumns {
  bool by_angles = false;
  std::array<std::size_t, 4> at{};
  std::size_t count = 0;
};

SkyColumns read_sky_header(const std::vector<std::string_view>& cells, const std::string& where) {
  SkyColumns columns;
  columns.count = cells.size();
  columns.by_angles = std::find(cells.begin(), cells.end(), "elevation") != cells.end();
  const std::vector<std::string> names = columns.by_angles ? std::vector<std::string>{"elevation", "azimuth", "radiance"}
                                                           : std::vector<std::string>{"x", "y", "z", "radiance"};
  for (const auto& cell : cells)
    if (std::find(names.begin(), names.end(), cell) == names.end() || std::count(cells.begin(), cells.end(), cell) > 1)
      throw InputError(where, "column " + in_quotes(cell), std::string("each once of ") + columns_of_sky);
  for (std::size_t n = 0; n < names.size(); ++n) {
    const auto at = std::find(cells.begin(), cells.end(), names[n]);
    if (at == cells.end()) throw InputError(where, "no column " + names[n], columns_of_sky);
    columns.at[n] = static_cast<std::size_t>(at - cells.begin());
  }
  return columns;
}

SkyRows read_rows(const std::string& file) {
  std::vector<std::string> ignored;  // comments, of which nothing is kept
  const std::string text = read_text(file, ignored);
  Lines lines(text);
  SkyColumns columns;
  SkyRows rows;
  for (std::string_view line; lines.next(line);) {
    line = Words(line.substr(0, line.find('#'))).rest();
    if (line.empty()) continue;
    const auto cells = cells_of(line);
    const std::string where = location(file, lines.number());
    if (columns.count == 0) {
      columns = read_sky_header(cells, where);
      continue;
    }
    if (cells.size() != columns.count)
      throw InputError(where, fmt::format("{} cells", cells.size()), fmt::format("{}, as in the first line", columns.count));
    std::array<double, 4> v{};
    for (std::size_t n = 0; n < columns.count; ++n)
      if (!to_number(cells[columns.at[n]], v[n]) || !std::isfinite(v[n]))
        throw InputError(where, in_quotes(cells[columns.at[n]]), "a finite number");
    if (columns.by_angles && !(v[0] >= 0 && v[0] <= 90)) throw InputError(where, fmt::format("elevation {}", v[0]), "0 to 90 degrees");
    if (columns.by_angles)
      rows.add(direction_from_angles(v[0], v[1]), v[2], where);
    else
      rows.add({v[0], v[1], v[2]}, v[3], where);
  }
  if (rows.directions.empty()) throw InputError(location(file), "no direction", std::string("a header and rows of ") + columns_of_sky);
  return rows;
}

}  // namespace

TomlSchema sky_schema(const TomlSchema& per_band) {
  return TomlSchema::of({"model", "file", "directions", "turn", "sun", "encoding", "clearness", "brightness", "direct", "diffuse", "day"},
                        {{"irradiance", per_band}});
}

std::shared_ptr<const SkyTable> read_sky_table(const TomlValue& sky, const Scene& scene) {
  const auto file = sky.get("file"), directions = sky.get("directions");
  if (file.has_value() == directions.has_value())
    throw InputError(sky.where(), file ? "both `file` and `directions`" : "neither `file` nor `directions`",
                     "one of them, with the directions and radiances of the sky");
  if (file) {
    const std::string path = read_path(*file, scene, "a CSV file with a sky's directions and radiances");
    SkyRows rows = read_rows(path);
    return std::make_shared<const SkyTable>(std::move(rows.directions), std::move(rows.radiances), path);
  }
  SkyRows rows;
  if (!directions->is_array()) directions->fail("an array of [x, y, z, radiance]");
  for (const auto& row : directions->items()) {
    const auto v = row.numbers(4, "x, y, z towards the sky, radiance");
    rows.add({v[0], v[1], v[2]}, v[3], row.where());
  }
  return std::make_shared<const SkyTable>(std::move(rows.directions), std::move(rows.radiances), directions->where());
}

}  // namespace sunfleck
