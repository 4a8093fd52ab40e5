#include "view/viewer_scene.hpp"

#include <algorithm>
#include <cmath>

#include <sys/stat.h>

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <sunfleck/core/error.hpp>

#include "view/picture_frame.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t maps_kept = 12, lights_kept = 3;

/// HDF5 knows one thread only, whatever the file.
std::mutex& hdf5() {
  static std::mutex mutex;
  return mutex;
}

bool kept(const Result& result, const std::string& quantity) {
  if (quantity.ends_with("error")) return false;  // needs a reference: the difference of two results stands for it here
  const auto has = [&](const std::string& name) { return result.has("facets/" + name) || result.has("organs/" + name); };
  const bool organs = quantity.starts_with("organ_");
  const std::string plain = organs ? quantity.substr(6) : quantity;
  for (const char* name : {"absorbed", "irradiance", "sunlit"})
    if (plain == name || plain.starts_with(std::string(name) + "_")) return organs ? result.has(std::string("organs/") + name) : has(name);
  return quantity != "colour" || has("irradiance");
}

Framing framing_of(const FacetScene& scene) {
  const auto points = framed_points(scene);
  Box box;
  for (const auto& p : points) box.add(p);
  Framing out;
  CameraChoice choice;
  choice.target = out.target = box.centre();
  const auto distance = [&](double aspect) { return glm::length(Camera(choice, points, aspect).eye() - out.target); };
  constexpr double narrow = 0.5, wide = 50;
  out.by_height = distance(wide), out.by_width = narrow * distance(narrow);
  return out;
}

std::vector<double> plant_values(const FacetMap& map, const FacetScene& scene) {
  const std::size_t end = scene.plant_facets > 0 ? scene.plant_facets : scene.size(), k = map.sides ? 2 : 1;
  std::vector<double> values;
  for (std::size_t f = 0; f < end; ++f)
    if (scene.area[f] > 0)
      for (std::size_t s = 0; s < k; ++s) values.push_back(map.values[k * f + s]);
  return values;
}

}  // namespace

std::optional<FileStamp> file_stamp(const std::string& file) {
  struct stat s {};
  if (::stat(file.c_str(), &s) != 0) return std::nullopt;
  return FileStamp{static_cast<std::uint64_t>(s.st_dev), static_cast<std::uint64_t>(s.st_ino), static_cast<std::uint64_t>(s.st_size),
                   s.st_mtim.tv_sec * 1000000000LL + s.st_mtim.tv_nsec};
}

ViewerScene::ViewerScene(const std::string& file) : file_(file) {
  {
    const std::lock_guard lock(hdf5());
    // The stamp first: a file replaced meanwhile is then noticed rather than missed.
    stamp_ = file_stamp(file).value_or(FileStamp{});
    result_ = std::make_unique<Result>(file);
    scene_ = stored_scene(*result_);
    organ_area_ = result_->rows<float>("organs/area", 0, scene_.organs.size());
    for (const auto& name : quantity_names())
      if (kept(*result_, name)) quantities_.push_back(name);
  }
  const std::size_t n = scene_.size(), m = scene_.organs.size();
  tbb::parallel_invoke([&] { quick_ = std::make_unique<QuickRays>(scene_); }, [&] { framing_ = framing_of(scene_); });
  normals_.resize(n);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t f) { normals_[f] = front_normal(scene_.corners[f]); });
  organ_first_.assign(m + 1, 0);
  for (const auto o : scene_.organ) ++organ_first_[o + 1];
  for (std::size_t o = 0; o < m; ++o) organ_first_[o + 1] += organ_first_[o];
  organ_facets_.resize(n);
  auto next = organ_first_;
  for (std::uint32_t f = 0; f < n; ++f) organ_facets_[next[scene_.organ[f]]++] = f;

  building_ = std::async(std::launch::async, [this] {
                rays_ = std::make_unique<RayScene>(scene_);
                if (scene_.periodic) {
                  cell_scene_ = std::make_unique<FacetScene>(scene_);
                  cell_scene_->periodic.reset();
                  cell_rays_ = std::make_unique<RayScene>(*cell_scene_);
                }
                exact_ready_ = true;
              }).share();
}

ViewerScene::~ViewerScene() {
  if (building_.valid()) building_.wait();
  for (auto& [state, natural] : naturals_) natural.wait();
  const std::lock_guard lock(hdf5());
  result_.reset();
}

RayHit ViewerScene::first_hit(const Vec3& origin, const Vec3& direction, std::uint32_t start, double range, bool infinite) const {
  if (!exact_ready_) return quick_->first_hit(origin, direction, start, range);
  return (cell_rays_ && !infinite ? *cell_rays_ : *rays_).first_hit(origin, direction, start, range);
}

void ViewerScene::wait_for_exact() const {
  building_.get();
}

std::shared_ptr<const ViewerMap> ViewerScene::map(const std::string& quantity, std::size_t band, std::size_t state) const {
  const std::lock_guard lock(reading_);
  const auto known = std::find_if(maps_.begin(), maps_.end(),
                                  [&](const CachedMap& c) { return c.quantity == quantity && c.band == band && c.state == state; });
  if (known != maps_.end()) {
    maps_.splice(maps_.begin(), maps_, known);
    return maps_.front().map;
  }
  MapChoice choice;
  choice.quantity = quantity, choice.band = band, choice.state = state;
  auto made = std::make_shared<ViewerMap>();
  {
    const std::lock_guard file(hdf5());
    made->map = stored_map(*result_, scene_, choice);
  }
  made->linear = made->map.scale;
  if (made->map.names.empty()) made->logarithmic = scale_for(plant_values(made->map, scene_), true);
  maps_.push_front({quantity, band, state, made});
  if (maps_.size() > maps_kept) maps_.pop_back();
  return made;
}

std::shared_ptr<const ViewerLight> ViewerScene::light(std::size_t state) const {
  const std::lock_guard lock(reading_);
  if (const auto known = lights_.find(state); known != lights_.end()) return known->second;
  auto made = std::make_shared<ViewerLight>();
  {
    const std::lock_guard file(hdf5());
    made->stored = stored_light(*result_, scene_, state);
  }
  made->bands = colour_bands(bands());
  for (const auto& material : scene_.materials) {
    auto& row = made->surfaces.emplace_back();
    for (const auto& type : scene_.organs.types) row.push_back(surface_of(type, material.name));
  }
  if (lights_.size() >= lights_kept) lights_.erase(lights_.begin());
  return lights_[state] = made;
}

std::shared_ptr<const NaturalLight> ViewerScene::natural(std::size_t state, bool wait) const {
  if (!exact_ready_ && !wait) return nullptr;
  const auto stored = light(state);
  std::shared_future<std::shared_ptr<const NaturalLight>> future;
  {
    const std::lock_guard lock(reading_);
    auto& slot = naturals_[state];
    if (!slot.valid()) {
      slot = std::async(std::launch::async, [this, stored] {
               building_.get();
               auto made = std::make_shared<NaturalLight>(scene_, stored->stored, *rays_);
               if (!scene_.periodic && scene_.plant_facets < scene_.size()) made->prepare_open_ground();
               return std::shared_ptr<const NaturalLight>(made);
             }).share();
      for (auto old = naturals_.begin(); naturals_.size() > lights_kept && old != naturals_.end();) {
        const bool done = old->second.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
        old = old->first != state && done ? naturals_.erase(old) : std::next(old);
      }
    }
    future = naturals_[state];
  }
  if (!wait && future.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return nullptr;
  return future.get();
}

std::vector<float> ViewerScene::row(const std::string& dataset, std::size_t state, std::size_t row) const {
  const std::lock_guard file(hdf5());
  return result_->has(dataset) ? result_->state_rows<float>(dataset, state, row, 1) : std::vector<float>{};
}

}  // namespace sunfleck
