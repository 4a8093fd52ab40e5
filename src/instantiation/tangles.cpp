#include "instantiation/tangles.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <tbb/parallel_for.h>

namespace sunfleck {

namespace {

constexpr std::size_t most_points = 288;  // that lines leave a member through
constexpr double within = 0.05;           // of them: fewer look into a neighbour's gaps, which spoils little

using Shares = std::map<std::uint32_t, double>;

void add_hidden(const Members& members, const MemberSurroundings& around, std::uint32_t m, Shares& shares) {
  const auto& segments = members.coarse_of(m).segments;
  for (const auto& segment : segments) {
    const auto j = around.stands_between(m, segment);
    if (j != MemberSurroundings::none && (j < members.size() || j == MemberSurroundings::the_ground))
      shares[j] += 1.0 / static_cast<double>(segments.size());
  }
}

void add_inner_faces(const Members& members, const MemberSurroundings& around, std::uint32_t m, Shares& shares) {
  const auto& op = members.coarse_of(m);
  const std::size_t pixels = std::size_t{op.pixels()} * op.pixels(), n = std::min(op.points.size(), most_points);
  Shares met;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t point = k * op.points.size() / n;
    const auto field =
        static_cast<std::size_t>(std::upper_bound(op.point_start.begin(), op.point_start.end(), point) - op.point_start.begin() - 1);
    const auto j = around.inner_face(m, op.points[point], members.maps[m].direction(op.direction(field / pixels)));
    if (j < members.size()) met[j] += 1.0 / static_cast<double>(n);
  }
  for (const auto& [j, share] : met)
    if (share > within) shares[j] += share;
}

}  // namespace

std::vector<Tangle> tangles(const Members& members, const MemberSurroundings& around, const Progress& progress) {
  std::vector<Shares> found(members.size());
  tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(members.size()), [&](std::uint32_t m) {
    if (progress.cancelled()) return;
    add_hidden(members, around, m, found[m]);
    add_inner_faces(members, around, m, found[m]);
  });
  progress.check();
  std::vector<Tangle> out;
  for (std::uint32_t m = 0; m < found.size(); ++m)
    for (const auto& [j, share] : found[m]) out.push_back({share, m, j});
  return out;
}

std::vector<double> spoilt_shares(const Members& members, const std::vector<Tangle>& list) {
  std::vector<double> out(members.size(), 0.0);
  for (const auto& t : list) out[t.a] += t.share;
  return out;
}

double mean_share(const Members& members, const std::vector<Tangle>& list) {
  const auto spoilt = spoilt_shares(members, list);
  double sum = 0, all = 0;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto& areas = members.original_of(m).elements.area;
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0) * members.maps[m].scale * members.maps[m].scale;
    sum += area * spoilt[m] * spoilt[m];
    all += area;
  }
  return all > 0 ? std::sqrt(sum / all) : 0.0;
}

}  // namespace sunfleck
