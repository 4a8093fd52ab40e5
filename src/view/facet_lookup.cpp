#include "view/facet_lookup.hpp"

#include <memory>

namespace sunfleck {

namespace {

float area_of(const Triangle& c) {
  return static_cast<float>(glm::length(area_vector(c)));
}
float height_of(const Triangle& c) {
  return static_cast<float>((c[0].z + c[1].z + c[2].z) / 3);
}

}  // namespace

FacetLookup lookup(const DrawnScene& scene) {
  FacetLookup out;
  out.size = scene.size(), out.plant_facets = scene.plant_facets();
  const auto by_run = [&scene](auto value) {
    return [&scene, value](std::size_t first, std::size_t count) {
      std::vector<std::uint32_t> rows(count);
      scene.each_run(first, count, [&](const DrawnScene::Place& p, std::size_t n, std::size_t at) {
        std::fill_n(rows.begin() + static_cast<std::ptrdiff_t>(at), n, value(p));
      });
      return rows;
    };
  };
  out.organ = [&scene](std::size_t first, std::size_t count) {
    std::vector<std::uint32_t> rows(count);
    scene.each_run(first, count, [&](DrawnScene::Place p, std::size_t n, std::size_t at) {
      const bool ground = scene.is_ground(p);  // where every two facets are an organ
      const auto organ = scene.organ(p);
      for (std::size_t i = 0; i < n; ++i, ++p.triangle) rows[at + i] = ground ? scene.organ(p) : organ;
    });
    return rows;
  };
  out.optics = by_run([&scene](const DrawnScene::Place& p) { return scene.optics(p); });
  out.level = by_run([&scene](const DrawnScene::Place& p) { return scene.level(p); });
  const auto by_corners = [&scene](auto value) {
    return [&scene, value](std::size_t first, std::size_t count) {
      std::vector<float> rows(count);
      scene.each_run(first, count, [&](DrawnScene::Place p, std::size_t n, std::size_t at) {
        for (std::size_t i = 0; i < n; ++i, ++p.triangle) rows[at + i] = value(scene.corners(p));
      });
      return rows;
    };
  };
  out.area = by_corners(area_of), out.height = by_corners(height_of);
  return out;
}

FacetLookup lookup(const FacetScene& scene, const Result& result) {
  FacetLookup out;
  out.size = scene.size(), out.plant_facets = scene.plant_facets;
  const auto part = [](const auto& column) {
    return [&column](std::size_t first, std::size_t count) {
      const auto begin = column.begin() + static_cast<std::ptrdiff_t>(first);
      return std::vector(begin, begin + static_cast<std::ptrdiff_t>(count));
    };
  };
  out.organ = part(scene.organ), out.optics = part(scene.optics), out.area = part(scene.area);
  out.level = [&result, drawn = std::shared_ptr<DrawnScene>()](std::size_t first, std::size_t count) mutable {
    if (!drawn) drawn = std::make_shared<DrawnScene>(result);
    return lookup(*drawn).level(first, count);
  };
  out.height = [&scene](std::size_t first, std::size_t count) {
    std::vector<float> rows;
    for (std::size_t f = first; f < first + count; ++f) rows.push_back(height_of(scene.corners[f]));
    return rows;
  };
  return out;
}

}  // namespace sunfleck
