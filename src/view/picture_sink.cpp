#include <sunfleck/view/picture_sink.hpp>

#include <algorithm>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

PictureSink::PictureSink(const Scene& scene, const PlacedScene& placed, std::size_t state, const PictureSettings& settings,
                         IrradianceSink* next, Progress& progress)
    : scene_(scene), state_(state), settings_(settings), next_(next), drawn_(scene, placed) {
  // A picture in the dark asks for what it needs.
  std::vector<Range> asked;
  LightSource dark = source();
  const std::size_t width = 2 * scene.band_count();
  dark.irradiance = [&](std::size_t first, std::size_t count) {
    asked.push_back({first, count, 0});
    return std::vector<float>(count * width, 0.0f);
  };
  dark.sunlit = nullptr;
  dark.sun.reset();
  PictureSettings looking = settings;
  looking.most_value_bytes = 1;
  looking.layers = false;
  draw_natural(drawn_, dark, looking, progress);
  std::sort(asked.begin(), asked.end(), [](const Range& a, const Range& b) { return a.first < b.first; });
  for (const auto& r : asked) {
    if (ranges_.empty() || r.first > ranges_.back().first + ranges_.back().count)
      ranges_.push_back({r.first, r.count, kept()});
    else
      ranges_.back().count = std::max(ranges_.back().count, r.first + r.count - ranges_.back().first);
  }
  irradiance_.assign(kept() * width, 0.0f);
  if (scene.states[state].sun) sunlit_.assign(kept() * 2, 0.0f);
}

void PictureSink::rows(const IrradianceRows& r) {
  const std::size_t width = 2 * scene_.band_count(), end = r.first_facet + r.count;
  auto at =
      std::upper_bound(ranges_.begin(), ranges_.end(), r.first_facet, [](std::size_t f, const Range& x) { return f < x.first + x.count; });
  for (; at != ranges_.end() && at->first < end; ++at) {
    const std::size_t first = std::max(at->first, r.first_facet), last = std::min(at->first + at->count, end);
    const std::size_t from = state_ * r.count + first - r.first_facet, to = at->place + first - at->first;
    std::copy_n(r.irradiance + from * width, (last - first) * width, irradiance_.data() + to * width);
    if (r.sunlit && !sunlit_.empty()) std::copy_n(r.sunlit + from * 2, (last - first) * 2, sunlit_.data() + to * 2);
  }
  sun_came_ = sun_came_ || r.sunlit;
  arrived_ = end;
  if (next_) next_->rows(r);
}

Picture PictureSink::draw(Progress& progress) const {
  if (arrived_ != drawn_.size()) throw Error("a picture was asked for before all rows had come");
  PictureSettings settings = settings_;
  settings.most_value_bytes = 1;  // only what is seen was kept
  return draw_natural(drawn_, source(), settings, progress);
}

LightSource PictureSink::source() const {
  LightSource out;
  out.block = 64;
  out.bands = scene_.bands;
  if (scene_.states[state_].sun && (sun_came_ || arrived_ == 0)) out.sun = *scene_.states[state_].sun;
  out.irradiance = [this](std::size_t first, std::size_t count) { return part(irradiance_, 2 * scene_.band_count(), first, count); };
  if (!sunlit_.empty()) out.sunlit = [this](std::size_t first, std::size_t count) { return part(sunlit_, 2, first, count); };
  return out;
}

/// Zeros where nothing was kept: nothing of it is seen.
std::vector<float> PictureSink::part(const std::vector<float>& values, std::size_t width, std::size_t first, std::size_t count) const {
  std::vector<float> out(count * width, 0.0f);
  auto at = std::upper_bound(ranges_.begin(), ranges_.end(), first, [](std::size_t f, const Range& x) { return f < x.first + x.count; });
  for (; at != ranges_.end() && at->first < first + count; ++at) {
    const std::size_t begin = std::max(at->first, first), end = std::min(at->first + at->count, first + count);
    std::copy_n(values.data() + (at->place + begin - at->first) * width, (end - begin) * width, out.data() + (begin - first) * width);
  }
  return out;
}

}  // namespace sunfleck
