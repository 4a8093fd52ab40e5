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
      : light_(light), cells_(seen == LineOperator::Seen::cells) {
    for (auto& sum : sums_) sum.assign(2 * elements.size(), Lanes<width>{});
  }

  void lines(std::size_t stream, const std::vector<std::uint32_t>& up, const std::vector<std::uint32_t>& cell_side) override {
    auto& sum = sums_[stream];
    LineOperator::each_meeting(up, [&](std::size_t k, std::uint32_t below, std::uint32_t above) {
      sum[below].v += light_[cells_ ? cell_side[k] ^ 1u : above].v;
      sum[above].v += light_[cells_ ? cell_side[k - 1] : below].v;
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
  const LaneField<width>& light_;
  bool cells_;
  std::array<LaneField<width>, streams> sums_;
};

}  // namespace sunfleck
