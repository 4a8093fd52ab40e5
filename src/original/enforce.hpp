// Energy and reciprocity of a phase function, enforced together.
#pragma once

#include <sunfleck/original/tables.hpp>

namespace sunfleck {

/// Makes phase symmetric, with integral over b = intercepted - absorbed, in the table's basis; what was missing goes into TableErrors.
/// Harmonics: row and column 0 are overwritten, which is all that the integral sees. Directions: a symmetric scaling D S D (Sinkhorn).
/// Scattered power below zero, as noise may have it where nothing is scattered, counts as zero with the directions.
void enforce_balance(OriginalTables& tables);

}  // namespace sunfleck
