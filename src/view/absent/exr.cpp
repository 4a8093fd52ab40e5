// In the place of write_exr.cpp where the build leaves OpenEXR out (SUNFLECK_EXR).
#include <sunfleck/core/error.hpp>
#include <sunfleck/view/layers.hpp>

namespace sunfleck {

void write_exr(const PictureLayers&, const std::string& file) {
  throw UsageError(file + ": this sunfleck was built without EXR (SUNFLECK_EXR=OFF); expected .png");
}

}  // namespace sunfleck
