#include <sunfleck/core/version.hpp>

namespace sunfleck {

std::string software_version() {
  return SUNFLECK_VERSION;
}

}  // namespace sunfleck
