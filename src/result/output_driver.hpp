// The file driver of OutputFile.
#pragma once

#include "result/output_file.hpp"

namespace sunfleck::h5 {

/// File access properties for a new file that is written to state.descriptor; `state` must outlive the file.
Id output_access(DriverState& state);

}  // namespace sunfleck::h5
