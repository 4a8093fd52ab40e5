// Memory that is freed, given back.
#pragma once

namespace sunfleck {

/// Gives pages that hold nothing any more back to the system (glibc; elsewhere nothing). Between phases of large solves: what one phase has
/// freed in small pieces, large arrays of the next cannot take.
void release_freed_memory();

/// From now on every array of 4 MiB or more is a mapping of its own, which goes back to the system when it is freed (glibc; elsewhere
/// nothing). By itself glibc raises that limit up to 32 MiB as arrays are freed, and arrays that grow then leave holes between what stays:
/// 6 % of the peak of a canopy of a million facets. For programs, at their start; a library leaves the allocator to its host.
void map_large_arrays();

}  // namespace sunfleck
