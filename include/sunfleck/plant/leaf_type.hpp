// Which structures count as leaves.
#pragma once

#include <string_view>

namespace sunfleck {

/// True for the type "leaf", in any case of letters.
bool is_leaf_type(std::string_view type);

}  // namespace sunfleck
