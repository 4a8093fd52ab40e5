#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

const std::vector<std::string>& output_fields() {
  static const std::vector<std::string> names{
      "facets/irradiance", "facets/absorbed", "facets/sunlit", "facets/area",     "facets/centroid", "facets/organ", "organs/irradiance",
      "organs/absorbed",   "organs/sunlit",   "organs/area",   "variance/facets", "variance/organs", "geometry"};
  return names;
}

}  // namespace sunfleck
