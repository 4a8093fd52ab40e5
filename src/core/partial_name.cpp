#include "core/partial_name.hpp"

#include <sys/random.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <random>

namespace sunfleck {

namespace {

constexpr std::string_view mark = ".partial-";
constexpr std::size_t boot_digits = 8, random_digits = 16, most_bytes = 200;
const std::string no_boot(boot_digits, '0');

std::string hex(std::uint64_t value, std::size_t digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return std::string(text + random_digits - digits, digits);
}

const std::string& boot() {
  static const std::string id = [] {
    std::ifstream in("/proc/sys/kernel/random/boot_id");  // a random UUID
    std::string text;
    in >> text;
    text.resize(std::min(text.size(), boot_digits));
    return text.size() == boot_digits ? text : no_boot;
  }();
  return id;
}

bool is_hex(std::string_view text) {
  return text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

std::string shortened(const std::string& name) {
  return name.substr(0, most_bytes);
}

std::string partial_name(const std::string& name) {
  std::uint64_t number = 0;
  if (::getrandom(&number, sizeof number, 0) != sizeof number) {
    std::random_device device;
    number = (std::uint64_t{device()} << 32) | device();
  }
  return "." + shortened(name) + std::string(mark) + boot() + "-" + hex(number, random_digits);
}

PartialName parse_partial_name(std::string_view text) {
  const auto at = text.rfind(mark);
  if (text.empty() || text[0] != '.' || at == std::string_view::npos || at < 2) return {};
  const std::string_view end = text.substr(at + mark.size());
  PartialName parsed;
  parsed.name = text.substr(1, at - 1);
  if (!end.empty() && end.size() < boot_digits && end.find_first_not_of("0123456789") == std::string_view::npos)
    parsed.kind = PartialName::Kind::process_id;
  else if (end.size() == boot_digits + 1 + random_digits && end[boot_digits] == '-' && is_hex(end.substr(0, boot_digits)) &&
           is_hex(end.substr(boot_digits + 1)))
    parsed.kind = end.substr(0, boot_digits) == boot() && boot() != no_boot ? PartialName::Kind::this_boot : PartialName::Kind::other_boot;
  return parsed;
}

}  // namespace sunfleck
