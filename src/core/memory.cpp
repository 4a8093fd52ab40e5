#include <sunfleck/core/memory.hpp>

#include <cstdio>
#include <cstring>

namespace sunfleck {

namespace {
std::size_t status_field(const char* field) {
  std::FILE* file = std::fopen("/proc/self/status", "r");
  if (!file) return 0;
  char line[256];
  std::size_t kib = 0;
  const std::size_t length = std::strlen(field);
  while (std::fgets(line, sizeof line, file))
    if (std::strncmp(line, field, length) == 0 && std::sscanf(line + length, ": %zu", &kib) == 1) break;
  std::fclose(file);
  return kib * 1024;
}
}  // namespace

std::size_t peak_resident_bytes() {
  return status_field("VmHWM");
}
std::size_t resident_bytes() {
  return status_field("VmRSS");
}

}  // namespace sunfleck
