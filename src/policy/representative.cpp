#include "policy/representative.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace sunfleck {

namespace {

constexpr std::size_t compared_members = 1000;

using Features = std::array<double, 8>;

/// What light sees of a structure to first order: its size, how compact it is, and how its facets are turned in the frame that is laid on
/// others.
Features features_of(Alignment align, const Subtrees& subtrees, std::uint32_t structure) {
  const Moments& m = subtrees.moments(structure);
  const Mat3 turn = alignment(align, subtrees.frame(structure));
  const Mat3 n = glm::transpose(turn) * m.normals * turn / m.area;
  const double gyration = std::max(m.gyration(), 1e-12 * std::sqrt(m.area));
  return {std::log(m.area), std::log(gyration / std::sqrt(m.area)), n[0][0], n[1][1], n[2][2], n[0][1], n[0][2], n[1][2]};
}

std::uint32_t medoid(Alignment align, const std::vector<Subtrees>& plants, const std::vector<SubtreeRef>& members) {
  std::vector<Features> all;
  for (const auto& m : members) all.push_back(features_of(align, plants[m.plant], m.structure));
  const auto count = static_cast<double>(all.size());
  for (std::size_t k = 0; k < std::tuple_size_v<Features>; ++k) {
    double mean = 0, variance = 0;
    for (const auto& f : all) mean += f[k] / count;
    for (const auto& f : all) variance += (f[k] - mean) * (f[k] - mean) / count;
    const double weight = variance > 1e-18 ? 1.0 / std::sqrt(variance) : 0.0;
    for (auto& f : all) f[k] *= weight;
  }
  const std::size_t step = (all.size() + compared_members - 1) / compared_members;
  std::uint32_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < all.size() && sum < least; j += step) {
      double squared = 0;
      for (std::size_t k = 0; k < all[i].size(); ++k) squared += (all[i][k] - all[j][k]) * (all[i][k] - all[j][k]);
      sum += std::sqrt(squared);
    }
    if (sum < least) least = sum, best = i;
  }
  return best;
}

}  // namespace

std::uint32_t choose_representative(const PolicyType& entry, const std::vector<Subtrees>& plants, const std::vector<SubtreeRef>& members) {
  if (entry.representative == Representative::first) return 0;
  if (entry.representative == Representative::medoid) return medoid(entry.align, plants, members);
  std::uint32_t best = 0;
  const auto area = [&](const SubtreeRef& m) { return plants[m.plant].moments(m.structure).area; };
  for (std::uint32_t i = 1; i < members.size(); ++i)
    if (area(members[i]) > area(members[best])) best = i;
  return best;
}

Similarity stand_in(const PolicyType& entry, const std::vector<Subtrees>& plants, const SubtreeRef& representative,
                    const SubtreeRef& member) {
  const Moments &from = plants[representative.plant].moments(representative.structure),
                &to = plants[member.plant].moments(member.structure);
  if (representative.plant == member.plant && representative.structure == member.structure) return {};
  const double scale = entry.scale == StandIn::area ? std::sqrt(to.area / from.area) : 1.0;
  const Mat3 turn = alignment(entry.align, plants[member.plant].frame(member.structure)) *
                    glm::transpose(alignment(entry.align, plants[representative.plant].frame(representative.structure)));
  return {scale, turn, to.centroid() - scale * (turn * from.centroid())};
}

}  // namespace sunfleck
