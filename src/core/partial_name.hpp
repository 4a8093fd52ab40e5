// Names of files that are still growing.
#pragma once

#include <string>
#include <string_view>

namespace sunfleck {

/// ".NAME.partial-BOOT-RANDOM", new on every call. BOOT is the same for all processes, in whatever container, from one start of the machine
/// to the next: a lock that such a process holds is seen by the others.
std::string partial_name(const std::string& name);

struct PartialName {
  enum class Kind {
    none,
    this_boot,
    other_boot,
    process_id  ///< ".NAME.partial-PID", as earlier versions had it
  };
  Kind kind = Kind::none;
  std::string name;  ///< of what was to be written, or the beginning of a long one
};
PartialName parse_partial_name(std::string_view text);

/// What a partial name keeps of a name: names of files may have 255 bytes.
std::string shortened(const std::string& name);

}  // namespace sunfleck
