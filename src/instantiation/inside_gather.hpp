// The light that sides of a copy gather from each other, added up while lines are traced.
#pragma once

#include <array>
#include <vector>

#include <sunfleck/core/memory.hpp>

#include "instantiation/lanes.hpp"
#include "instantiation/line_operator.hpp"

namespace sunfleck {

/// sum over lines of what each side of an element sees, without rows of links: for an operator that serves one batch, making rows takes
/// more time than following them, and more memory than all else that is held.
template <int width>
class InsideGather : public LineVisitor {
 public:
  /// `light`: radiosity of sides of elements or of cells, as `seen` says.
  InsideGather(const Elements& elements, const LaneField<width>& light, LineOperator::Seen seen)
      : elements_(elements), light_(light), cells_(seen == LineOperator::Seen::cells) {
    for (auto& sum : sums_) sum.assign(2 * elements.size(), Lanes<width>{});
  }

  void lines(std::size_t stream, const std::vector<std::uint32_t>& along) override {
    auto& sum = sums_[stream];
    const auto side_of = [&](std::uint32_t cell_side) { return 2 * elements_.element_of_cell[cell_side >> 1] + (cell_side & 1u); };
    LineOperator::each_meeting(along, [&](std::uint32_t below, std::uint32_t above) {
      const auto low = side_of(below), high = side_of(above);
      sum[low].v += light_[cells_ ? above : high].v;
      sum[high].v += light_[cells_ ? below : low].v;
    });
  }

  /// sum_j n_ij B_j / W_i of all sides. Once.
  LaneField<width> mean(const LineOperator& op) {
    LaneField<width> out = std::move(sums_[0]);
    for (std::size_t i = 0; i < out.size(); ++i) {
      for (std::size_t k = 1; k < streams; ++k) out[i].v += sums_[k][i].v;
      out[i].v *= op.lines[i / 2] > 0 ? 1.0f / static_cast<float>(op.lines[i / 2]) : 0.0f;
    }
    for (auto& sum : sums_) sum = {};
    return out;
  }

  std::size_t bytes() const {
    std::size_t total = 0;
    for (const auto& sum : sums_) total += bytes_of(sum);
    return total;
  }

 private:
  const Elements& elements_;
  const LaneField<width>& light_;
  bool cells_;
  std::array<LaneField<width>, streams> sums_;
};

}  // namespace sunfleck
