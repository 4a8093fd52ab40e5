// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>

namespace sunfleck {

/// "850 B", "1.2 MiB".
std::string bytes_text(double bytes);
/// "950", "12.3 k", "4.56 M": for rates, never for data.
std::string count_text(double count);
/// "1 copy", "3 copies".
std::string counted(std::uint64_t count, const std::string& one, const std::string& many);

}  // namespace sunfleck
