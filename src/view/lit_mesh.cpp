#include "view/lit_mesh.hpp"

#include <sunfleck/core/error.hpp>

#include "view/mesh_columns.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t facets_at_once = std::size_t{1} << 16;

ResultGeometry checked_geometry(const Result& result) {
  expect_facets(result);
  return result.geometry();
}

}  // namespace

LitMesh::LitMesh(const Result& result)
    : geometry_(checked_geometry(result)),
      patches_(geometry_, geometry_.ground.triangles.empty()
                              ? std::vector<std::uint32_t>{}
                              : result.facet_organs(geometry_.plant_facets, geometry_.ground.triangles.size())) {}

void LitMesh::for_each_batch(Progress& progress, double begin, double end, const Work& work) const {
  const std::size_t n = facet_count();
  patches_.for_each_batch(facets_at_once, [&](std::span<const PlacedPatch> batch) {
    progress.check();
    const std::size_t first = batch.front().first_facet, count = batch.back().first_facet + batch.back().facets() - first;
    work(batch, first, count);
    progress.fraction("export", begin + (end - begin) * static_cast<double>(first + count) / static_cast<double>(n));
  });
}

std::string placement_name(const Result& result, const ResultGeometry& geometry, const std::vector<std::string>& names, std::size_t copy) {
  if (copy == geometry.copies.size()) return "ground";
  const std::size_t facet = geometry.copies[copy].first_facet;
  const auto organ = result.facet_organs(facet, 1).front();
  const auto row = result.rows<std::uint32_t>("organs/placement", organ, 1).front();
  if (row >= names.size())
    throw InputError(location(result.file(), 0, "organs/placement"), "row " + std::to_string(row),
                     "a row below " + std::to_string(names.size()));
  return names[row];
}

}  // namespace sunfleck
