#include "result/output_file.hpp"

#include <cerrno>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/h5_whole.hpp>

#include "result/output_driver.hpp"

namespace sunfleck::h5 {

OutputFile::OutputFile(const std::string& path) : replaced_(path) {
  const Quiet quiet;
  state_.descriptor = replaced_.descriptor();
  const Id access = output_access(state_), creation{H5Pcreate(H5P_FILE_CREATE)};
  if (access && creation && H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0 &&
      H5Pset_obj_track_times(creation.get(), false) >= 0) {  // the same bytes on every run
    file_ = Id{H5Fcreate(replaced_.temporary().c_str(), H5F_ACC_TRUNC, creation.get(), access.get())};
  }
  check(static_cast<bool>(file_));
}

OutputFile::~OutputFile() {
  const Quiet quiet;
  if (state_.error == 0) state_.error = ECANCELED;  // an unfinished file need not reach the disk
  file_.close();
}

void OutputFile::check(bool good) const {
  if (state_.error != 0) replaced_.fail(state_.error);
  if (!good) throw OutOfMemory("HDF5, which refused to store a dataset of " + path());  // the disk did not, and nothing else is left
}

void OutputFile::commit() {
  complete();
  replaced_.commit();
}

void OutputFile::commit_with(ReplacedFile& other) {
  complete();
  ReplacedFile::commit({&replaced_, &other});
}

void OutputFile::complete() {
  const Quiet quiet;
  const bool flushed = H5Fflush(file_.get(), H5F_SCOPE_LOCAL) >= 0;
  check(flushed);
  file_.close();
  check(failed_closes == closes_failed_before_);
  if (!is_whole(replaced_.temporary()))
    throw OutOfMemory("HDF5, which has lost a part of " + path() + ", as was noticed when it was read again");
}

}  // namespace sunfleck::h5
