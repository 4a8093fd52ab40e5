// Light on the ground, as rows of the result.
#pragma once

#include <vector>

#include <sunfleck/scene/solution.hpp>

#include "instantiation/scene_light.hpp"

namespace sunfleck {

/// Hands the ground's rows to the sink, means over the parts that a facet was cut into, and adds what it meets directly, absorbs and sends
/// to the sky to the report's balance. `irradiance`: SceneLight::ground_irradiance() of all light.
void write_ground_rows(const SceneLight& s, const std::vector<float>& irradiance, IrradianceSink& sink, SolveReport& report);

}  // namespace sunfleck
