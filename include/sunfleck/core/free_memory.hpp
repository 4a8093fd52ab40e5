// How much more memory this process may take.
#pragma once

#include <cstdint>
#include <string>

namespace sunfleck {

struct FreeMemory {
  std::uint64_t bytes = 0;  ///< the largest number there is where the system does not tell
  std::string limit;  ///< what sets it: "of the machine", "of the control group", "of the address space (ulimit -v)", "of data (ulimit -d)"
};

/// The least of
/// - MemAvailable of /proc/meminfo, what the kernel can give without swapping;
/// - limit - usage + inactive file pages of the process's control group and of every group above it, version 2 (memory.max, memory.current)
///   or 1 (memory.limit_in_bytes, memory.usage_in_bytes); where a container does not see its own path, of the root that it sees;
/// - RLIMIT_AS - VmSize and RLIMIT_DATA - VmData.
/// `root` is put before /proc and /sys: for tests.
FreeMemory free_memory(const std::string& root = "");

}  // namespace sunfleck
