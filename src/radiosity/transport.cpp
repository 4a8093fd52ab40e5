#include "transport.hpp"

#include <tbb/parallel_for.h>

namespace sunfleck {

Reflection::Reflection(const FacetScene& facets, std::vector<std::uint32_t> material_of_part, std::size_t states)
    : material_(std::move(material_of_part)), columns_(states * facets.bands) {
  for (const auto& m : facets.materials)
    for (std::size_t c = 0; c < columns_; ++c) {
      front_.push_back(m.reflectance_front[c % facets.bands]);
      back_.push_back(m.reflectance_back[c % facets.bands]);
      through_.push_back(m.transmittance[c % facets.bands]);
    }
}

void Reflection::apply(const Field& irradiance, Field& radiosity) const {
  const std::size_t n = columns_;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, material_.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::size_t m = material_[i] * n;
      const float* e = irradiance.data() + 2 * i * n;
      float* b = radiosity.data() + 2 * i * n;
      for (std::size_t c = 0; c < n; ++c) {
        const float front = e[c], back = e[n + c];
        b[c] = front_[m + c] * front + through_[m + c] * back;
        b[n + c] = back_[m + c] * back + through_[m + c] * front;
      }
    }
  });
}

FlatGather::FlatGather(LineLinks links, const std::vector<float>& sky_lines) : links_(std::move(links)), inverse_(links_.sides()) {
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    const float rest = links_.lines[i] - sky_lines[i];
    inverse_[i] = rest > 1e-3f ? 1.0f / rest : 0.0f;
  }
}

namespace {

template <std::size_t Columns>
void gather_rows(const LineLinks& links, const float* inverse, const float* b, float* s, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    float sum[Columns] = {};
    for (std::uint32_t k = links.start[i]; k < links.start[i + 1]; ++k) {
      const float* from = b + std::size_t{links.column[k]} * Columns;
      for (std::size_t c = 0; c < Columns; ++c) sum[c] += links.count[k] * from[c];
    }
    for (std::size_t c = 0; c < Columns; ++c) s[i * Columns + c] = inverse[i] * sum[c];
  }
}

void gather_rows(const LineLinks& links, const float* inverse, const float* b, float* s, std::size_t begin, std::size_t end, std::size_t columns) {
  for (std::size_t i = begin; i < end; ++i) {
    float* to = s + i * columns;
    for (std::size_t c = 0; c < columns; ++c) to[c] = 0.0f;
    for (std::uint32_t k = links.start[i]; k < links.start[i + 1]; ++k) {
      const float* from = b + std::size_t{links.column[k]} * columns;
      const float count = links.count[k];
      for (std::size_t c = 0; c < columns; ++c) to[c] += count * from[c];
    }
    for (std::size_t c = 0; c < columns; ++c) to[c] *= inverse[i];
  }
}

}  // namespace

void FlatGather::gather(const Field& radiosity, Field& gathered, std::size_t columns) const {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, links_.sides(), 512), [&](const auto& range) {
    const float* b = radiosity.data();
    float* s = gathered.data();
    switch (columns) {
      case 1: return gather_rows<1>(links_, inverse_.data(), b, s, range.begin(), range.end());
      case 2: return gather_rows<2>(links_, inverse_.data(), b, s, range.begin(), range.end());
      case 3: return gather_rows<3>(links_, inverse_.data(), b, s, range.begin(), range.end());
      case 4: return gather_rows<4>(links_, inverse_.data(), b, s, range.begin(), range.end());
      default: return gather_rows(links_, inverse_.data(), b, s, range.begin(), range.end(), columns);
    }
  });
}

}  // namespace sunfleck
