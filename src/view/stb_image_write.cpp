// The one translation unit that holds stb_image_write's code. It does not look at what malloc returns: here that throws instead.
#include <cstdlib>
#include <new>

namespace {

void* memory_or_throw(void* got) {
  if (!got) throw std::bad_alloc();
  return got;
}

}  // namespace

#define STBIW_MALLOC(size) memory_or_throw(std::malloc(size))
#define STBIW_REALLOC(old, size) memory_or_throw(std::realloc(old, size))
#define STBIW_FREE(old) std::free(old)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>
#pragma GCC diagnostic pop
