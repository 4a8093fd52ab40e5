#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/result/scene_match.hpp>
#include <sunfleck/view/stored.hpp>

#include "view/facet_lookup.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t mapped_at_once = std::size_t{1} << 16;

/// One value a facet or side of a dataset [states][rows][width]: element `column` (front) and, for sides, `column + stride` (back).
struct Column {
  std::string dataset;  ///< without "facets/"
  std::size_t width, first, stride;
  bool sides;
};

/// Builds a MapSource; what it captures lives as long as the source.
class MapMaker {
 public:
  MapMaker(const Result& result, FacetLookup facets, const MapChoice& choice, Progress& progress)
      : result_(result), facets_(std::make_shared<const FacetLookup>(std::move(facets))), choice_(choice), progress_(progress) {}

  MapSource make();

 private:
  /// Rows of the facets where they are kept, else their organ's mean; `organs_only` asks for the latter.
  void column(const Column& column, bool organs_only);
  LightSource::Read read_column(const Result& result, const Column& column, bool by_organ) const;
  bool by_organ(const Result& result, const Column& column, bool organs_only) const;
  void error(bool organs_only);
  double mean_absorbed(const Result& reference) const;
  /// A row of `names` per organ; names in the order in which they first appear, so that the legend lists nothing that is not there.
  void names_of_organs(const char* index, const char* names);
  ValueScale scale() const;

  const Result& result_;
  std::shared_ptr<const FacetLookup> facets_;
  const MapChoice& choice_;
  Progress& progress_;
  MapSource map_;
};

bool MapMaker::by_organ(const Result& result, const Column& column, bool organs_only) const {
  const bool facets = !organs_only && result.has("facets/" + column.dataset);
  if (!facets && !result.has("organs/" + column.dataset))
    throw InputError(location(result.file(), 0, (organs_only ? "organs/" : "facets/") + column.dataset), "nothing",
                     "a quantity that the result keeps; [output] of the scene left it out, or it has no sun");
  return !facets;
}

LightSource::Read MapMaker::read_column(const Result& result, const Column& column, bool organs) const {
  const std::size_t k = column.sides ? 2 : 1;
  const auto pick = [column, k](const std::vector<float>& rows) {
    std::vector<float> out(k * (rows.size() / column.width));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = rows[i / k * column.width + column.first + i % k * column.stride];
    return out;
  };
  if (!organs)
    return [&result, pick, name = "facets/" + column.dataset, state = choice_.state](std::size_t first, std::size_t count) {
      return pick(result.state_rows<float>(name, state, first, count));
    };
  std::vector<float> means;
  const std::size_t m = result.organ_count();
  for (std::size_t first = 0; first < m; first += mapped_at_once) {
    const std::size_t count = std::min(mapped_at_once, m - first);
    auto part = pick(result.state_rows<float>("organs/" + column.dataset, choice_.state, first, count));
    if (column.dataset == "absorbed") {  // organs keep it in W
      const auto area = result.rows<float>("organs/area", first, count);
      for (std::size_t i = 0; i < count; ++i) part[i] = area[i] > 0 ? part[i] / area[i] : 0.0f;
    }
    means.insert(means.end(), part.begin(), part.end());
  }
  return [means = std::move(means), facets = facets_, k](std::size_t first, std::size_t count) {
    const auto organ = facets->organ(first, count);
    std::vector<float> out(k * count);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = means[k * organ[i / k] + i % k];
    return out;
  };
}

void MapMaker::column(const Column& column, bool organs_only) {
  const bool organs = by_organ(result_, column, organs_only);
  map_.sides = column.sides;
  map_.values = read_column(result_, column, organs);
  if (organs) map_.title.insert(map_.title.begin() + 1, "organ means");
}

double MapMaker::mean_absorbed(const Result& reference) const {
  const std::size_t b = reference.bands().size();
  double power = 0, area = 0;
  if (reference.has("organs/absorbed")) {
    const std::size_t plants =
        facets_->plant_facets < facets_->size ? facets_->organ(facets_->plant_facets, 1)[0] : reference.organ_count();
    for (std::size_t first = 0; first < plants; first += mapped_at_once) {
      const std::size_t count = std::min(mapped_at_once, plants - first);
      const auto rows = reference.state_rows<float>("organs/absorbed", choice_.state, first, count);
      for (std::size_t i = 0; i < count; ++i) power += rows[i * b + choice_.band];
      for (const float a : reference.rows<float>("organs/area", first, count)) area += a;
    }
  } else {
    for (std::size_t first = 0; first < facets_->plant_facets; first += mapped_at_once) {
      const std::size_t count = std::min(mapped_at_once, facets_->plant_facets - first);
      const auto rows = reference.state_rows<float>("facets/absorbed", choice_.state, first, count),
                 areas = reference.rows<float>("facets/area", first, count);
      for (std::size_t i = 0; i < count; ++i) power += static_cast<double>(areas[i]) * rows[i * b + choice_.band], area += areas[i];
    }
  }
  return area > 0 ? power / area : 0.0;
}

void MapMaker::error(bool organs_only) {
  if (!choice_.reference)
    throw UsageError(fmt::format("--quantity {}: found no reference; expected --reference RESULT.h5", choice_.quantity));
  const Result& reference = *choice_.reference;
  check_same_scene(reference, result_);
  const std::size_t b = result_.bands().size();
  const Column column{"absorbed", b, choice_.band, 0, false};
  // Facets only where both files keep them.
  const bool organs =
      by_organ(result_, column, organs_only || !reference.has("facets/absorbed")) || by_organ(reference, column, organs_only);
  const double mean = mean_absorbed(reference);
  if (!(mean > 0))
    throw InputError(location(reference.file(), 0, "absorbed"), "plants that absorb nothing in band " + result_.bands()[choice_.band],
                     "light to compare with");
  map_.values = [own = read_column(result_, column, organs), other = read_column(reference, column, organs), mean](std::size_t first,
                                                                                                                   std::size_t count) {
    auto out = own(first, count);
    const auto r = other(first, count);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(100 * (static_cast<double>(out[i]) - r[i]) / mean);
    return out;
  };
  map_.title = {"error " + result_.bands()[choice_.band], "% of mean absorbed"};
  if (organs) map_.title.insert(map_.title.begin() + 1, "organ means");
}

void MapMaker::names_of_organs(const char* index, const char* names) {
  const auto texts = result_.strings(names);
  auto rows = result_.all<std::uint32_t>(index);
  std::vector<std::uint32_t> shown(texts.size(), no_parent);
  for (auto& row : rows) {
    if (row >= texts.size())
      throw InputError(location(result_.file(), 0, index), "row " + std::to_string(row), "a row below " + std::to_string(texts.size()));
    if (shown[row] == no_parent) shown[row] = static_cast<std::uint32_t>(map_.names.size()), map_.names.push_back(texts[row]);
    row = shown[row];
  }
  map_.values = [rows = std::move(rows), facets = facets_](std::size_t first, std::size_t count) {
    std::vector<float> out;
    out.reserve(count);
    for (const auto organ : facets->organ(first, count)) out.push_back(static_cast<float>(rows[organ]));
    return out;
  };
}

ValueScale MapMaker::scale() const {
  const auto& range = choice_.range;
  if (!range.empty()) {
    const bool two = range.size() == 2;
    if (!two || !std::isfinite(range[0]) || !std::isfinite(range[1]) || !(range[0] < range[1]))
      throw UsageError(two ? fmt::format("--range: found {:g} {:g}; expected two finite numbers, the lower first", range[0], range[1])
                           : fmt::format("--range: found {} numbers; expected two", range.size()));
    if (choice_.logarithmic && !(range[0] > 0))
      throw UsageError(fmt::format("--range: found {:g} with --log; expected numbers above zero", range[0]));
    return {range[0], range[1], choice_.logarithmic};
  }
  const std::size_t end = facets_->plant_facets > 0 && !choice_.ground ? facets_->plant_facets : facets_->size, k = map_.sides ? 2 : 1;
  constexpr std::size_t most = std::size_t{1} << 24, blocks = most / mapped_at_once;
  const std::size_t all = (end + mapped_at_once - 1) / mapped_at_once, taken = std::min(all, blocks);
  std::vector<double> values;
  for (std::size_t i = 0; i < taken; ++i) {
    progress_.check();
    progress_.fraction("scale", static_cast<double>(i) / static_cast<double>(taken));
    const std::size_t first = i * all / taken * mapped_at_once, count = std::min(mapped_at_once, end - first);
    const auto rows = map_.values(first, count), area = facets_->area(first, count);
    for (std::size_t j = 0; j < rows.size(); ++j)
      if (area[j / k] > 0) values.push_back(rows[j]);
  }
  if (!has_two_signs(choice_.quantity)) return scale_for(std::move(values), choice_.logarithmic);
  for (auto& v : values) v = std::fabs(v);
  const double high = scale_for(std::move(values), false).high;
  return {-high, high, false};
}

MapSource MapMaker::make() {
  const std::size_t b = result_.bands().size(), band = choice_.band;
  std::string quantity = choice_.quantity;
  const bool organs_only = quantity.rfind("organ_", 0) == 0;
  if (organs_only) quantity = quantity.substr(6);
  const std::string unit = pretty_unit(result_.band_units().at(band)), in_band = " " + result_.bands().at(band);
  map_.map = choice_.map;

  if (quantity == "absorbed") {
    map_.title = {"absorbed" + in_band, unit};
    column({"absorbed", b, band, 0, false}, organs_only);
  } else if (quantity == "irradiance" || quantity == "irradiance_front" || quantity == "irradiance_back") {
    const bool sides = quantity == "irradiance", back = quantity == "irradiance_back";
    map_.title = {"irradiance" + in_band + (sides ? "" : back ? ", back" : ", front"), unit};
    column({"irradiance", 2 * b, back ? b + band : band, b, sides}, organs_only);
  } else if (quantity == "sunlit" || quantity == "sunlit_front" || quantity == "sunlit_back") {
    const bool sides = quantity == "sunlit", back = quantity == "sunlit_back";
    map_.title = {std::string("sunlit fraction") + (sides ? "" : back ? ", back" : ", front")};
    column({"sunlit", 2, back ? 1u : 0u, 1, sides}, organs_only);
    if (choice_.range.empty() && !choice_.logarithmic) {
      map_.scale = {0, 1, false};
      return std::move(map_);
    }
  } else if (quantity == "error") {
    if (choice_.logarithmic)
      throw UsageError("--log: found with --quantity " + choice_.quantity + ", which has both signs; expected a linear scale");
    error(organs_only);
  } else if (quantity == "area") {
    map_.title = {"facet area", pretty_unit("m^2")};
    map_.values = [facets = facets_](std::size_t first, std::size_t count) { return facets->area(first, count); };
  } else if (quantity == "height") {
    map_.title = {"height", "m"};
    map_.values = [facets = facets_](std::size_t first, std::size_t count) { return facets->height(first, count); };
  } else if (quantity == "organ" || quantity == "type" || quantity == "plant" || quantity == "placement") {
    map_.title = {quantity};
    names_of_organs(quantity == "organ" ? "organs/name" : ("organs/" + quantity).c_str(), ("names/" + quantity).c_str());
  } else if (quantity == "optics" || quantity == "level") {
    const bool level = quantity == "level";
    map_.title = level ? std::vector<std::string>{"structure level", "0 = plant"} : std::vector<std::string>{"optics"};
    if (level)
      for (int i = 0; i < 1024; ++i) map_.names.push_back(std::to_string(i));
    else
      for (const auto& m : result_.materials()) map_.names.push_back(m.name);
    map_.values = [facets = facets_, level](std::size_t first, std::size_t count) {
      const auto rows = level ? facets->level(first, count) : facets->optics(first, count);
      return std::vector<float>(rows.begin(), rows.end());
    };
  } else {
    const std::string nearest = nearest_name(choice_.quantity, quantity_names());
    throw UsageError(fmt::format("--quantity: found '{}'; expected one of {}{}", choice_.quantity, joined(quantity_names()),
                                 nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
  }
  if (map_.names.empty()) map_.scale = scale();
  return std::move(map_);
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
                                              "error",
                                              "organ_error",
                                              "area",
                                              "height",
                                              "organ",
                                              "type",
                                              "level",
                                              "plant",
                                              "placement",
                                              "optics"};
  return names;
}

bool has_two_signs(const std::string& quantity) {
  return quantity == "error" || quantity == "organ_error";
}

MapSource stored_map(const Result& result, const DrawnScene& scene, const MapChoice& choice, Progress& progress) {
  return MapMaker(result, lookup(scene), choice, progress).make();
}

FacetMap stored_map(const Result& result, const FacetScene& scene, const MapChoice& choice) {
  const MapSource source = MapMaker(result, lookup(scene, result), choice, silent()).make();
  return {source.title, source.sides, source.values(0, scene.size()), source.scale, source.map, source.names};
}

}  // namespace sunfleck
