// What a verb that shows a result says of it first.
#pragma once

#include <sunfleck/core/progress.hpp>
#include <sunfleck/result/result_reader.hpp>

namespace sunfleck {

/// A note where the status is not 'converged'.
void say_status(const Result& result, Progress& progress);

}  // namespace sunfleck
