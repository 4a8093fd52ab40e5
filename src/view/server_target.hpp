// The target of a request, "/path?name=value&...", taken apart.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sunfleck {

struct RequestTarget {
  std::string path;                                         ///< begins with '/', decoded
  std::vector<std::pair<std::string, std::string>> values;  ///< in their order, decoded

  /// The first value of that name.
  std::optional<std::string> value(std::string_view name) const;
};

/// Decodes %XX, and '+' in the query; a '%' that no two hexadecimal digits follow stands for itself. Nothing where the target does not
/// begin with '/'.
std::optional<RequestTarget> parse_target(std::string_view target);

}  // namespace sunfleck
