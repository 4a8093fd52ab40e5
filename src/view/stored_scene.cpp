#include <algorithm>
#include <charconv>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/view/stored.hpp>

#include "view/facet_lookup.hpp"

namespace sunfleck {

namespace {

/// Organ of every facet where the file does not say: organs are numbered as their first facet comes, per copy and structure, then the
/// ground, two facets a cell or all of one mesh.
std::vector<std::uint32_t> derived_organs(const Result& result, const ResultGeometry& geometry) {
  std::vector<std::uint32_t> out;
  out.reserve(geometry.facet_count());
  std::uint32_t next = 0;
  for (const auto& copy : geometry.copies) {
    const Plant& plant = *geometry.plants[copy.plant].plant;
    std::vector<std::uint32_t> organ_of(plant.structures.size(), no_parent);
    for (const auto& shape : plant.shapes) {
      auto& organ = organ_of[shape.structure];
      if (organ == no_parent) organ = next++;
      out.insert(out.end(), shape.triangle_count, organ);
    }
  }
  const std::size_t left = result.organ_count() - std::min<std::size_t>(next, result.organ_count()),
                    ground = geometry.ground.triangles.size();
  for (std::size_t t = 0; t < ground; ++t) out.push_back(next + static_cast<std::uint32_t>(left == 1 ? 0 : t / 2));
  if (out.size() != geometry.facet_count() || (!out.empty() && *std::max_element(out.begin(), out.end()) >= result.organ_count()))
    throw InputError(location(result.file(), 0, "geometry"), "shapes that do not match the organs",
                     "facets that belong to the rows of /organs");
  return out;
}

std::size_t row_of(const std::string& what, const std::string& file, const std::string& name, const std::vector<std::string>& names) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  const std::string nearest = nearest_name(name, names);
  throw UsageError(fmt::format("--{}: found '{}'; expected one of those in {}: {}{}", what, name, file, joined(names),
                               nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
}

/// The sun of a state whose light is in the result: method occlusion leaves it out.
std::optional<Sun> beam_of(const Result& result, std::size_t state) {
  return result.header().method == "occlusion" ? std::nullopt : result.states().at(state).sun;
}

}  // namespace

FacetScene stored_scene(const Result& result, bool ground) {
  const ResultGeometry geometry = result.geometry();
  FacetScene scene;
  const std::size_t n = ground ? geometry.facet_count() : geometry.plant_facets;
  if (n == 0) throw InputError(result.file(), ground ? "no facet" : "no plant, only ground", "something to draw");
  scene.corners = geometry.corners(0, n);
  scene.optics = geometry.optics(0, n);
  scene.plant_facets = geometry.plant_facets;
  scene.materials = result.materials();
  scene.organs = result.organs();
  if (result.has("facets/organ")) {
    scene.organ = result.facet_organs(0, n);
  } else {
    scene.organ = derived_organs(result, geometry);
    scene.organ.resize(n);
  }
  scene.periodic = geometry.periodic;
  scene.bands = result.bands().size();
  scene.area.reserve(n);
  for (const auto& corners : scene.corners) {
    scene.area.push_back(static_cast<float>(glm::length(area_vector(corners))));
    if (scene.area.back() > 0.0f)
      for (const auto& p : corners) scene.bounds.add(p);
    else
      ++scene.zero_area_facets;
  }
  if (scene.bounds.empty()) throw InputError(result.file(), "only facets without area", "something to draw");
  return scene;
}

std::size_t state_row(const Result& result, const std::optional<std::string>& state) {
  std::vector<std::string> names;
  for (const auto& s : result.states()) names.push_back(s.name);
  return state_row(std::move(names), result.file(), state);
}

std::size_t state_row(std::vector<std::string> names, const std::string& file, const std::optional<std::string>& state) {
  if (!state) return 0;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(state->data(), state->data() + state->size(), number);
  const bool is_number = error == std::errc{} && end == state->data() + state->size() && number >= 1 && number <= names.size();
  if (is_number && std::find(names.begin(), names.end(), *state) == names.end()) return number - 1;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i].empty()) names[i] = std::to_string(i + 1);  // states without names go by their numbers
  return row_of("state", file, *state, names);
}

std::size_t band_row(const Result& result, const std::optional<std::string>& band) {
  if (band) return row_of("band", result.file(), *band, result.bands());
  const auto& names = result.bands();
  const auto par = std::find(names.begin(), names.end(), "PAR");
  return par == names.end() ? 0 : static_cast<std::size_t>(par - names.begin());
}

LightSource stored_light(const Result& result, const DrawnScene& scene, std::size_t state) {
  const std::size_t b = result.bands().size();
  LightSource light;
  light.bands = result.bands(), light.sun = beam_of(result, state);
  if (result.has("facets/irradiance")) {
    light.irradiance = [&result, state](std::size_t first, std::size_t count) {
      return result.state_rows<float>("facets/irradiance", state, first, count);
    };
    if (result.has("facets/sunlit"))
      light.sunlit = [&result, state](std::size_t first, std::size_t count) {
        return result.state_rows<float>("facets/sunlit", state, first, count);
      };
    return light;
  }
  if (!result.has("organs/irradiance"))
    throw InputError(location(result.file(), 0, "facets/irradiance"), "nothing",
                     "irradiance of facets or organs; [output] of the scene left both out");
  // The mean of an organ says nothing about where the sun falls on it: no sharp beam.
  // Organs are numbered as their facets come, so a range of facets needs a range of organs: there may be more of those than memory holds.
  light.irradiance = [&result, b, state, facets = lookup(scene)](std::size_t first, std::size_t count) {
    const auto organ = facets.organ(first, count);
    std::vector<float> out(2 * b * count);
    if (count == 0) return out;
    const auto [low, high] = std::minmax_element(organ.begin(), organ.end());
    const auto rows = result.state_rows<float>("organs/irradiance", state, *low, std::size_t{*high} - *low + 1);
    for (std::size_t i = 0; i < count; ++i)
      std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(2 * b * (organ[i] - *low)), 2 * b,
                  out.begin() + static_cast<std::ptrdiff_t>(2 * b * i));
    return out;
  };
  return light;
}

StateLight stored_light(const Result& result, const FacetScene& scene, std::size_t state) {
  const std::size_t n = scene.size(), b = result.bands().size();
  StateLight light;
  light.bands = result.bands(), light.sun = beam_of(result, state);
  if (result.has("facets/irradiance")) {
    light.irradiance = result.state_rows<float>("facets/irradiance", state, 0, n);
    if (result.has("facets/sunlit")) light.sunlit = result.state_rows<float>("facets/sunlit", state, 0, n);
    return light;
  }
  if (!result.has("organs/irradiance"))
    throw InputError(location(result.file(), 0, "facets/irradiance"), "nothing",
                     "irradiance of facets or organs; [output] of the scene left both out");
  // The mean of an organ says nothing about where the sun falls on it: no sharp beam.
  const auto organs = result.state_rows<float>("organs/irradiance", state, 0, result.organ_count());
  light.irradiance.resize(2 * n * b);
  for (std::size_t f = 0; f < n; ++f)
    std::copy_n(organs.begin() + static_cast<std::ptrdiff_t>(2 * b * scene.organ[f]), 2 * b,
                light.irradiance.begin() + static_cast<std::ptrdiff_t>(2 * b * f));
  return light;
}

}  // namespace sunfleck
