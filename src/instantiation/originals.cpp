#include "instantiation/originals.hpp"

#include <algorithm>
#include <map>
#include <optional>

namespace sunfleck {

namespace {

/// Plants that are the same for light: one mesh, one set of optics.
std::vector<std::uint32_t> first_alike(const Scene& scene) {
  std::vector<std::uint32_t> out(scene.plants.size());
  for (std::uint32_t p = 0; p < out.size(); ++p) {
    out[p] = p;
    for (std::uint32_t q = 0; q < p; ++q)
      if (scene.plants[q].plant == scene.plants[p].plant && scene.plants[q].shape_optics == scene.plants[p].shape_optics) {
        out[p] = q;
        break;
      }
  }
  return out;
}

bool same_linear(const Mat3& a, const Mat3& b, double tolerance) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::fabs(a[i][j] - b[i][j]) > tolerance) return false;
  return true;
}

bool same_parts(const Original& a, const Original& b) {
  if (a.parts.size() != b.parts.size()) return false;
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    const auto &p = a.parts[i], &q = b.parts[i];
    if (p.plant != q.plant || !same_linear(p.map.linear, q.map.linear, 1e-9) ||
        glm::length(p.map.translation - q.map.translation) > 1e-9 * (1e-12 + glm::length(p.map.translation)))
      return false;
  }
  return true;
}

}  // namespace

namespace {

/// The members that stand for a copy of a plant: one for each of its pieces.
void add_pieces(const Scene& scene, const Approximation& approximation, std::uint32_t plant, std::uint32_t copy, const Affine& map,
                std::map<std::uint32_t, std::uint32_t>& known, Originals& out) {
  for (const auto& piece : approximation.of_plant[plant]) {
    const auto [place, added] = known.try_emplace(piece.piece, static_cast<std::uint32_t>(out.originals.size()));
    if (added)
      out.originals.push_back({{{static_cast<std::uint32_t>(scene.plants.size()) + piece.piece, Affine{}}},
                               approximation.pieces[piece.piece].plant->facet_count()});
    Member member;
    member.original = place->second;
    member.map = *similarity_of(map * piece.map);
    member.copies = {copy};
    member.stands_in = true;
    out.members.push_back(std::move(member));
  }
}

}  // namespace

Originals find_originals(const Scene& scene, const PlacedScene& placed, const Approximation& approximation) {
  Originals out;
  const auto alike = first_alike(scene);
  std::map<std::uint32_t, std::uint32_t> plain;                   // plant -> original without a stretch
  std::map<std::uint32_t, std::vector<std::uint32_t>> stretched;  // plant -> originals with one
  std::map<std::uint32_t, std::uint32_t> pieces;                  // row of Approximation::pieces -> original
  for (std::uint32_t c = 0; c < placed.all_copies(); ++c) {
    const Affine& map = placed.map_of(c);
    const std::uint32_t plant = alike[placed.plant_of(c)];
    if (c == placed.solved()) out.solved = out.members.size();
    if (!approximation.of_plant[placed.plant_of(c)].empty() && similarity_of(map)) {
      add_pieces(scene, approximation, placed.plant_of(c), c, map, pieces, out);
      continue;
    }
    Member member;
    member.copies = {c};
    if (const auto similarity = similarity_of(map)) {
      const auto [place, added] = plain.try_emplace(plant, static_cast<std::uint32_t>(out.originals.size()));
      if (added) out.originals.push_back({{{plant, Affine{}}}, placed.plant_facets[plant]});
      member.original = place->second;
      member.map = *similarity;
    } else {
      auto& known = stretched[plant];
      const double size = glm::length(map.linear[0]) + glm::length(map.linear[1]) + glm::length(map.linear[2]);
      const auto same = std::find_if(known.begin(), known.end(), [&](std::uint32_t o) {
        return same_linear(out.originals[o].parts[0].map.linear, map.linear, 1e-9 * size);
      });
      member.original = same != known.end() ? *same : static_cast<std::uint32_t>(out.originals.size());
      if (same == known.end()) {
        known.push_back(member.original);
        out.originals.push_back({{{plant, Affine{map.linear, Vec3{0.0}}}}, placed.plant_facets[plant]});
      }
      member.map.move = map.translation;
    }
    out.members.push_back(std::move(member));
  }
  if (placed.far.empty()) out.solved = out.members.size();
  return out;
}

std::vector<std::uint32_t> find_stand_ins(Originals& o) {
  std::vector<std::vector<std::uint32_t>> solved(o.originals.size());
  for (std::uint32_t m = 0; m < o.solved; ++m) solved[o.members[m].original].push_back(m);
  for (std::size_t m = o.solved; m < o.members.size(); ++m) {
    auto& list = solved[o.members[m].original];
    if (!list.empty()) continue;
    list.push_back(static_cast<std::uint32_t>(o.solved));
    std::rotate(o.members.begin() + static_cast<std::ptrdiff_t>(o.solved), o.members.begin() + static_cast<std::ptrdiff_t>(m),
                o.members.begin() + static_cast<std::ptrdiff_t>(m) + 1);
    ++o.solved;
  }
  std::vector<std::size_t> next(o.originals.size(), 0);
  std::vector<std::uint32_t> out;
  for (std::size_t m = o.solved; m < o.members.size(); ++m) {
    const auto& list = solved[o.members[m].original];
    out.push_back(list[next[o.members[m].original]++ % list.size()]);
  }
  return out;
}

Originals merged(const Originals& from, const std::vector<std::vector<std::uint32_t>>& groups) {
  Originals out;
  std::vector<std::uint32_t> group_of(from.members.size(), no_parent);
  for (std::uint32_t g = 0; g < groups.size(); ++g)
    for (const auto m : groups[g]) group_of[m] = g;
  std::map<std::uint32_t, std::uint32_t> kept;  // original of `from` -> original of `out`
  std::vector<std::uint32_t> composites;
  std::vector<bool> done(groups.size(), false);
  for (std::uint32_t m = 0; m < from.members.size(); ++m) {
    const auto g = group_of[m];
    if (m < from.solved && (g == no_parent || !done[g])) ++out.solved;
    if (g == no_parent) {
      const auto [place, added] = kept.try_emplace(from.members[m].original, static_cast<std::uint32_t>(out.originals.size()));
      if (added) out.originals.push_back(from.originals[from.members[m].original]);
      out.members.push_back(from.members[m]);
      out.members.back().original = place->second;
      continue;
    }
    if (done[g]) continue;
    done[g] = true;
    auto group = groups[g];
    std::sort(group.begin(), group.end());
    Member member;
    member.map = from.members[group.front()].map;
    Original original;
    for (const auto k : group) {
      const auto& part = from.members[k];
      Similarity relative;  // the part's frame -> the frame of the first
      relative.scale = part.map.scale / member.map.scale;
      relative.turn = glm::transpose(member.map.turn) * part.map.turn;
      relative.move = member.map.point_back(part.map.move);
      for (const auto& p : from.originals[part.original].parts) original.parts.push_back({p.plant, relative.affine() * p.map});
      member.copies.insert(member.copies.end(), part.copies.begin(), part.copies.end());
      original.facets += from.originals[part.original].facets;
    }
    const auto same =
        std::find_if(composites.begin(), composites.end(), [&](std::uint32_t o) { return same_parts(out.originals[o], original); });
    member.original = same != composites.end() ? *same : static_cast<std::uint32_t>(out.originals.size());
    if (same == composites.end()) {
      composites.push_back(member.original);
      out.originals.push_back(std::move(original));
    }
    out.members.push_back(std::move(member));
  }
  return out;
}

}  // namespace sunfleck
