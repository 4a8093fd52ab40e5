// What a result was made from.
#pragma once

#include <sunfleck/result/result_reader.hpp>

namespace sunfleck {

/// Adds the scene of a result and the files that it names to what was read, so that no output takes their place. A result keeps the name of
/// its scene as it was given: it is looked for from the folder at hand, and from that of the result.
void note_inputs_of(const Result& result);

}  // namespace sunfleck
