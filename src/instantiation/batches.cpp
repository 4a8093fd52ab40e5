#include "instantiation/batches.hpp"

#include <algorithm>
#include <map>

namespace sunfleck {

int batch_width(std::size_t lanes, std::size_t columns) {
  int width = 2;  // two batches at least where there is work for them
  while (width < 16 && static_cast<std::size_t>(2 * width) < lanes) width *= 2;
  while (width < 16 && static_cast<std::size_t>(width) < std::min<std::size_t>(columns, 16)) width *= 2;
  return width;
}

std::vector<Batch> batches_of_original(std::uint32_t original, const std::vector<std::uint32_t>& members, std::size_t all_columns) {
  std::vector<Batch> out;
  const int width = batch_width(members.size() * all_columns, all_columns);
  const std::size_t columns = std::min<std::size_t>(all_columns, width), each = width / columns;
  for (std::size_t first = 0; first < members.size(); first += each)
    for (std::size_t c = 0; c < all_columns; c += columns) {
      Batch b;
      b.original = original;
      b.members.assign(members.begin() + static_cast<std::ptrdiff_t>(first),
                       members.begin() + static_cast<std::ptrdiff_t>(std::min(members.size(), first + each)));
      b.first_column = c;
      b.columns = std::min(columns, all_columns - c);
      b.width = width;
      out.push_back(std::move(b));
    }
  return out;
}

std::vector<Batch> batches_of(const Members& all, std::size_t columns, const std::vector<std::uint32_t>& members) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_original;
  for (const auto m : members) by_original[all.found.members[m].original].push_back(m);
  std::vector<Batch> out;
  for (const auto& [original, list] : by_original)
    for (auto& b : batches_of_original(original, list, columns)) out.push_back(std::move(b));
  return out;
}

std::vector<std::pair<std::size_t, std::size_t>> runs_of_members(const std::vector<Batch>& batches, std::size_t first, std::size_t last) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (; first < last; first = out.back().second) {
    std::size_t end = first + 1;
    while (end < last && batches[end].members == batches[first].members) ++end;
    out.emplace_back(first, end);
  }
  return out;
}

std::vector<double> sky_areas(const LineOperator& op, const RayEnd* ends) {
  std::vector<float> open(op.fields());
  for (std::size_t f = 0; f < op.fields(); ++f) {
    std::uint32_t n = 0;
    for (auto k = op.point_start[f]; k < op.point_start[f + 1]; ++k) n += ends[k].is_sky();
    open[f] = n ? static_cast<float>(n) / static_cast<float>(op.point_start[f + 1] - op.point_start[f]) : 0.0f;
  }
  std::vector<double> out(2 * op.lines.size(), 0.0);
  for (std::size_t side = 0; side < out.size(); ++side) {
    if (op.lines[side / 2] == 0) continue;
    float lines = 0;
    op.outside.row(side, [&](const auto* column, const std::uint8_t* count, std::size_t n) {
      for (std::size_t k = 0; k < n; ++k) lines += static_cast<float>(count[k]) * open[column[k]];
    });
    out[side] = double{op.open_area[side / 2]} * lines / op.lines[side / 2];
  }
  return out;
}

std::vector<const RayEnd*> stored_ends(const SceneLight& s, const Batch& b) {
  std::vector<const RayEnd*> out;
  for (const auto m : b.members) out.push_back(s.ends.data() + s.end_start[m]);
  return out;
}

}  // namespace sunfleck
