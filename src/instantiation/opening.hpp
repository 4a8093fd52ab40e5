// Opening copies one by one: from the light between them to rows of facets.
#pragma once

#include "instantiation/scene_light.hpp"

namespace sunfleck {

/// Solves the inside of every copy once more, gathers along the fine operator of its original, and hands the rows of all facets to the sink
/// in their order; adds what is absorbed and escapes to the report's balance. Windows of copies are worked on together; an original's fine
/// operator is traced when the first copy of a window needs it and dropped for the next original's.
void open_copies(SceneLight& s, const Light& light, IrradianceSink& sink, SolveReport& report);

}  // namespace sunfleck
