#include "instantiation/batches.hpp"

#include <algorithm>
#include <map>

namespace sunfleck {

std::vector<Batch> batches_of(const SceneLight& s, const std::vector<std::uint32_t>& members) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_original;
  for (const auto m : members) by_original[s.members.found.members[m].original].push_back(m);
  std::vector<Batch> out;
  for (const auto& [original, list] : by_original) {
    const std::size_t lanes = list.size() * s.columns;
    int width = 2;  // two batches at least where there is work for them
    while (width < 16 && static_cast<std::size_t>(2 * width) < lanes) width *= 2;
    while (width < 16 && static_cast<std::size_t>(width) < std::min<std::size_t>(s.columns, 16)) width *= 2;
    const std::size_t columns = std::min<std::size_t>(s.columns, width), each = width / columns;
    for (std::size_t first = 0; first < list.size(); first += each)
      for (std::size_t c = 0; c < s.columns; c += columns) {
        Batch b;
        b.original = original;
        b.members.assign(list.begin() + static_cast<std::ptrdiff_t>(first),
                         list.begin() + static_cast<std::ptrdiff_t>(std::min(list.size(), first + each)));
        b.first_column = c;
        b.columns = std::min(columns, s.columns - c);
        b.width = width;
        out.push_back(std::move(b));
      }
  }
  return out;
}

std::vector<const RayEnd*> stored_ends(const SceneLight& s, const Batch& b) {
  std::vector<const RayEnd*> out;
  for (const auto m : b.members) out.push_back(s.ends.data() + s.end_start[m]);
  return out;
}

}  // namespace sunfleck
