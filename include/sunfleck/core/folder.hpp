// What a folder holds.
#pragma once

#include <string>
#include <vector>

namespace sunfleck {

/// Names in a folder, in the system's order; none if it cannot be read. An empty name is the folder at hand. (The increment() of
/// std::filesystem's iterator ends the program where memory runs out: libstdc++ 12.)
std::vector<std::string> names_in(const std::string& folder);

}  // namespace sunfleck
