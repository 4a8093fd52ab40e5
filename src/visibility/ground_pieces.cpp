#include <sunfleck/visibility/ground_pieces.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sunfleck/visibility/surface.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t most_boxes = 1024;
constexpr std::uint32_t deepest_level = 14;  // 2^14 pieces along an edge

std::uint64_t key_of(std::uint32_t level, std::uint32_t number) {
  return std::uint64_t{level} << 32 | number;
}

/// One of the 4^level triangles of a facet: lower ones begin at lattice point (i, j), upper ones end there.
struct LatticeTriangle {
  std::uint32_t level, i, j;
  bool upper;

  Triangle corners(const Triangle& t) const {
    const double k = static_cast<double>(std::uint32_t{1} << level);
    const auto at = [&](std::uint32_t a, std::uint32_t b) { return t[0] + (a / k) * (t[1] - t[0]) + (b / k) * (t[2] - t[0]); };
    return upper ? Triangle{at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)} : Triangle{at(i, j), at(i + 1, j), at(i, j + 1)};
  }
  std::uint32_t number() const {
    const std::uint32_t k = std::uint32_t{1} << level;
    return j * (2 * k - j) + 2 * i + (upper ? 1 : 0);
  }
};

void cut(const Triangle& facet, const LatticeTriangle& piece, const Footprints& plants, double finest, std::vector<GroundPiece>& out) {
  const Triangle corners = piece.corners(facet);
  const double size = std::sqrt(2.0 * glm::length(area_vector(corners)));
  if (piece.level == deepest_level || size <= std::max(finest, 0.5 * plants.distance(corners))) {
    out.push_back({corners, piece.level, piece.number()});
    return;
  }
  const std::uint32_t level = piece.level + 1, i = 2 * piece.i, j = 2 * piece.j;
  if (piece.upper)
    for (const auto& part :
         {LatticeTriangle{level, i + 1, j, true}, {level, i, j + 1, true}, {level, i + 1, j + 1, false}, {level, i + 1, j + 1, true}})
      cut(facet, part, plants, finest, out);
  else
    for (const auto& part : {LatticeTriangle{level, i, j, false}, {level, i, j, true}, {level, i + 1, j, false}, {level, i, j + 1, false}})
      cut(facet, part, plants, finest, out);
}

}  // namespace

Footprints::Footprints(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  std::erase_if(boxes_, [](const Box& b) { return b.empty(); });
  for (const auto& b : boxes_) all_.add(b);
  if (boxes_.size() > most_boxes) boxes_ = {all_};
}

double Footprints::distance(const Triangle& t) const {
  Box box;
  for (const auto& p : t) box.add(p);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& b : boxes_) {
    const double x = std::max({0.0, b.low.x - box.high.x, box.low.x - b.high.x});
    const double y = std::max({0.0, b.low.y - box.high.y, box.low.y - b.high.y});
    least = std::min(least, x * x + y * y);
  }
  return std::sqrt(least);
}

double Footprints::area(double margin) const {
  const auto area_of = [&](const Box& b) { return (b.size().x + 2.0 * margin) * (b.size().y + 2.0 * margin); };
  double sum = 0.0;
  for (const auto& b : boxes_) sum += area_of(b);
  return std::min(sum, area_of(all_));
}

std::vector<GroundPiece> cut_ground_facet(const Triangle& facet, const Footprints& plants, double finest) {
  std::vector<GroundPiece> pieces;
  cut(facet, {0, 0, 0, false}, plants, finest, pieces);
  return pieces;
}

void GroundPieceIndex::add(std::uint32_t facet, const GroundPiece& piece, std::uint32_t place) {
  const auto [at, added] = facets_.try_emplace(facet);
  if (added) at->second.first = place;
  at->second.place.emplace(key_of(piece.level, piece.number), place);
  at->second.deepest = std::max(at->second.deepest, piece.level);
}

std::uint32_t GroundPieceIndex::find(std::uint32_t facet, double& u, double& v) const {
  const auto& known = facets_.at(facet);
  for (std::uint32_t level = 0; level <= known.deepest; ++level) {
    const int k = 1 << level;
    const auto number = cell_of(static_cast<float>(u), static_cast<float>(v), k);
    const auto at = known.place.find(key_of(level, number));
    if (at == known.place.end()) continue;
    const double a = u * k, b = v * k, i = std::floor(a), j = std::floor(b);
    const bool upper = (a - i) + (b - j) > 1.0;
    u = std::clamp(upper ? i + 1.0 - a : a - i, 0.0, 1.0);
    v = std::clamp(upper ? j + 1.0 - b : b - j, 0.0, 1.0);
    return at->second;
  }
  u = v = 0.0;
  return known.first;  // on the very border of two pieces
}

std::size_t GroundPieceIndex::bytes() const {
  std::size_t total = 0;
  for (const auto& [facet, known] : facets_) total += 64 + known.place.size() * 40;
  return total;
}

}  // namespace sunfleck
