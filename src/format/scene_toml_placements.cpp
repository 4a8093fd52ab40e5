// Where copies stand: single places, grids, and rows of a CSV file.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/scene/build.hpp>

#include <format/scene_toml_parts.hpp>
#include <format/text.hpp>

namespace sunfleck {

namespace {

/// The keys that a place, a grid and a CSV row share, but for the position; `turn` of a grid may be "random".
Stance read_stance(const TomlValue& table) {
  Stance stance;
  if (const auto turn = table.get("turn"); turn && !turn->is_text()) stance.turn_deg = turn->number();
  if (const auto scale = table.get("scale")) stance.scale = scale->positive();
  if (const auto tilt = table.get("tilt")) stance.tilt_deg = tilt->number(0, 180, "degrees");
  if (const auto azimuth = table.get("tilt_azimuth")) stance.tilt_azimuth_deg = azimuth->number();
  if (const auto mirror = table.get("mirror")) stance.mirror = mirror->flag();
  return stance;
}

const std::vector<std::string> csv_columns{"x", "y", "z", "turn", "scale", "tilt", "tilt_azimuth", "mirror"};

/// Names of the columns from a header, or x, y, z, turn, scale where the first line holds numbers.
std::vector<std::size_t> read_header(const std::vector<std::string_view>& cells, const std::string& where, bool& is_header) {
  double ignored = 0;
  is_header = !to_number(cells.front(), ignored);
  std::vector<std::size_t> columns;
  if (!is_header) {
    for (std::size_t c = 0; c < 5; ++c) columns.push_back(c);
    return columns;
  }
  std::array<bool, 8> seen{};
  for (const auto cell : cells) {
    std::size_t c = 0;
    while (c < csv_columns.size() && csv_columns[c] != cell) ++c;
    if (c == csv_columns.size()) {
      const std::string nearest = nearest_name(cell, csv_columns);
      throw InputError(where, "column " + in_quotes(cell),
                       "one of " + joined(csv_columns) + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
    }
    if (seen[c]) throw InputError(where, "column " + in_quotes(cell) + " twice", "every column once");
    seen[c] = true;
    columns.push_back(c);
  }
  if (!seen[0] || !seen[1]) throw InputError(where, "no column \"" + std::string(seen[0] ? "y" : "x") + '"', "at least x and y [m]");
  return columns;
}

std::vector<Placement> read_positions(const std::string& file) {
  std::vector<std::string> ignored;  // comments, of which nothing is kept
  const std::string text = read_text(file, ignored);
  Lines lines(text);
  std::string_view line;
  std::vector<std::size_t> columns;
  std::vector<Placement> all;
  all.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1);
  while (lines.next(line)) {
    line = Words(line.substr(0, line.find('#'))).rest();
    if (line.empty()) continue;
    const auto cells = cells_of(line);
    const std::string where = location(file, lines.number());
    if (columns.empty()) {
      bool is_header = false;
      columns = read_header(cells, where, is_header);
      if (is_header) continue;
      if (cells.size() < 2 || cells.size() > 5)
        throw InputError(where, fmt::format("{} numbers", cells.size()), "2 to 5: x, y, z, turn, scale");
      columns.resize(cells.size());
    }
    if (cells.size() != columns.size())
      throw InputError(where, fmt::format("{} cells", cells.size()), fmt::format("{}, as in the first line", columns.size()));
    std::array<double, 8> v{0, 0, 0, 0, 1, 0, 0, 0};
    for (std::size_t c = 0; c < cells.size(); ++c)
      if (!to_number(cells[c], v[columns[c]]) || !std::isfinite(v[columns[c]]))
        throw InputError(location(file, lines.number(), csv_columns[columns[c]]), in_quotes(cells[c]), "a finite number");
    if (!(v[4] > 0)) throw InputError(location(file, lines.number(), "scale"), fmt::format("{}", v[4]), "a number above zero");
    if (v[5] < 0 || v[5] > 180)
      throw InputError(location(file, lines.number(), "tilt"), fmt::format("{}", v[5]), "a number from 0 to 180 degrees");
    if (v[7] != 0 && v[7] != 1) throw InputError(location(file, lines.number(), "mirror"), fmt::format("{}", v[7]), "0 or 1");
    all.push_back(placed(Stance{{v[0], v[1], v[2]}, v[3], v[4], v[5], v[6], v[7] == 1}));
  }
  if (all.empty()) throw InputError(location(file), "no position", "at least one line of x, y, z, turn, scale");
  return all;
}

}  // namespace

TomlSchema placement_schema(const std::vector<std::string>& further_keys) {
  std::vector<std::string> keys = further_keys;
  for (const char* key : {"position", "turn", "scale", "tilt", "tilt_azimuth", "mirror", "file"}) keys.emplace_back(key);
  return TomlSchema::of(keys, {{"grid", grid_schema()}});
}

TomlSchema grid_schema() {
  return TomlSchema::of({"origin", "step", "count", "turn", "seed", "scale", "tilt", "tilt_azimuth", "mirror"});
}

std::vector<Placement> read_grid(const TomlValue& grid) {
  Stance stance = read_stance(grid);
  Vec3 origin{0.0};
  if (const auto at = grid.get("origin")) {
    const auto v = at->is_array() && at->items().size() == 3 ? at->numbers(3, "x, y, z [m]") : at->numbers(2, "x, y [m] (or x, y, z)");
    origin = {v[0], v[1], v.size() == 3 ? v[2] : 0.0};
  }
  const auto step = grid.need("step", "[along x, along y] between copies [m]").numbers(2, "along x, along y [m]");
  const auto count = grid.need("count", "[copies along x, copies along y]");
  const auto counts = count.is_array() ? count.items() : std::vector<TomlValue>{};
  if (counts.size() != 2) count.fail("an array of 2 whole numbers: copies along x, copies along y");
  const auto columns = counts[0].integer(1, 1'000'000), rows = counts[1].integer(1, 1'000'000);
  if (columns * rows > 10'000'000)
    count.fail(fmt::format("{} copies", columns * rows), "at most 10000000 in one grid (a group may hold many)");
  const auto turn = grid.get("turn"), seed = grid.get("seed");
  const bool random = turn && turn->is_text();
  if (random && turn->text() != "random") turn->fail("a number of degrees, or \"random\"");
  if (seed && !random) seed->fail("`seed` without turn = \"random\"", "both or neither");
  const auto key = static_cast<std::uint64_t>(seed ? seed->integer(0, std::numeric_limits<std::int64_t>::max()) : 1);
  std::vector<Placement> all;
  all.reserve(static_cast<std::size_t>(columns * rows));
  for (std::int64_t j = 0; j < rows; ++j)
    for (std::int64_t i = 0; i < columns; ++i) {
      stance.position = origin + Vec3{step[0] * static_cast<double>(i), step[1] * static_cast<double>(j), 0.0};
      if (random) stance.turn_deg = 360.0 * unit_interval(mix(key, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)));
      all.push_back(placed(stance));
    }
  return all;
}

std::vector<Placement> read_placements(const TomlValue& entry, const Scene& scene) {
  const auto grid = entry.get("grid"), file = entry.get("file");
  if (grid || file) {
    for (const char* key : {"position", "turn", "scale", "tilt", "tilt_azimuth", "mirror"})
      if (const auto value = entry.get(key))
        value->fail(fmt::format("`{}` beside `{}`", key, grid ? "grid" : "file"), grid ? "it inside `grid`" : "it as a column of the file");
    if (grid && file) grid->fail("`grid` beside `file`", "one of them");
    return grid ? read_grid(*grid) : read_positions(read_path(*file, scene, "a CSV file with columns x, y, z, turn, scale"));
  }
  Stance stance = read_stance(entry);
  if (const auto turn = entry.get("turn")) turn->number();  // "random" is for grids
  const auto v = entry.need("position", "[x, y, z] [m], or `grid`, or `file`").numbers(3, "x, y, z [m]");
  stance.position = {v[0], v[1], v[2]};
  return {placed(stance)};
}

}  // namespace sunfleck
