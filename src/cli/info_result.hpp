// What a result file holds, for `sunfleck info`.
#pragma once

#include <string>

namespace sunfleck {

/// On standard output.
void print_result_info(const std::string& file, bool json);

}  // namespace sunfleck
