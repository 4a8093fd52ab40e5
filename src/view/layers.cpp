#include <sunfleck/view/layers.hpp>

#include <limits>

namespace sunfleck {

void PictureLayers::resize(int w, int h, bool with_value) {
  width = w, height = h;
  const std::size_t n = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
  for (auto* layer : {&red, &green, &blue, &alpha}) layer->assign(n, 0.0f);
  depth.assign(n, std::numeric_limits<float>::infinity());
  organ.assign(n, no_row), facet.assign(n, no_row);
  if (with_value) value.assign(n, std::numeric_limits<float>::quiet_NaN());
}

}  // namespace sunfleck
