// The interactive viewer: a server on this machine whose page shows results in a browser.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>

namespace sunfleck {

struct ViewerSettings {
  std::vector<std::string> results = {};             ///< one file, or two to compare
  std::optional<std::string> listen = std::nullopt;  ///< address to serve on instead of the loopback; needs a token
  std::optional<std::string> token = std::nullopt;   ///< what requests must bring: at least 16 letters, digits, '-' or '_'; "new" makes one
  int port = 0;                                      ///< 0 = any that is free
};

/// Serves the page and its pictures over HTTP. Ways in are kept narrow: only the loopback interface, only requests that name a loopback
/// host (so no foreign name that resolves here), none from pages of other origins; with `listen`, any host name, but only with the token.
/// Requests change nothing on disk.
class ViewerServer {
 public:
  /// Opens the files' headers and the port. Throws InputError for a file that is no result, UsageError for settings that cannot be,
  /// OutputError where the address or port cannot be had.
  explicit ViewerServer(const ViewerSettings& settings);
  ~ViewerServer();
  ViewerServer(const ViewerServer&) = delete;
  ViewerServer& operator=(const ViewerServer&) = delete;

  int port() const;
  /// What to open in a browser, token included.
  std::string url() const;
  /// Reads the results and answers requests until `progress` is cancelled. Throws what reading the results throws.
  void run(Progress& progress);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunfleck
