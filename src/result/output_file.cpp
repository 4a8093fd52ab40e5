#include "result/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

#include <sunfleck/core/error.hpp>

#include "result/output_driver.hpp"

namespace sunfleck::h5 {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) { throw OutputError(path + ": cannot be written: " + why); }

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path), final_(path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (path.empty()) throw UsageError("the name of the result file is empty");
  if (fs::is_symlink(path, error)) final_ = fs::weakly_canonical(path, error).string();  // keep the link, replace what it points to
  if (fs::is_directory(final_, error)) fail(path_, "it is a directory");
  if (fs::exists(final_, error) && !fs::is_regular_file(final_, error)) fail(path_, "it is not a regular file");

  const fs::path place(final_);
  temporary_ = (place.parent_path() / ("." + place.filename().string() + ".partial-" + std::to_string(::getpid()))).string();
  ::unlink(temporary_.c_str());
  state_.descriptor = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (state_.descriptor < 0) fail(path_, std::strerror(errno));

  const Quiet quiet;
  const Id access = output_access(state_);
  if (access) {
    H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110);
    Id creation{H5Pcreate(H5P_FILE_CREATE)};
    H5Pset_obj_track_times(creation.get(), false);  // the same bytes on every run
    file_ = Id{H5Fcreate(temporary_.c_str(), H5F_ACC_TRUNC, creation.get(), access.get())};
  }
  if (!file_) {
    ::close(state_.descriptor);
    ::unlink(temporary_.c_str());
    fail(path_, state_.error ? std::strerror(state_.error) : "HDF5 cannot create it");
  }
}

OutputFile::~OutputFile() {
  const Quiet quiet;
  if (!committed_ && state_.error == 0) state_.error = ECANCELED;  // nothing more needs to reach the disk
  file_.close();
  if (state_.descriptor >= 0) ::close(state_.descriptor);
  if (!committed_) ::unlink(temporary_.c_str());
}

void OutputFile::check(bool good) const {
  if (state_.error != 0) fail(path_, std::strerror(state_.error));
  if (!good) fail(path_, "HDF5 refused to store a dataset");
}

void OutputFile::commit() {
  const Quiet quiet;
  const bool flushed = H5Fflush(file_.get(), H5F_SCOPE_LOCAL) >= 0;
  check(flushed);
  file_.close();
  check();
  if (::fsync(state_.descriptor) != 0) fail(path_, std::strerror(errno));
  const int descriptor = std::exchange(state_.descriptor, -1);
  if (::close(descriptor) != 0) fail(path_, std::strerror(errno));
  if (std::rename(temporary_.c_str(), final_.c_str()) != 0) fail(path_, std::strerror(errno));
  committed_ = true;
}

}  // namespace sunfleck::h5
