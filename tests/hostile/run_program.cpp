#include "places.hpp"
#include "run_program.hpp"

#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace fs = std::filesystem;

ProgramRun run_sunfleck(const std::vector<std::string>& arguments, const ProgramFate& fate) {
  const TemporaryFolder folder;
  const std::string out = folder.path("out"), err = folder.path("err");
  std::vector<std::string> words{SUNFLECK_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    const auto redirect = [](const std::string& file, int stream) {
      if (file == "closed") {
        close(stream);
        return;
      }
      if (file == "broken pipe") {
        int ends[2];
        if (pipe(ends) != 0) _exit(126);
        close(ends[0]);
        dup2(ends[1], stream);
        close(ends[1]);
        return;
      }
      const int opened = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
      if (opened == stream) return;
      dup2(opened, stream);
      close(opened);  // else it would stay where another stream is to be closed
    };
    redirect(fate.out.empty() ? out : fate.out, STDOUT_FILENO);
    redirect(fate.err.empty() ? err : fate.err, STDERR_FILENO);
    if (fate.disk_bytes > 0) {
      const rlimit limit{fate.disk_bytes, fate.disk_bytes};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (fate.no_threads) {  // their stacks do not fit into what it may have
      const rlimit stack{rlim_t{8} << 30, RLIM_INFINITY}, all{rlim_t{4} << 30, RLIM_INFINITY};
      setrlimit(RLIMIT_STACK, &stack);
      setrlimit(RLIMIT_AS, &all);
    }
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_DFL);  // whatever the tests' runner makes of them
    if (fate.ignored_signal > 0) std::signal(fate.ignored_signal, SIG_IGN);
    if (fate.seconds > 0) alarm(fate.seconds);
    for (const auto& variable : fate.environment) putenv(const_cast<char*>(variable.c_str()));
    if (fate.memory_bytes > 0) {
      const rlimit limit{fate.memory_bytes, fate.memory_bytes};
      setrlimit(RLIMIT_AS, &limit);
    }
    execv(SUNFLECK_PROGRAM, argv.data());
    _exit(127);
  }
  int status = 0;
  bool ended = false;
  while (!fate.stop_at.empty() && !ended && text_of(err).find(fate.stop_at) == std::string::npos) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ended = waitpid(child, &status, WNOHANG) == child;
  }
  const auto began = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); };
  while (!ended && seconds() < fate.stop_after_s) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ended = waitpid(child, &status, WNOHANG) == child;
  }
  ProgramRun run;
  if (!ended) {
    const double asked = seconds();
    if (!fate.stop_at.empty() || fate.stop_after_s > 0) kill(child, fate.signal);
    waitpid(child, &status, 0);
    run.seconds_to_stop = seconds() - asked;
  }
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.out = text_of(out);
  run.err = text_of(err);
  return run;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "sunfleck-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
  folder_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::string TemporaryFolder::file(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
  return path(name);
}

std::vector<std::string> TemporaryFolder::listing() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}
