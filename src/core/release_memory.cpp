#include <sunfleck/core/release_memory.hpp>

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace sunfleck {

void release_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void map_large_arrays() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
#endif
}

}  // namespace sunfleck
