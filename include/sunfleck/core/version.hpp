// The version of this software, as results and `sunfleck --version` name it.
#pragma once

#include <string>

namespace sunfleck {

/// "MAJOR.MINOR.PATCH" of the CMake project.
std::string software_version();

}  // namespace sunfleck
