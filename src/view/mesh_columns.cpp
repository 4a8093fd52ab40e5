#include "view/mesh_columns.hpp"

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/utf8.hpp>

#include "view/column_names.hpp"

namespace sunfleck {

std::vector<MeshColumn> mesh_columns(const Result& result, const MeshChoice& choice) {
  std::vector<MeshColumn> columns;
  std::vector<std::string> names;
  const ColumnNames plain(result, plain_name);
  const std::size_t bands = result.bands().size();
  for (std::size_t s = 0; s < result.states().size(); ++s) {
    if (choice.state && *choice.state != s) continue;
    const std::string suffix = !choice.state && result.states().size() > 1 ? "_" + plain.states[s] : "";
    const auto add = [&](const std::string& name, const char* dataset, std::size_t width, std::size_t element, const std::string& unit) {
      if (result.has(dataset)) names.push_back(name + suffix), columns.push_back({{}, dataset, s, width, element, unit});
    };
    for (std::size_t b = 0; b < bands; ++b) {
      const std::string &band = plain.bands[b], &unit = result.band_units()[b];
      add("irradiance_front_" + band, "facets/irradiance", 2 * bands, b, unit);
      add("irradiance_back_" + band, "facets/irradiance", 2 * bands, bands + b, unit);
      add("absorbed_" + band, "facets/absorbed", bands, b, unit);
    }
    add("sunlit_front", "facets/sunlit", 2, 0, "1");
    add("sunlit_back", "facets/sunlit", 2, 1, "1");
  }
  names = distinct_names(names, same_name);  // a band "a_b" and a state "c", a band "a" and a state "b_c"
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c].name = names[c];
  return columns;
}

std::vector<std::vector<float>> column_values(const Result& result, const std::vector<MeshColumn>& columns, std::size_t first,
                                              std::size_t count) {
  std::vector<std::vector<float>> out(columns.size());
  std::vector<bool> done(columns.size(), false);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (done[c]) continue;
    const auto values = result.state_rows<float>(columns[c].dataset, columns[c].state, first, count);
    for (std::size_t k = c; k < columns.size(); ++k) {
      const auto& column = columns[k];
      if (column.dataset != columns[c].dataset || column.state != columns[c].state) continue;
      done[k] = true;
      out[k].resize(count);
      for (std::size_t i = 0; i < count; ++i) out[k][i] = values[i * column.width + column.element];
    }
  }
  return out;
}

void expect_facets(const Result& result) {
  if (!result.has("facets/area"))
    throw InputError(location(result.file(), 0, "/facets"), "nothing",
                     "values per facet; the scene kept organs only ([output] facets = false)");
}

std::vector<std::string> mesh_comments(const Result& result) {
  std::vector<std::string> lines;
  lines.push_back(
      fmt::format("Sunfleck {}, method {}; one face a facet; lengths in m", result.header().software_version, result.header().method));
  const ColumnNames plain(result, plain_name);
  const auto called = [](const std::string& name, const std::string& column) {
    return column == name ? "" : fmt::format("; called {} in names of columns", column);
  };
  for (std::size_t b = 0; b < result.bands().size(); ++b)
    lines.push_back(fmt::format("irradiance and absorbed {}: {} of one-sided area{}", clean_name(result.bands()[b]), result.band_units()[b],
                                called(result.bands()[b], plain.bands[b])));
  for (std::size_t s = 0; s < result.states().size(); ++s)
    if (const auto& name = result.states()[s].name; name != plain.states[s])
      lines.push_back(fmt::format("state {}{}", clean_name(name), called(name, plain.states[s])));
  lines.push_back("sunlit: fraction of the side that the sun reaches; organ: row of /organs of the result");
  return lines;
}

}  // namespace sunfleck
