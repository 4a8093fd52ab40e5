// A new HDF5 file that is complete or absent.
#pragma once

#include <string>

#include <sunfleck/core/h5.hpp>
#include <sunfleck/core/replaced_file.hpp>

namespace sunfleck::h5 {

/// What the file driver has met; outlives the HDF5 file.
struct DriverState {
  int descriptor = -1;
  int error = 0;  ///< errno of the first write that failed; from then on nothing is written and HDF5 is told that all is well
};

/// HDF5 cannot close a file whose last writes fail (it keeps dangling handles). So the file is written through a driver of our own
/// that remembers the first error and swallows what follows; check() turns it into an OutputError with the system's words.
class OutputFile {
 public:
  /// Throws OutputError if the folder cannot be written or `path` is something else than a file.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  hid_t id() const { return file_.get(); }
  const std::string& path() const { return replaced_.path(); }
  /// Throws OutputError naming the file if a write has failed, or if `good` is false.
  void check(bool good = true) const;
  /// Flushes to the disk, reads the file again, and renames. All handles of datasets must be closed.
  void commit();
  /// The same for this file and another one that belongs to it: both or none.
  void commit_with(ReplacedFile& other);

 private:
  void complete();

  ReplacedFile replaced_;
  DriverState state_;
  Id file_;
  std::uint64_t closes_failed_before_ = failed_closes;
};

}  // namespace sunfleck::h5
