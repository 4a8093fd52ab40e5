#include <sunfleck/result/scene_match.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t compared_at_once = std::size_t{1} << 18;
constexpr double area_tolerance = 1e-4, place_tolerance = 1e-3, scene_tolerance = 1e-6;

using Difference = std::optional<SceneMatch::Difference>;

Difference counted(const char* what, std::size_t found, std::size_t expected) {
  if (found == expected) return std::nullopt;
  return SceneMatch::Difference{fmt::format("{} {}", found, what), fmt::format("{}", expected)};
}

Difference area_difference(const Result& x, const Result& r) {
  for (std::size_t first = 0; first < r.organ_count(); first += compared_at_once) {
    const std::size_t count = std::min(compared_at_once, r.organ_count() - first);
    const auto a = x.rows<float>("organs/area", first, count), b = r.rows<float>("organs/area", first, count);
    // slivers of rounding have the area that a compiler's order of operations gives them: zero, or next to it
    const float nothing = 1e-9f * *std::max_element(b.begin(), b.end());
    for (std::size_t o = 0; o < count; ++o)
      if (std::abs(a[o] - b[o]) > static_cast<float>(area_tolerance) * std::max(a[o], b[o]) + nothing)
        return SceneMatch::Difference{fmt::format("organ {} with an area of {} m^2", first + o, a[o]), fmt::format("{} m^2", b[o])};
  }
  return std::nullopt;
}

std::string cell_text(const std::optional<PeriodicCell>& cell) {
  if (cell && !cell->is_level())
    return fmt::format("a cell from ({:g}, {:g}) to ({:g}, {:g}) that repeats along a slope of [{:g}, {:g}]", cell->x_low, cell->y_low,
                       cell->x_high, cell->y_high, cell->slope_x, cell->slope_y);
  return cell ? fmt::format("a cell from ({:g}, {:g}) to ({:g}, {:g}) that repeats", cell->x_low, cell->y_low, cell->x_high, cell->y_high)
              : "nothing that repeats";
}

std::string point_text(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

Vec3 centre(const Triangle& t) {
  return (t[0] + t[1] + t[2]) / 3.0;
}

double longest_edge(const Triangle& t) {
  return std::max({glm::length(t[1] - t[0]), glm::length(t[2] - t[1]), glm::length(t[0] - t[2])});
}

/// Meshes against meshes: where facets lie and which way they face.
Difference mesh_difference(const ResultGeometry& x, const ResultGeometry& r) {
  if (auto found = counted("facets", x.facet_count(), r.facet_count())) return found;
  if (auto found = counted("facets of plants", x.plant_facets, r.plant_facets)) return found;
  if (cell_text(x.periodic) != cell_text(r.periodic)) return SceneMatch::Difference{cell_text(x.periodic), cell_text(r.periodic)};
  Box box;
  for (std::size_t first = 0; first < r.facet_count(); first += compared_at_once)
    for (const auto& corners : r.corners(first, std::min(compared_at_once, r.facet_count() - first)))
      for (const auto& p : corners) box.add(p);
  const double near = box.empty() ? 0 : scene_tolerance * glm::length(box.high - box.low);
  for (std::size_t first = 0; first < r.facet_count(); first += compared_at_once) {
    const std::size_t count = std::min(compared_at_once, r.facet_count() - first);
    const auto a = x.corners(first, count), b = r.corners(first, count);
    for (std::size_t f = 0; f < count; ++f) {
      const Vec3 front_a = area_vector(a[f]), front_b = area_vector(b[f]);
      const double area = glm::length(front_b), slack = near * longest_edge(b[f]);
      if (!(area > 0) && !(glm::length(front_a) > 0)) continue;
      if (glm::length(centre(a[f]) - centre(b[f])) > place_tolerance * std::sqrt(area) + near)
        return SceneMatch::Difference{fmt::format("facet {} at {} m", first + f, point_text(centre(a[f]))),
                                      point_text(centre(b[f])) + " m"};
      if (glm::length(front_a - front_b) > 2 * place_tolerance * area + slack)
        return SceneMatch::Difference{
            fmt::format("facet {} of {:.6g} m^2 that faces {}", first + f, glm::length(front_a), point_text(glm::normalize(front_a))),
            fmt::format("{:.6g} m^2 that face {}", area, point_text(glm::normalize(front_b)))};
    }
  }
  return std::nullopt;
}

/// Where only centroids are kept.
Difference centroid_difference(const Result& x, const Result& r) {
  const auto point = [](const std::vector<double>& all, std::size_t i) { return Vec3{all[3 * i], all[3 * i + 1], all[3 * i + 2]}; };
  for (std::size_t first = 0; first < r.facet_count(); first += compared_at_once) {
    const std::size_t count = std::min(compared_at_once, r.facet_count() - first);
    const auto a = x.rows<double>("facets/centroid", first, count), b = r.rows<double>("facets/centroid", first, count);
    const auto area = r.rows<float>("facets/area", first, count);
    for (std::size_t f = 0; f < count; ++f) {
      const Vec3 p = point(a, f), q = point(b, f);
      if (area[f] > 0 && glm::length(p - q) > place_tolerance * std::sqrt(area[f]) + scene_tolerance * glm::length(q))
        return SceneMatch::Difference{fmt::format("facet {} at {} m", first + f, point_text(p)), point_text(q) + " m"};
    }
  }
  return std::nullopt;
}

Difference place_difference(const Result& x, const Result& r) {
  if (x.has("geometry") && r.has("geometry")) return mesh_difference(x.geometry(), r.geometry());
  const bool centroids = x.facet_count() > 0 && x.facet_count() == r.facet_count() && r.has("facets/area") && x.has("facets/centroid") &&
                         r.has("facets/centroid");
  return centroids ? centroid_difference(x, r) : std::nullopt;
}

Difference difference(const Result& x, const Result& r, bool places) {
  if (x.bands() != r.bands()) return SceneMatch::Difference{"bands " + joined(x.bands()), "bands " + joined(r.bands())};
  if (auto found = counted("lighting states", x.states().size(), r.states().size())) return found;
  if (auto found = counted("organs", x.organ_count(), r.organ_count())) return found;
  if (x.facet_count() > 0 && r.facet_count() > 0)
    if (auto found = counted("facets", x.facet_count(), r.facet_count())) return found;
  if (auto found = area_difference(x, r)) return found;
  return places ? place_difference(x, r) : std::nullopt;
}

bool alike(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

template <class T>
bool all_alike(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](T u, T v) { return alike(u, v); });
}

bool same_sun(const std::optional<Sun>& a, const std::optional<Sun>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return glm::length(a->direction - b->direction) < 1e-9 && alike(a->angular_diameter_deg, b->angular_diameter_deg) &&
         all_alike(a->irradiance, b->irradiance);
}

bool same_sky(const std::optional<Sky>& a, const std::optional<Sky>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->model == b->model && all_alike(a->irradiance, b->irradiance);
}

/// "sun of noon, sky of noon, ..." of at most a few states.
void note_light(const Result& x, const Result& r, std::vector<std::string>& notes) {
  std::vector<std::string> parts;
  for (std::size_t s = 0; s < r.states().size(); ++s) {
    const auto &a = x.states()[s], &b = r.states()[s];
    const std::string of = r.states().size() == 1 ? "" : fmt::format(" of state {}", b.name.empty() ? std::to_string(s + 1) : b.name);
    if (!same_sun(a.sun, b.sun)) parts.push_back("sun" + of);
    if (!same_sky(a.sky, b.sky)) parts.push_back("sky" + of);
    if (a.name != b.name) parts.push_back(fmt::format("name of state {} ('{}' and '{}')", s + 1, a.name, b.name));
  }
  const auto lamps_x = x.lamps(), lamps_r = r.lamps();
  const auto same = [](const StoredLamp& a, const StoredLamp& b) {
    return a.name == b.name && a.copies == b.copies && a.shines == b.shines && all_alike(a.power, b.power);
  };
  if (!std::equal(lamps_x.begin(), lamps_x.end(), lamps_r.begin(), lamps_r.end(), same)) parts.push_back("lamps");
  if (parts.empty()) return;
  constexpr std::size_t most = 6;
  const std::size_t more = parts.size() - std::min(parts.size(), most);
  parts.resize(parts.size() - more);
  notes.push_back("their light differs: " + joined(parts) + (more > 0 ? fmt::format(" and {} more", more) : ""));
}

void note_optics(const Result& x, const Result& r, std::vector<std::string>& notes) {
  const auto a = x.materials(), b = r.materials();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (!all_alike(a[i].reflectance_front, b[i].reflectance_front) || !all_alike(a[i].reflectance_back, b[i].reflectance_back) ||
        !all_alike(a[i].transmittance, b[i].transmittance))
      names.push_back(b[i].name);
  if (a.size() != b.size())
    notes.push_back(fmt::format("their optics differ: {} materials and {}", a.size(), b.size()));
  else if (!names.empty())
    notes.push_back("their optics differ: " + joined(names));
}

void note_names(const Result& x, const Result& r, std::vector<std::string>& notes) {
  for (const char* what : {"plant", "type"}) {
    const std::string rows = std::string("organs/") + what, table = std::string("names/") + what;
    if (!x.has(rows) || !r.has(rows)) continue;
    const auto names_x = x.strings(table), names_r = r.strings(table);
    bool differ = false;
    for (std::size_t first = 0; first < r.organ_count() && !differ; first += compared_at_once) {
      const std::size_t count = std::min(compared_at_once, r.organ_count() - first);
      const auto a = x.rows<std::uint32_t>(rows, first, count), b = r.rows<std::uint32_t>(rows, first, count);
      for (std::size_t o = 0; o < count && !differ; ++o) {
        if (a[o] >= names_x.size() || b[o] >= names_r.size() || names_x[a[o]] == names_r[b[o]]) continue;
        notes.push_back(fmt::format("their organs are named otherwise: organ {} has the {} '{}' and '{}'", first + o, what, names_x[a[o]],
                                    names_r[b[o]]));
        differ = true;
      }
    }
  }
}

}  // namespace

SceneMatch match_scenes(const Result& result, const Result& reference, bool places) {
  SceneMatch match;
  match.difference = difference(result, reference, places);
  if (match.difference) return match;
  note_light(result, reference, match.notes);
  note_optics(result, reference, match.notes);
  note_names(result, reference, match.notes);
  return match;
}

std::vector<std::string> check_same_scene(const Result& result, const Result& reference, bool places) {
  auto match = match_scenes(result, reference, places);
  if (match.difference)
    throw InputError(result.file(), match.difference->found,
                     match.difference->expected + " as in " + reference.file() + "; only results of the same scene can be compared");
  return std::move(match.notes);
}

}  // namespace sunfleck
