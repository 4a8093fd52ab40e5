// Which nodes every facet lies in.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lattice/clip_triangle.hpp"

namespace sunfleck {

class FacetCells {
 public:
  using Corners = std::function<Triangle(std::size_t facet)>;
  FacetCells() = default;
  /// Of facets 0 to count - 1; those from `first_low` on are of a ground below: cells of the lowest plane, whatever their height.
  FacetCells(const NodeGrid& grid, bool periodic, std::size_t count, std::size_t first_low, const Corners& corners);

  std::size_t size() const { return first_.empty() ? 0 : first_.size() - 1; }
  std::span<const CellShare> of(std::size_t facet) const { return {shares_.data() + first_[facet], shares_.data() + first_[facet + 1]}; }
  std::size_t bytes() const { return first_.capacity() * sizeof(std::size_t) + shares_.capacity() * sizeof(CellShare); }

 private:
  std::vector<std::size_t> first_;
  std::vector<CellShare> shares_;
};

}  // namespace sunfleck
