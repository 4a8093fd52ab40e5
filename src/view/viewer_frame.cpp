#include "view/viewer_frame.hpp"

#include <algorithm>
#include <array>

#include <tbb/parallel_for.h>

#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t frames_kept = 4;
constexpr int map_samples = 16, natural_samples = 36;  ///< rays a pixel of a finished picture

/// Pixels of a 4 x 4 block in the order in which they are traced (Bayer 1973): any first few are spread evenly.
constexpr std::array<std::array<int, 2>, 16> block_order{
    {{0, 0}, {2, 2}, {2, 0}, {0, 2}, {1, 1}, {3, 3}, {3, 1}, {1, 3}, {1, 0}, {3, 2}, {3, 0}, {1, 2}, {0, 1}, {2, 3}, {2, 1}, {0, 3}}};

constexpr std::array<int, 16> block_ranks() {
  std::array<int, 16> rank{};
  for (int k = 0; k < 16; ++k)
    rank[static_cast<std::size_t>(4 * block_order[static_cast<std::size_t>(k)][1] + block_order[static_cast<std::size_t>(k)][0])] = k;
  return rank;
}
constexpr auto block_rank = block_ranks();

int rank_of(int x, int y) {
  return block_rank[static_cast<std::size_t>(4 * (y & 3) + (x & 3))];
}

}  // namespace

ViewerFrame::ViewerFrame(int width, int height)
    : width_(width),
      height_(height),
      sum_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Rgb{0.0f}),
      facet_(sum_.size(), no_facet) {}

void ViewerFrame::refine(const ViewerShader& shader, const Camera& camera, std::chrono::milliseconds time, int samples,
                         const std::function<bool()>& cancelled) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (parts_ < 16 * samples) {
    const int pass = parts_ / 16;
    const auto [bx, by] = block_order[static_cast<std::size_t>(parts_ % 16)];
    const auto [dx, dy] = r2_point(static_cast<std::uint64_t>(pass), 0.5, 0.5);
    tbb::parallel_for(0, (height_ - by + 3) / 4, [&, x0 = bx, y0 = by, dx_ = dx, dy_ = dy](int row) {
      const int y = 4 * row + y0;
      for (int x = x0; x < width_; x += 4) {
        const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        std::uint32_t facet = no_facet;
        sum_[i] += shader(camera.ray((x + dx_) / width_, (y + dy_) / height_), mix(i, static_cast<std::uint64_t>(pass)), facet);
        if (pass == 0) facet_[i] = facet;
      }
    });
    ++parts_;
    if (std::chrono::steady_clock::now() >= end || cancelled()) return;
  }
}

Image ViewerFrame::picture(const std::function<bool(std::uint32_t facet)>& inside) const {
  Image image(width_, height_);
  const int pass = parts_ / 16, part = parts_ % 16;
  const auto rays = [&](int x, int y) { return pass + (rank_of(x, y) < part ? 1 : 0); };
  // Where a pixel has no ray yet, the one that its 2 x 2 or 4 x 4 block had first.
  const auto source = [&](int x, int y) {
    if (rays(x, y) > 0) return std::array{x, y};
    const std::array half{x & ~1, y & ~1};
    if (rays(half[0], half[1]) > 0) return half;
    return std::array{x & ~3, y & ~3};
  };
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  };
  tbb::parallel_for(0, height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const auto [sx, sy] = source(x, y);
      const int count = rays(sx, sy);
      image.at(x, y) = count > 0 ? encode_srgb(sum_[at(sx, sy)] / static_cast<float>(count)) : Rgb8{128, 128, 128};
    }
  });
  if (!inside) return image;
  std::vector<std::uint8_t> in(sum_.size());
  tbb::parallel_for(0, height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const auto [sx, sy] = source(x, y);
      const auto facet = facet_[at(sx, sy)];
      in[at(x, y)] = facet != no_facet && inside(facet);
    }
  });
  tbb::parallel_for(0, height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      if (in[at(x, y)]) continue;
      bool near = false, next = false;
      for (int v = std::max(0, y - 2); v <= std::min(height_ - 1, y + 2); ++v)
        for (int u = std::max(0, x - 2); u <= std::min(width_ - 1, x + 2); ++u)
          if (in[at(u, v)]) near = true, next |= std::abs(u - x) <= 1 && std::abs(v - y) <= 1;
      // Dark outside, bright inside: seen on any colour.
      if (next)
        image.at(x, y) = {255, 0, 200};
      else if (near)
        image.at(x, y) = {20, 0, 16};
    }
  });
  return image;
}

ShownFrame FrameStore::quick(const ViewerScenes& scenes, const ViewerView& view, const std::function<bool()>& cancelled) const {
  const ViewerShader shader(scenes, view, true);
  const Camera camera = camera_of(view.camera, static_cast<double>(view.width) / view.height);
  ViewerFrame frame(view.width, view.height);
  frame.refine(shader, camera, std::chrono::seconds(2), 1, cancelled);
  const auto& organ = scenes[view.result]->scene().organ;
  std::function<bool(std::uint32_t)> inside;
  if (view.highlight) inside = [&](std::uint32_t facet) { return organ[facet] == *view.highlight; };
  return {frame.picture(inside), frame.samples(), false, true};
}

ShownFrame FrameStore::refined(const ViewerScenes& scenes, const ViewerView& view, std::chrono::milliseconds time,
                               const std::function<bool()>& cancelled) {
  const std::string key = view.key();
  std::shared_ptr<Entry> entry;
  {
    const std::lock_guard lock(mutex_);
    const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e->key == key && e->scenes == scenes; });
    if (known != entries_.end()) {
      entries_.splice(entries_.begin(), entries_, known);
    } else {
      entries_.push_front(std::make_shared<Entry>());
      entries_.front()->key = key, entries_.front()->scenes = scenes;
      if (entries_.size() > frames_kept) entries_.pop_back();
    }
    entry = entries_.front();
  }
  const std::lock_guard lock(entry->drawing);
  if (!entry->shader || !entry->shader->fine()) {  // begin again as soon as the final light is there
    auto shader = std::make_unique<ViewerShader>(scenes, view, false);
    if (!entry->shader || shader->fine()) {
      entry->frame = std::make_unique<ViewerFrame>(view.width, view.height);
      entry->shader = std::move(shader);
    }
  }
  const Camera camera = camera_of(view.camera, static_cast<double>(view.width) / view.height);
  const bool natural = view.shown.quantity == "colour", draft = !entry->shader->fine();
  const int samples = draft ? 4 : natural ? natural_samples : map_samples;
  if (entry->frame->samples() < samples) entry->frame->refine(*entry->shader, camera, time, samples, cancelled);
  const auto& organ = scenes[view.result]->scene().organ;
  std::function<bool(std::uint32_t)> inside;
  if (view.highlight) inside = [&](std::uint32_t facet) { return organ[facet] == *view.highlight; };
  return {entry->frame->picture(inside), entry->frame->samples(), !draft && entry->frame->samples() >= samples, draft};
}

}  // namespace sunfleck
