// Pictures that grow while somebody looks at them.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <sunfleck/view/image.hpp>

#include "view/viewer_shader.hpp"

namespace sunfleck {

/// Mean of all rays traced so far for one view. Rays come in sixteenths of a pass: after the first, every 4 x 4 block of pixels has one,
/// and shows it where its other pixels are still missing. Ray k of a pixel depends on pixel and k only: the same picture for any number of
/// threads and any division of the time.
class ViewerFrame {
 public:
  ViewerFrame(int width, int height);

  /// Traces until the time is over, at least one sixteenth, or `cancelled` says so, or `samples` rays a pixel are there.
  void refine(const ViewerShader& shader, const Camera& camera, std::chrono::milliseconds time, int samples,
              const std::function<bool()>& cancelled);
  /// Rays per pixel; a sixteenth is one 1/16.
  double samples() const { return parts_ / 16.0; }
  /// What there is, with an outline about the facets for which `inside` holds.
  Image picture(const std::function<bool(std::uint32_t facet)>& inside) const;
  std::size_t bytes() const { return sum_.size() * (sizeof(Rgb) + sizeof(std::uint32_t)); }

 private:
  int width_, height_;
  int parts_ = 0;
  std::vector<Rgb> sum_;
  std::vector<std::uint32_t> facet_;  ///< of the first ray of each pixel
};

/// What a request for a picture gets.
struct ShownFrame {
  Image image{1, 1};
  double samples = 0;
  bool done = false;   ///< nothing more will come
  bool draft = false;  ///< light and shadows are still being prepared
};

/// The pictures that are growing, the least recently asked for dropped first.
class FrameStore {
 public:
  /// A picture at once: one ray a pixel, light as stored.
  ShownFrame quick(const ViewerScenes& scenes, const ViewerView& view, const std::function<bool()>& cancelled) const;
  /// Adds `time` of rays to the picture of this view.
  ShownFrame refined(const ViewerScenes& scenes, const ViewerView& view, std::chrono::milliseconds time,
                     const std::function<bool()>& cancelled);

 private:
  struct Entry {
    std::string key;
    ViewerScenes scenes;  ///< kept alive, and told apart from a reloaded file
    std::mutex drawing;
    std::unique_ptr<ViewerShader> shader;
    std::unique_ptr<ViewerFrame> frame;
  };
  std::mutex mutex_;
  std::list<std::shared_ptr<Entry>> entries_;
};

}  // namespace sunfleck
