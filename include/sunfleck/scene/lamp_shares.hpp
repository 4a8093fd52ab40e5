// Which of a scene's lamps count most.
#pragma once

#include <vector>

#include <sunfleck/scene/lamp.hpp>

namespace sunfleck {

/// Of each face, then each beam: its part of all lamps' power in a band, summed over bands, so that a band that only weak lamps give off
/// counts as much as the others. LampEmission draws by these.
std::vector<double> lamp_shares(const Lamps& lamps);

}  // namespace sunfleck
