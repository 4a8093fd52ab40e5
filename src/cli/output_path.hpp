// Checks of output files before time is spent on what goes into them.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>

namespace sunfleck {

/// Throws UsageError if `file` has none of the suffixes (".h5"), names a directory, a device or a pipe, lies in a folder that does not
/// exist, or is one of `inputs`, by whatever name; OutputError if its folder may not be written.
void check_output_path(const std::string& file, const std::vector<std::string>& suffixes, const std::vector<std::string>& inputs = {});

/// To be called once all inputs are read, before any work. Throws UsageError if one of the files to be written, or what is written beside
/// it (material libraries of .obj, points of .xdmf), would take the place of a file that was read or is named by what was read
/// (InputRecord), of another of them, or, for those beside, of a file that sunfleck did not write. Then removes what killed processes have
/// left of the files to be written, and says so.
void prepare_outputs(const std::vector<std::string>& files, Progress& progress);

}  // namespace sunfleck
