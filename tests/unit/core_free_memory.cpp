// What a process may still take, by made-up files of /proc and /sys.
#include <catch2/catch.hpp>

#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include <sunfleck/core/free_memory.hpp>

#include "places.hpp"

using namespace sunfleck;

namespace {

class Machine {
 public:
  Machine() : root_(std::filesystem::temp_directory_path() / ("sunfleck-free-" + std::to_string(std::rand()))) {
    file("/proc/meminfo", "MemTotal:       8000000 kB\nMemFree:         100 kB\nMemAvailable:    4000000 kB\n");
    file("/proc/self/cgroup", "");
  }
  ~Machine() { std::filesystem::remove_all(root_); }
  void file(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((root_.string() + path).substr(0, (root_.string() + path).rfind('/')));
    std::ofstream(root_.string() + path) << text;
  }
  FreeMemory free() const { return free_memory(root_.string()); }

 private:
  std::filesystem::path root_;
};

}  // namespace

TEST_CASE("free memory: the machine's own", "[memory]") {
  const Machine machine;
  CHECK(machine.free().bytes == 4'096'000'000);
  CHECK(machine.free().limit == "of the machine");
}

TEST_CASE("free memory: control groups of version 2, the group's and those above it", "[memory]") {
  const Machine machine;
  machine.file("/proc/self/cgroup", "0::/jobs/one\n");
  machine.file("/sys/fs/cgroup/jobs/one/memory.max", "max\n");
  machine.file("/sys/fs/cgroup/jobs/one/memory.current", "500\n");
  CHECK(machine.free().bytes == 4'096'000'000);
  machine.file("/sys/fs/cgroup/jobs/memory.max", "1000000\n");
  machine.file("/sys/fs/cgroup/jobs/memory.current", "700000\n");
  machine.file("/sys/fs/cgroup/jobs/memory.stat", "anon 1\nfile 3\ninactive_file 200000\nactive_file 5\n");
  CHECK(machine.free().bytes == 500'000);  // pages of files can be given back
  CHECK(machine.free().limit == "of the control group");
  machine.file("/sys/fs/cgroup/jobs/one/memory.max", "100\n");
  CHECK(machine.free().bytes == 0);  // over its limit already
}

TEST_CASE("free memory: control groups of version 1, also where a container sees its own group as the root", "[memory]") {
  const Machine machine;
  machine.file("/proc/self/cgroup", "5:cpu,cpuacct:/a\n4:memory:/docker/abc\n0::/\n");
  machine.file("/sys/fs/cgroup/memory/memory.limit_in_bytes", "3000000\n");
  machine.file("/sys/fs/cgroup/memory/memory.usage_in_bytes", "1000000\n");
  CHECK(machine.free().bytes == 2'000'000);
  machine.file("/sys/fs/cgroup/memory/docker/abc/memory.limit_in_bytes", "2000000\n");
  machine.file("/sys/fs/cgroup/memory/docker/abc/memory.usage_in_bytes", "1500000\n");
  machine.file("/sys/fs/cgroup/memory/docker/abc/memory.stat", "inactive_file 1\ntotal_inactive_file 100000\n");
  CHECK(machine.free().bytes == 600'000);
}
