// In the place of read_exr.cpp where the build leaves OpenEXR out (SUNFLECK_EXR).
#include <sunfleck/core/error.hpp>

#include <format/panorama.hpp>

namespace sunfleck {

Panorama read_exr(const std::string&, const std::string& file) {
  throw InputError(location(file), "a picture in EXR, without which this sunfleck was built (SUNFLECK_EXR=OFF)", "HDR or PNG");
}

}  // namespace sunfleck
