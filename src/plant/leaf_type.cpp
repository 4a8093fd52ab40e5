#include <sunfleck/plant/leaf_type.hpp>

#include <algorithm>
#include <cctype>

namespace sunfleck {

bool is_leaf_type(std::string_view type) {
  constexpr std::string_view leaf = "leaf";
  return std::equal(type.begin(), type.end(), leaf.begin(), leaf.end(),
                    [](unsigned char found, unsigned char wanted) { return std::tolower(found) == wanted; });
}

}  // namespace sunfleck
