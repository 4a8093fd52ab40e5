// Runs the built program as its user would and keeps what it says.
#pragma once

#include <string>
#include <vector>

struct ProgramRun {
  int exit_code = -1;  ///< 128 + signal if it was killed
  std::string out, err;
  double seconds_to_stop = 0;  ///< from the signal of ProgramFate to the end
};

/// What happens to the program while it runs.
struct ProgramFate {
  std::string stop_at;         ///< not empty: sends it `signal` once standard error holds this text
  double stop_after_s = 0;     ///< > 0: sends it `signal` after so many seconds
  int signal = 15;             ///< SIGTERM
  std::size_t disk_bytes = 0;  ///< > 0: no file may grow beyond this, as on a full disk
  bool no_threads = false;     ///< each thread that it wants is refused, as where the system has no more
  std::string out, err;        ///< not empty: a file that takes the place of standard output or error, such as /dev/full; "closed";
                               ///< "broken pipe": a pipe that nobody reads
  int ignored_signal = 0;      ///< > 0: a signal that it finds ignored, as under nohup
  unsigned seconds = 0;        ///< > 0: SIGALRM ends it after so long, if it has not ended
  std::vector<std::string> environment;  ///< "NAME=value", beside what is there
  std::size_t memory_bytes = 0;          ///< > 0: no more address space than this, as under ulimit -v
};

/// Runs build/.../sunfleck with the arguments given.
ProgramRun run_sunfleck(const std::vector<std::string>& arguments, const ProgramFate& fate = {});

/// A folder of its own under the system's temporary folder; removed with all it holds at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  /// Writes a file and returns its path.
  std::string file(const std::string& name, const std::string& text) const;
  /// Names of what it holds, sorted.
  std::vector<std::string> listing() const;

 private:
  std::string folder_;
};

std::string text_of(const std::string& file);
