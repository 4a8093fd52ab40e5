// stb_image's declarations, for Radiance HDR and PNG alone.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#define STBI_NO_STDIO
#define STBI_ONLY_HDR
#define STBI_ONLY_PNG
#define STBI_MAX_DIMENSIONS (1 << 15)
#include <stb_image.h>
#pragma GCC diagnostic pop
