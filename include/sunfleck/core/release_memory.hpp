// Memory that is freed, given back.
#pragma once

namespace sunfleck {

/// Gives pages that hold nothing any more back to the system (glibc; elsewhere nothing). Between phases of large solves: what one phase has
/// freed in small pieces, large arrays of the next cannot take.
void release_freed_memory();

}  // namespace sunfleck
