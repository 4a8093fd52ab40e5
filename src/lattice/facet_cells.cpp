#include "lattice/facet_cells.hpp"

#include <algorithm>

#include <tbb/parallel_for.h>

namespace sunfleck {

FacetCells::FacetCells(const NodeGrid& grid, bool periodic, std::size_t count, std::size_t first_low, const Corners& corners)
    : first_(count + 1, 0) {
  constexpr std::size_t block = 4096;
  const std::size_t blocks = (count + block - 1) / block;
  std::vector<std::vector<CellShare>> parts(blocks);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    for (std::size_t f = b * block; f < std::min(count, (b + 1) * block); ++f) {
      const std::size_t before = parts[b].size();
      clip_to_cells(grid, corners(f), periodic, f >= first_low, parts[b]);
      first_[f + 1] = parts[b].size() - before;
    }
  });
  for (std::size_t f = 0; f < count; ++f) first_[f + 1] += first_[f];
  shares_.reserve(first_[count]);
  for (auto& part : parts) {
    shares_.insert(shares_.end(), part.begin(), part.end());
    std::vector<CellShare>().swap(part);
  }
}

}  // namespace sunfleck
