#include "transport.hpp"

#include <algorithm>

#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>

namespace sunfleck {

bool anything_scatters(const FacetScene& facets) {
  return std::any_of(facets.materials.begin(), facets.materials.end(), [](const Optics& m) { return scatters(m); });
}

Reflection::Reflection(const FacetScene& facets, std::vector<std::uint32_t> material_of_part, std::size_t states)
    : material_(std::move(material_of_part)), columns_(states * facets.bands) {
  bool transmits = false;
  for (const auto& m : facets.materials)
    for (std::size_t c = 0; c < columns_; ++c) {
      front_.push_back(m.reflectance_front[c % facets.bands]);
      back_.push_back(m.reflectance_back[c % facets.bands]);
      through_.push_back(m.transmittance[c % facets.bands]);
      transmits = transmits || through_.back() > 0.0f;
    }
  if (!transmits) std::vector<float>().swap(through_);
}

std::size_t Reflection::bytes() const {
  return bytes_of(material_) + bytes_of(front_) + bytes_of(back_) + bytes_of(through_);
}

void Reflection::apply(const float* irradiance, float* radiosity) const {
  const std::size_t n = columns_;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, material_.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::size_t m = material_[i] * n;
      const float* e = irradiance + 2 * i * n;
      float* b = radiosity + 2 * i * n;
      if (through_.empty()) {
        for (std::size_t c = 0; c < n; ++c) {
          b[c] = front_[m + c] * e[c];
          b[n + c] = back_[m + c] * e[n + c];
        }
        continue;
      }
      for (std::size_t c = 0; c < n; ++c) {
        const float front = e[c], back = e[n + c];
        b[c] = front_[m + c] * front + through_[m + c] * back;
        b[n + c] = back_[m + c] * back + through_[m + c] * front;
      }
    }
  });
}

Gather::Gather(const HalfLinks& half, const ClusterTree* tree, const std::vector<float>& sky_lines, std::size_t columns,
               ClusterFields& fields)
    : half_(half), tree_(tree), columns_(columns), inverse_(half.lines.size()), donor_(half.lines.size()), fields_(fields) {
  const auto known = [&](std::size_t i) { return half_.lines[i] - sky_lines[i] > 0.5f; };
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    std::size_t donor = i;
    for (std::size_t reach = 2; !known(donor) && reach <= 64; reach += 2)
      donor = i >= reach && known(i - reach) ? i - reach : i + reach < inverse_.size() && known(i + reach) ? i + reach : donor;
    donor_[i] = static_cast<std::uint32_t>(donor);
    inverse_[i] = known(i) ? 1.0f / (half_.lines[i] - sky_lines[i]) : 0.0f;
  }
  if (!tree_) return;
  inverse_through_.resize(half_.far.through.size());
  for (std::size_t i = 0; i < inverse_through_.size(); ++i)
    inverse_through_[i] = half_.far.through[i] > 0 ? 1.0f / static_cast<float>(half_.far.through[i]) : 0.0f;
  fields_.sent.resize(inverse_through_.size() * columns_);
  fields_.received.resize(fields_.sent.size());
}

std::size_t Gather::bytes() const {
  return bytes_of(inverse_) + bytes_of(donor_) + bytes_of(inverse_through_);
}

namespace {

/// Lines of a side along each channel. Most are few or none: all channels together, without branches, are quicker.
struct ChannelLines {
  float count[channels];
  explicit ChannelLines(const std::uint8_t* lines) {
    for (std::uint32_t q = 0; q < channels; ++q) count[q] = static_cast<float>(lines[q]);
  }
  void add_to(float* sum, float value) const {
    for (std::uint32_t q = 0; q < channels; ++q) sum[q] += count[q] * value;
  }
  float times(const float* field) const {
    constexpr std::uint32_t lanes = 8;
    static_assert(channels % lanes == 0);
    float sum[lanes] = {};
    for (std::uint32_t q = 0; q < channels; q += lanes)
      for (std::uint32_t k = 0; k < lanes; ++k) sum[k] += count[q + k] * field[q + k];
    return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
  }
};

}  // namespace

void Gather::gather(const float* b, float* s) const {
  const std::size_t sides = inverse_.size(), n = columns_;
  if (tree_) {
    far_up(b);
    far_across();
    far_down();
  }
  const std::size_t element_sides = tree_ ? 2 * tree_->cluster_of_element.size() : 0;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides, 512), [&](const auto& range) {
    weighted_sums(half_.near, b, n, s, range.begin(), range.end());
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      float* to = s + i * n;
      if (i < element_sides) {
        const float* field = fields_.received.data() + std::size_t{tree_->cluster_of_element[i >> 1]} * channels * n;
        const ChannelLines lines(half_.far.of_side.data() + i * channels);
        for (std::size_t c = 0; c < n; ++c) to[c] += lines.times(field + c * channels);
      }
      for (std::size_t c = 0; c < n; ++c) to[c] *= inverse_[i];
    }
  });
  for (std::size_t i = 0; i < sides; ++i)
    if (donor_[i] != i)
      for (std::size_t c = 0; c < n; ++c) s[i * n + c] = s[std::size_t{donor_[i]} * n + c];
}

void Gather::add_first_reflection(float factor, const HalfLight& light, float* s) const {
  const auto& reflection = light.first_reflection;
  if (reflection.empty()) return;
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    const std::size_t row = donor_[i];
    for (std::size_t c = 0; c < columns_; ++c) s[i * columns_ + c] += factor * inverse_[row] * reflection[row * columns_ + c];
  }
}

void Gather::far_up(const float* b) const {
  const auto& t = *tree_;
  const auto& far = half_.far;
  const std::size_t n = columns_, row = channels * n;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, t.size(), 16), [&](const auto& range) {
    for (std::size_t node = range.begin(); node < range.end(); ++node) {
      float* sum = fields_.sent.data() + node * row;
      std::fill(sum, sum + row, 0.0f);
      for (std::uint32_t k = t.first_element[node]; k < t.first_element[node + 1]; ++k)
        for (std::size_t side = 2 * std::size_t{t.elements[k]}, end = side + 2; side < end; ++side) {
          const ChannelLines lines(far.of_side.data() + side * channels);
          for (std::size_t c = 0; c < n; ++c) lines.add_to(sum + c * channels, b[side * n + c]);
        }
    }
  });
  // deepest level first: sums become means, and what is not linked at a node goes on to its parent
  for (std::size_t level = t.levels.size(); level-- > 0;) {
    for (const auto node : t.levels[level]) {
      float* mean = fields_.sent.data() + node * row;
      const auto up = t.parent[node];
      float* parent_sum = up == ClusterTree::none ? nullptr : fields_.sent.data() + up * row;
      for (std::uint32_t q = 0; q < channels; ++q) {
        const std::size_t slot = node * channels + q;
        if (far.through[slot] == 0) continue;
        const auto on = static_cast<float>(far.through[slot] - far.linked[slot]);
        for (std::size_t k = q; k < row; k += channels) {
          mean[k] *= inverse_through_[slot];
          if (parent_sum) parent_sum[k] += on * mean[k];
        }
      }
    }
  }
}

void Gather::far_across() const {
  const auto& far = half_.far;
  const std::size_t row = channels * columns_;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree_->size(), 16), [&](const auto& range) {
    for (std::size_t node = range.begin(); node < range.end(); ++node) {
      float* sum = fields_.received.data() + node * row;
      std::fill(sum, sum + row, 0.0f);
      for (std::uint32_t q = 0; q < channels; ++q) {
        float* to = sum + q;
        for (std::uint32_t k = far.first_link[node * channels + q], end = far.first_link[node * channels + q + 1]; k < end; ++k) {
          const float* from = fields_.sent.data() + std::size_t{far.node_of(far.links[k])} * row + (q ^ 1u);
          const auto count = static_cast<float>(far.count_of(far.links[k]));
          for (std::size_t c = 0; c < row; c += channels) to[c] += count * from[c];
        }
      }
    }
  });
}

void Gather::far_down() const {
  const auto& t = *tree_;
  const auto& far = half_.far;
  const std::size_t row = channels * columns_;
  for (const auto& level : t.levels)
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, level.size(), 64), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const auto node = level[k];
        float* mean = fields_.received.data() + node * row;
        const auto up = t.parent[node];
        const float* parent_mean = up == ClusterTree::none ? nullptr : fields_.received.data() + up * row;
        for (std::uint32_t q = 0; q < channels; ++q) {
          const std::size_t slot = node * channels + q;
          if (far.through[slot] == 0) continue;
          const auto on = static_cast<float>(far.through[slot] - far.linked[slot]);
          for (std::size_t i = q; i < row; i += channels) {
            const float above = parent_mean ? parent_mean[i] : 0.0f;
            mean[i] = (mean[i] + on * above) * inverse_through_[slot];
          }
        }
      }
    });
}

}  // namespace sunfleck
