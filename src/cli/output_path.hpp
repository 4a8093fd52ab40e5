// Checks of an output file before time is spent on what goes into it.
#pragma once

#include <string>
#include <vector>

namespace sunfleck {

/// Throws UsageError if `file` has none of the suffixes (".h5"), names a directory or lies in a folder that does not exist, or is one of
/// `inputs`; OutputError if its folder may not be written.
void check_output_path(const std::string& file, const std::vector<std::string>& suffixes, const std::vector<std::string>& inputs = {});

}  // namespace sunfleck
