// Keys of TOML that would nest tables without bound.
#pragma once

#include <string>
#include <string_view>

namespace sunfleck {

/// The parser and the destructor of its tables go down a level for every part of a dotted key: InputError naming file and line for a key of
/// more than 32 parts (nested arrays and inline tables the parser bounds itself).
void check_toml_keys(std::string_view text, const std::string& file);

}  // namespace sunfleck
