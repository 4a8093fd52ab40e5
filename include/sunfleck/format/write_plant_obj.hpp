// A plant as Wavefront OBJ, for looking at it elsewhere.
#pragma once

#include <string>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// One group per organ ("leaf_17": type and number of the structure), one `usemtl` per material, facets in the plant's order, coordinates
/// in metres with 9 significant digits; beside it FILE.mtl with a plain colour per material. The hierarchy is lost: OBJ has none. Throws
/// OutputError; nothing is left under the file's name if it does.
void write_plant_obj(const Plant& plant, const std::string& file);

}  // namespace sunfleck
