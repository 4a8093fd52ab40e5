// JSON of --json.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace sunfleck {

/// With two blanks a level. Names in results of other programs, and paths, may be no UTF-8: their bytes become U+FFFD.
inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace sunfleck
