// Columns of many copies side by side: one value each of up to 16 (copy, state, band) in a vector register.
#pragma once

#include <cstddef>
#include <vector>

namespace sunfleck {

/// `width` values that are worked on together; a power of two.
template <int width>
struct Lanes {
  typedef float Vector __attribute__((vector_size(4 * width)));
  Vector v;

  float& operator[](std::size_t k) { return reinterpret_cast<float*>(this)[k]; }
  float operator[](std::size_t k) const { return reinterpret_cast<const float*>(this)[k]; }
};

template <int width>
using LaneField = std::vector<Lanes<width>>;

}  // namespace sunfleck
