#include "instantiation/members.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/plant/describe.hpp>
#include <sunfleck/radiosity/interior.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/visibility/ground_gap.hpp>
#include <sunfleck/visibility/ground_pieces.hpp>

#include "instantiation/coincident.hpp"
#include "instantiation/member_surroundings.hpp"
#include "instantiation/organ_count.hpp"
#include "instantiation/stored_operators.hpp"
#include "instantiation/tangles.hpp"

namespace sunfleck {

namespace {

constexpr double tangled_share = 0.01;  // of lines inside a copy that meet another: from here on they are solved together
constexpr double crowded_share = 0.05;  // of lines inside a copy that meet others: from here on it is solved together with all of them
constexpr int most_rounds = 3;          // of putting together
constexpr std::uint32_t fewest_pixels_of_shades = 8;  // not at draft: the few lines of its sun would miss cells, which then count as dark
constexpr std::uint64_t most_merged_facets = 300'000;
constexpr std::uint64_t coarse_stream = 0x7d3f1c5b2e8a9604ULL;

}  // namespace

OperatorDensity coarse_density(const Scene& scene, const Original& original, OperatorDensity coarse) {
  if (original.parts.front().plant < scene.plants.size()) return coarse;
  coarse.directions = std::min(coarse.directions, 48u);
  coarse.field_pixels = std::max(1u, coarse.field_pixels / 2);
  return coarse;
}

OriginalLight original_light(const Scene& scene, const Approximation& approximation, const Original& original, double elements_per_organ,
                             const OperatorDensity& density, double fewest_organs, std::uint64_t seed, Progress& progress) {
  Scene own;
  own.file = scene.file;
  own.bands = scene.bands;
  own.band_units = scene.band_units;
  own.optics = scene.optics;
  OriginalLight out;
  out.facet_of_part.push_back(0);
  for (const auto& part : original.parts) {
    const auto& from = part.plant < scene.plants.size() ? scene.plants[part.plant] : approximation.pieces[part.plant - scene.plants.size()];
    PlantEntry entry;  // not a copy: placements may be millions
    entry.name = from.name;
    entry.plant = from.plant;
    entry.shape_optics = from.shape_optics;
    entry.placements = {{part.map}};
    const std::size_t entry_facets = entry.plant->facet_count();
    own.plants.push_back(std::move(entry));
    out.facet_of_part.push_back(out.facet_of_part.back() + static_cast<std::uint32_t>(entry_facets));
  }
  const FacetScene facets = expand(own);
  RadiositySettings settings;
  settings.density = density_of(Quality::standard);
  const double finer = times_finer(facets, fewest_organs);
  settings.density.elements_per_organ = elements_per_organ * finer;
  settings.density.fewest_organs = 1.0;  // see times_finer()
  if (density.field_pixels < fewest_pixels_of_shades) settings.density.least_unevenness = std::numeric_limits<double>::infinity();
  settings.density.sends_by_cell = false;  // operators hold counts of lines between elements
  out.elements = make_elements(own, facets, settings);
  out.facet_material = facets.optics;
  const double pitch = std::sqrt(0.5 * out.elements.patch_area / finer / density.lines_per_organ);
  out.interior = interior_of_cells(out.elements, interior_sides(out.elements, pitch, seed, progress));
  out.elements.patch_area /= finer;
  // no one asks for these any more
  out.elements.tree = {};
  out.elements.patch_of_row = {};
  out.elements.first_cell = {};
  out.elements.cells = {};
  return out;
}

std::size_t OriginalLight::bytes() const {
  return elements.bytes() + bytes_of(interior) + bytes_of(facet_material) + (coarse ? coarse->bytes() : 0);
}

void OriginalLight::forget() {
  Elements left;
  left.surface.origin = elements.surface.origin;
  left.patch_area = elements.patch_area;
  elements = std::move(left);
  interior = {};
  facet_material = {};
  coarse->forget_links();
}

std::size_t Members::bytes() const {
  std::size_t total = bytes_of(maps) + bytes_of(copies.copies) + bytes_of(copies.ground) + bytes_of(ground_parts);
  for (const auto& o : originals) total += o.bytes();
  for (const auto& piece : approximation.pieces) total += held_bytes(*piece.plant);
  return total;
}

namespace {

/// Plants that cover much of the box about all count as that box, however many of them a plan has placed.
std::vector<Box> without_gaps(std::vector<Box> boxes) {
  constexpr double much = 0.02;
  double covered = 0;
  Box all;
  for (const auto& b : boxes) {
    if (b.empty()) continue;
    covered += b.size().x * b.size().y;
    all.add(b);
  }
  return covered > much * all.size().x * all.size().y ? std::vector<Box>{all} : boxes;
}

/// Light on the ground varies over a tenth of a plant's size: larger facets are cut, those much larger where plants are near.
/// `part_placed`: not all copies are here, and the others may be anywhere.
void split_ground(const std::vector<Triangle>& ground, bool part_placed, Members& out) {
  constexpr double most_parts = 40'000.0, most_pieces = 10'000.0;
  constexpr int most_split = 4;
  double plant = 0, facet = 0;
  std::vector<Box> boxes;
  for (const auto& copy : out.copies.copies) {
    const auto& surface = *out.copies.surfaces[copy.surface];
    const Vec3 size = surface.focus.size();
    plant += std::cbrt(std::fabs(glm::determinant(copy.map.linear))) * std::max({size.x, size.y, size.z});
    boxes.push_back(copy_bounds(surface, copy.map));
  }
  for (const auto& t : ground) facet += std::sqrt(glm::length(area_vector(t)));
  out.copies.ground.clear();
  out.ground_parts = {0};
  const bool whole = out.copies.copies.empty() || ground.empty() || !(plant > 0);
  const double aim = whole ? 0.0 : 0.1 * plant / static_cast<double>(out.copies.copies.size());
  const double wanted = whole ? 1.0 : facet / static_cast<double>(ground.size()) / aim;
  const double affordable = std::sqrt(most_parts / static_cast<double>(std::max<std::size_t>(1, ground.size())));
  const int k = std::clamp(static_cast<int>(std::lround(std::min(wanted, affordable))), 1, most_split);
  const bool much_too_wide = wanted > 4.0 * most_split;
  if (much_too_wide && out.copies.periodic)
    boxes = {Box{{out.copies.periodic->x_low, out.copies.periodic->y_low, 0.0},
                 {out.copies.periodic->x_high, out.copies.periodic->y_high, 0.0}}};
  if (much_too_wide && part_placed)
    for (const auto& t : ground)
      for (const auto& p : t) boxes.front().add(p);
  if (much_too_wide) boxes = without_gaps(std::move(boxes));
  const Footprints footprints(much_too_wide ? std::move(boxes) : std::vector<Box>{});
  const double finest = std::sqrt(2.0) * std::max(aim, std::sqrt(footprints.area(0.0) / most_pieces));
  for (const auto& t : ground) {
    const auto at = [&](int i, int j) { return t[0] + (t[1] - t[0]) * (double(i) / k) + (t[2] - t[0]) * (double(j) / k); };
    const auto pieces = much_too_wide ? cut_ground_facet(t, footprints, finest) : std::vector<GroundPiece>{};
    if (pieces.size() > static_cast<std::size_t>(k) * k)
      for (const auto& piece : pieces) out.copies.ground.push_back(piece.corners);
    else
      for (int j = 0; j < k; ++j)
        for (int i = 0; i + j < k; ++i) {
          out.copies.ground.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
          if (i + j + 1 < k) out.copies.ground.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    out.ground_parts.push_back(static_cast<std::uint32_t>(out.copies.ground.size()));
  }
}

/// What lies on the ground lies above it.
void lower_ground(Members& out) {
  Box plants;
  for (const auto& copy : out.copies.copies) plants.add(copy_bounds(*out.copies.surfaces[copy.surface], copy.map));
  Box all = plants;
  for (const auto& t : out.copies.ground)
    for (const auto& p : t) all.add(p);
  const GroundGap gap(plants, all);
  out.copies.ground_gap = gap.metres();
  for (auto& t : out.copies.ground) t = gap.lowered(t);
}

/// All of an original that its elements and operators follow from.
void put_original(ContentKey& key, const Scene& scene, const Approximation& approximation, const Original& original) {
  key.put(static_cast<std::uint64_t>(scene.optics.size()));
  for (const auto& o : scene.optics) put_optics(key, o);
  for (const auto& part : original.parts) {
    const auto& entry =
        part.plant < scene.plants.size() ? scene.plants[part.plant] : approximation.pieces[part.plant - scene.plants.size()];
    put_plant(key, *entry.plant);
    key.put(entry.shape_optics), key.put(part.map);
  }
}

Members with_light(const Scene& scene, const PlacedScene& placed, Approximation approximation, Originals found,
                   const OperatorDensity& coarse, double elements_per_organ, std::uint64_t seed, Progress& progress, OperatorStore* store) {
  Members out;
  out.approximation = std::move(approximation);
  out.found = std::move(found);
  out.stand_in = find_stand_ins(out.found);
  out.originals.reserve(out.found.originals.size() + 1);  // `copies` points into it, and one more comes when a plant is opened
  const auto fewest = fewest_organs(scene, out.found);
  for (std::size_t o = 0; o < out.found.originals.size(); ++o) {
    progress.check();
    progress.fraction("originals", static_cast<double>(o) / static_cast<double>(out.found.originals.size()));
    const auto& original = out.found.originals[o];
    const auto density = coarse_density(scene, original, coarse);
    const auto make = [&] {
      auto light = original_light(scene, out.approximation, original, elements_per_organ, coarse, fewest[o], seed, progress);
      light.coarse = std::make_unique<LineOperator>(light.elements, light.interior, density, mix(seed, coarse_stream, o), progress);
      return light;
    };
    if (store) {
      ContentKey key("original");
      put_original(key, scene, out.approximation, original);
      key.put(elements_per_organ), put_density(key, coarse), put_density(key, density);
      key.put(fewest[o]), key.put(seed), key.put(static_cast<std::uint64_t>(o));
      out.originals.push_back(store->entries().original(key.hex(), make));
    } else {
      out.originals.push_back(make());
    }
    auto& light = out.originals.back();
    out.made_with = std::max(out.made_with, out.bytes() - light.coarse->bytes() + light.coarse->built_with());
  }
  for (const auto& o : out.originals) out.copies.surfaces.push_back(&o.elements.surface);
  for (const auto& m : out.found.members) {
    out.maps.push_back(m.map);
    out.copies.copies.push_back({m.original, m.map.affine()});
  }
  out.copies.periodic = scene.periodic;
  split_ground(placed.partial ? placed.near_ground : placed.ground.written_out(), placed.share < 1.0, out);
  out.copies.ground.insert(out.copies.ground.end(), placed.far_ground.begin(), placed.far_ground.end());
  lower_ground(out);
  return out;
}

/// Members to put together, the most tangled first: pairs that reach into each other, and one that is crowded with all that stand in it.
std::vector<std::vector<std::uint32_t>> groups_of(const Members& members, std::vector<Tangle> list) {
  const auto spoilt = spoilt_shares(members, list);
  for (const auto& [a, b] : coincident_members(members)) list.push_back({1.0, a, b});
  std::stable_sort(list.begin(), list.end(), [](const Tangle& a, const Tangle& b) { return a.share > b.share; });
  std::vector<std::uint32_t> root(members.size());
  std::vector<std::uint64_t> facets(members.size());
  std::vector<bool> composed(members.size(), false);
  std::uint64_t unique = 0, spent = 0;  // facets of originals, and of those put together
  for (std::uint32_t m = 0; m < root.size(); ++m) {
    root[m] = m;
    facets[m] = members.found.originals[members.found.members[m].original].facets;
  }
  for (const auto& o : members.found.originals) unique += o.facets;
  const auto find = [&](std::uint32_t m) {
    while (root[m] != m) m = root[m] = root[root[m]];
    return m;
  };
  for (const auto& t : list) {
    if (t.b == MemberSurroundings::the_ground || (t.share <= tangled_share && spoilt[t.a] <= crowded_share)) continue;
    const auto a = find(t.a), b = find(t.b);
    if (a == b || members.found.members[t.a].stands_in || members.found.members[t.b].stands_in) continue;
    const auto more = (composed[a] ? 0 : facets[a]) + (composed[b] ? 0 : facets[b]);
    if (spent + more > most_merged_facets + unique) continue;
    spent += more;
    root[b] = a;
    facets[a] += facets[b];
    composed[a] = true;
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_root;
  for (std::uint32_t m = 0; m < root.size(); ++m) by_root[find(m)].push_back(m);
  std::vector<std::vector<std::uint32_t>> groups;
  for (auto& [r, list_of_root] : by_root)
    if (list_of_root.size() > 1) groups.push_back(std::move(list_of_root));
  return groups;
}

}  // namespace

Members make_members(const Scene& scene, const PlacedScene& placed, const Classification* classes, const OperatorDensity& coarse,
                     double elements_per_organ, std::uint64_t seed, Progress& progress, OperatorStore* store) {
  Approximation approximation;
  approximation.of_plant.resize(scene.plants.size());
  if (classes) approximation = approximate(scene, placed, *classes);
  if (approximation.closed > 0)
    progress.line(fmt::format("approximate instancing: {} pieces of plants stand for {} structures until these are opened",
                              approximation.pieces.size(), approximation.closed));
  auto originals = find_originals(scene, placed, approximation);
  Members members =
      with_light(scene, placed, std::move(approximation), std::move(originals), coarse, elements_per_organ, seed, progress, store);
  for (int round = 0;; ++round) {
    const auto list = tangles(members, MemberSurroundings(members), progress);
    members.tangled = mean_share(members, list);
    if (round == most_rounds || (round > 0 && members.tangled <= much_tangled)) break;
    const auto groups = groups_of(members, list);
    if (groups.empty()) break;
    auto found = merged(members.found, groups);
    approximation = std::move(members.approximation);
    const auto made_apart = members.made_with;
    members = {};
    members = with_light(scene, placed, std::move(approximation), std::move(found), coarse, elements_per_organ, seed, progress, store);
    members.made_with = std::max(members.made_with, made_apart);
  }
  std::uint64_t groups = 0;
  for (std::size_t m = 0; m < members.size(); ++m)
    if (const auto copies = members.found.members[m].copies.size(); copies > 1) members.merged += copies, ++groups;
  if (groups > 0) progress.line(fmt::format("{} copies reach into each other and are solved as {}", members.merged, groups));
  return members;
}

}  // namespace sunfleck
