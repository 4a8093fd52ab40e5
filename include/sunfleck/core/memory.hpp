// Bytes: what the process holds, and a counter that phases report to.
#pragma once

#include <cstddef>
#include <vector>

namespace sunfleck {

/// Peak resident set of this process so far [bytes] (VmHWM); 0 where the system does not tell.
std::size_t peak_resident_bytes();
/// Resident set now [bytes]; 0 where the system does not tell.
std::size_t resident_bytes();

/// Bytes a vector holds on the heap.
template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

}  // namespace sunfleck
