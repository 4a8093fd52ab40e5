// What the viewer answers to a request, whatever carries it.
#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "view/answer.hpp"
#include "view/viewer_frame.hpp"

namespace sunfleck {

/// Answers for one or two open results. All members may be called from any number of threads.
class ViewerService {
 public:
  explicit ViewerService(std::vector<std::string> files) : files_(std::move(files)) {}

  /// Reads the files; until then answers are 503. Throws what Result throws, and Stopped.
  void load();
  /// What is being read or drawn is given up as soon as can be, here and in load.
  void stop() { stopping_.stopped = true; }
  /// Reads files that were replaced; those that cannot be read stay as they were. True if all are as on disk now.
  bool reload(std::string& problem);

  /// `path` without its query; `post` is true for POST. Never throws: what is wrong with a request becomes 400, 404 or 405 with {"error"}.
  Answer answer(bool post, const std::string& path, const Parameters& parameters);

 private:
  ViewerScenes scenes() const;
  Answer status() const;
  Answer frame(const ViewerScenes& scenes, const Parameters& parameters);
  Answer table(const std::string& path, const ViewerScenes& scenes, const Parameters& parameters) const;
  /// True once a later request of the same client has come, or the viewer ends: its picture is not wanted any more.
  std::function<bool()> turn_over(const Parameters& parameters);

  class Stopping final : public Progress {
   public:
    std::atomic<bool> stopped{false};
    bool cancelled() const override { return stopped; }
  };

  std::vector<std::string> files_;
  Stopping stopping_;         ///< outlives the scenes, which ask it
  mutable std::mutex mutex_;  ///< guards what follows
  ViewerScenes scenes_;
  std::uint64_t generation_ = 0;  ///< of what is loaded
  struct Client {
    std::string name;
    std::shared_ptr<std::atomic<std::uint64_t>> turn;
  };
  std::list<Client> clients_;

  std::mutex reloading_;
  FrameStore frames_;
};

}  // namespace sunfleck
