#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/view/stored.hpp>

namespace sunfleck {

namespace {

/// One value a facet or side of a dataset [states][rows][width]: element `column` (front) and, for sides, `column + stride` (back).
struct Column {
  std::size_t width, first, stride;
  bool sides;
};

class Reader {
 public:
  Reader(const Result& result, const FacetScene& scene, const MapChoice& choice) : result_(result), scene_(scene), choice_(choice) {}

  /// Rows of the facets where they are kept, else their organ's mean; `organs` alone asks for the latter.
  void values(FacetMap& map, const std::string& name, const Column& column, bool organs_only) const {
    const std::size_t n = scene_.size(), k = column.sides ? 2 : 1;
    map.sides = column.sides;
    map.values.resize(k * n);
    const bool facets = !organs_only && result_.has("facets/" + name);
    if (!facets && !result_.has("organs/" + name))
      throw InputError(location(result_.file(), 0, (organs_only ? "organs/" : "facets/") + name), "nothing",
                       "a quantity that the result keeps; [output] of the scene left it out, or it has no sun");
    const auto rows = facets ? result_.state_rows<float>("facets/" + name, choice_.state, 0, n)
                             : result_.state_rows<float>("organs/" + name, choice_.state, 0, result_.organ_count());
    const bool power = !facets && name == "absorbed";  // organs keep absorbed in W
    const auto area = power ? result_.all<float>("organs/area") : std::vector<float>{};
    for (std::size_t f = 0; f < n; ++f) {
      const std::size_t row = facets ? f : scene_.organ[f];
      for (std::size_t s = 0; s < k; ++s) {
        const float v = rows[row * column.width + column.first + s * column.stride];
        map.values[k * f + s] = !power ? v : area[row] > 0 ? v / area[row] : 0.0f;
      }
    }
    if (!facets) map.title.insert(map.title.begin() + 1, "organ means");
  }

 private:
  const Result& result_;
  const FacetScene& scene_;
  const MapChoice& choice_;
};

ValueScale chosen_scale(const FacetMap& map, const FacetScene& scene, const MapChoice& choice) {
  if (!choice.range.empty()) {
    const bool two = choice.range.size() == 2;
    if (!two || !std::isfinite(choice.range[0]) || !std::isfinite(choice.range[1]) || !(choice.range[0] < choice.range[1]))
      throw UsageError(
          two ? fmt::format("--range: found {:g} {:g}; expected two finite numbers, the lower first", choice.range[0], choice.range[1])
              : fmt::format("--range: found {} numbers; expected two", choice.range.size()));
    if (choice.logarithmic && !(choice.range[0] > 0))
      throw UsageError(fmt::format("--range: found {:g} with --log; expected numbers above zero", choice.range[0]));
    return {choice.range[0], choice.range[1], choice.logarithmic};
  }
  const std::size_t end = scene.plant_facets > 0 && !choice.ground ? scene.plant_facets : scene.size(), k = map.sides ? 2 : 1;
  std::vector<double> values;
  for (std::size_t f = 0; f < end; ++f)
    if (scene.area[f] > 0)
      for (std::size_t s = 0; s < k; ++s) values.push_back(map.values[k * f + s]);
  return scale_for(std::move(values), choice.logarithmic);
}

/// Names in the order in which they first appear on what is drawn, so that the legend lists nothing that is not there.
void name_rows(FacetMap& map, const FacetScene& scene, const std::vector<std::uint32_t>& row_of_organ,
               const std::vector<std::string>& names) {
  std::vector<std::uint32_t> shown(names.size(), no_parent);
  map.values.resize(scene.size());
  for (std::size_t f = 0; f < scene.size(); ++f) {
    const auto row = row_of_organ[scene.organ[f]];
    if (shown[row] == no_parent) {
      shown[row] = static_cast<std::uint32_t>(map.names.size());
      map.names.push_back(names[row]);
    }
    map.values[f] = static_cast<float>(shown[row]);
  }
}

}  // namespace

const std::vector<std::string>& quantity_names() {
  static const std::vector<std::string> names{"colour",
                                              "absorbed",
                                              "irradiance",
                                              "irradiance_front",
                                              "irradiance_back",
                                              "sunlit",
                                              "sunlit_front",
                                              "sunlit_back",
                                              "organ_absorbed",
                                              "organ_irradiance",
                                              "organ_sunlit",
                                              "area",
                                              "height",
                                              "organ",
                                              "type",
                                              "plant",
                                              "placement",
                                              "optics"};
  return names;
}

FacetMap stored_map(const Result& result, const FacetScene& scene, const MapChoice& choice) {
  const std::size_t b = result.bands().size(), band = choice.band;
  std::string quantity = choice.quantity;
  FacetMap map;
  map.map = choice.map;
  const bool organs_only = quantity.rfind("organ_", 0) == 0;
  if (organs_only) quantity = quantity.substr(6);
  const Reader reader(result, scene, choice);
  const std::string unit = pretty_unit(result.band_units().at(band)), in_band = " " + result.bands().at(band);

  if (quantity == "absorbed") {
    map.title = {"absorbed" + in_band, unit};
    reader.values(map, "absorbed", {b, band, 0, false}, organs_only);
  } else if (quantity == "irradiance" || quantity == "irradiance_front" || quantity == "irradiance_back") {
    const bool sides = quantity == "irradiance", back = quantity == "irradiance_back";
    map.title = {"irradiance" + in_band + (sides ? "" : back ? ", back" : ", front"), unit};
    reader.values(map, "irradiance", {2 * b, back ? b + band : band, b, sides}, organs_only);
  } else if (quantity == "sunlit" || quantity == "sunlit_front" || quantity == "sunlit_back") {
    const bool sides = quantity == "sunlit", back = quantity == "sunlit_back";
    map.title = {std::string("sunlit fraction") + (sides ? "" : back ? ", back" : ", front")};
    reader.values(map, "sunlit", {2, back ? 1u : 0u, 1, sides}, organs_only);
    if (choice.range.empty() && !choice.logarithmic) {
      map.scale = {0, 1, false};
      return map;
    }
  } else if (quantity == "area") {
    map.title = {"facet area", pretty_unit("m^2")};
    map.values = scene.area;
  } else if (quantity == "height") {
    map.title = {"height", "m"};
    for (const auto& c : scene.corners) map.values.push_back(static_cast<float>((c[0].z + c[1].z + c[2].z) / 3));
  } else if (quantity == "organ") {
    map.title = {"organ"};
    std::vector<std::uint32_t> rows(scene.organs.size());
    std::vector<std::string> names(rows.size());
    for (std::uint32_t o = 0; o < rows.size(); ++o) rows[o] = o, names[o] = scene.organs.names[scene.organs.name[o]];
    name_rows(map, scene, rows, names);
  } else if (quantity == "type") {
    map.title = {"type"};
    name_rows(map, scene, scene.organs.type, scene.organs.types);
  } else if (quantity == "plant") {
    map.title = {"plant"};
    name_rows(map, scene, scene.organs.plant, scene.organs.plants);
  } else if (quantity == "placement") {
    map.title = {"placement"};
    name_rows(map, scene, scene.organs.placement, scene.organs.placements);
  } else if (quantity == "optics") {
    map.title = {"optics"};
    for (const auto& m : scene.materials) map.names.push_back(m.name);
    map.values.assign(scene.optics.begin(), scene.optics.end());
  } else {
    const std::string nearest = nearest_name(choice.quantity, quantity_names());
    throw UsageError(fmt::format("--quantity: found '{}'; expected one of {}{}", choice.quantity, joined(quantity_names()),
                                 nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
  }
  if (map.names.empty()) map.scale = chosen_scale(map, scene, choice);
  return map;
}

}  // namespace sunfleck
