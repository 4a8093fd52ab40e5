// Reading plants. One file a format; this is the door.
#pragma once

#include <string>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// Reads .opf, .obj, .ply, .can or a generated .h5 by suffix; lengths of the file are multiplied by unit_m (0.01 for cm).
/// Keeps the file's hierarchy, every face in its order, and double-precision coordinates. Throws InputError naming file and line.
Plant read_plant(const std::string& file, double unit_m = 1.0);

Plant read_opf(const std::string& file);
Plant read_obj(const std::string& file);
Plant read_ply(const std::string& file);
Plant read_can(const std::string& file);
Plant read_plant_h5(const std::string& file);
void write_plant_h5(const Plant& plant, const std::string& file);

}  // namespace sunfleck
