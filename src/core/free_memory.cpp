#include <sunfleck/core/free_memory.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace sunfleck {

namespace {

/// The number behind a word at the start of a line, as in "MemAvailable:   123 kB"; without a word, the first of the file.
std::optional<std::uint64_t> number_in(const std::string& file, const std::string& word = "") {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first;
    std::uint64_t value = 0;
    if (!word.empty() && !(words >> first && first == word)) continue;
    if (words >> value) return value;
    return std::nullopt;  // "max"
  }
  return std::nullopt;
}

/// Names of one version of control groups.
struct Names {
  const char *limit, *usage, *inactive;
};
constexpr Names version_2{"/memory.max", "/memory.current", "inactive_file"},
    version_1{"/memory.limit_in_bytes", "/memory.usage_in_bytes", "total_inactive_file"};

/// Least of a group and of those above it.
void look_at_groups(const std::string& mount, std::string path, const Names& names, FreeMemory& least) {
  while (true) {
    const std::string folder = mount + path;
    if (const auto limit = number_in(folder + names.limit)) {
      const auto usage = number_in(folder + names.usage).value_or(0);
      const auto held = usage - std::min(usage, number_in(folder + "/memory.stat", names.inactive).value_or(0));
      const std::uint64_t free = *limit - std::min(*limit, held);
      if (free < least.bytes) least = {free, "of the control group"};
    }
    if (path.empty()) return;
    path.resize(path.find_last_of('/'));
  }
}

void look_at_groups(const std::string& root, FreeMemory& least) {
  std::ifstream in(root + "/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {  // "4:memory:/path", "0::/path"
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    std::string path = line.substr(second + 1);
    if (path.empty() || path.front() != '/' || path == "/") path.clear();
    if (line.rfind("0::", 0) == 0)
      for (const char* mount : {"/sys/fs/cgroup", "/sys/fs/cgroup/unified"}) look_at_groups(root + mount, path, version_2, least);
    else if (controllers == "memory")
      look_at_groups(root + "/sys/fs/cgroup/memory", path, version_1, least);
  }
}

void look_at_limit(int resource, const std::string& root, const char* held, const char* name, FreeMemory& least) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  const std::uint64_t used = number_in(root + "/proc/self/status", held).value_or(0) * 1024;
  const std::uint64_t free = limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used);
  if (free < least.bytes) least = {free, name};
}

}  // namespace

FreeMemory free_memory(const std::string& root) {
  FreeMemory least{std::numeric_limits<std::uint64_t>::max(), ""};
  if (const auto kib = number_in(root + "/proc/meminfo", "MemAvailable:")) least = {*kib * 1024, "of the machine"};
  look_at_groups(root, least);
  look_at_limit(RLIMIT_AS, root, "VmSize:", "of the address space (ulimit -v)", least);
  look_at_limit(RLIMIT_DATA, root, "VmData:", "of data (ulimit -d)", least);
  return least;
}

}  // namespace sunfleck
