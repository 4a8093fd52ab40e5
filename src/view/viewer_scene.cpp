#include "view/viewer_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <sys/stat.h>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <sunfleck/core/error.hpp>

#include "view/picture_frame.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t maps_kept = 12, lights_kept = 3;

/// In the background; where the system gives no thread, by whoever asks for it first.
constexpr auto where_threads_last = std::launch::async | std::launch::deferred;

bool is_deferred(const auto& future) {
  return future.wait_for(std::chrono::seconds(0)) == std::future_status::deferred;
}

/// HDF5 knows one thread only, whatever the file.
std::mutex& hdf5() {
  static std::mutex mutex;
  return mutex;
}

bool is_kept(const Result& result, const std::string& quantity) {
  if (quantity.ends_with("error")) return false;  // needs a reference: the difference of two results stands for it here
  const auto has = [&](const std::string& name) { return result.has("facets/" + name) || result.has("organs/" + name); };
  const bool organs = quantity.starts_with("organ_");
  const std::string plain = organs ? quantity.substr(6) : quantity;
  for (const char* name : {"absorbed", "irradiance", "sunlit"})
    if (plain == name || plain.starts_with(std::string(name) + "_")) return organs ? result.has(std::string("organs/") + name) : has(name);
  return quantity != "colour" || has("irradiance");
}

/// Facets of all distinct plants.
std::size_t distinct_facets(const Result& result) {
  const auto shapes = result.shape("geometry/shape_triangle_count");
  std::size_t sum = 0;
  if (!shapes.empty())
    for (const auto n : result.rows<std::uint32_t>("geometry/shape_triangle_count", 0, shapes.front())) sum += n;
  return sum;
}

/// 0 where the system does not tell.
std::size_t available_bytes() {
  std::ifstream in("/proc/meminfo");
  for (std::string name, rest; in >> name && std::getline(in, rest);)
    if (name == "MemAvailable:") return std::strtoull(rest.c_str(), nullptr, 10) * 1024;
  return 0;
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

void check_viewer_memory(const std::string& file, std::size_t facets, std::size_t distinct, std::size_t available) {
  constexpr double gibibyte = 1024.0 * 1024.0 * 1024.0;
  const std::size_t needed = facets * 220 + std::min(distinct, facets) * 350;
  if (available > 0 && needed > available)
    throw InputError(
        location(file), fmt::format("{} facets, which take about {:.1f} GiB to view", facets, static_cast<double>(needed) / gibibyte),
        fmt::format("at most {:.1f} GiB, three quarters of what is free on this machine; 'sunfleck render' draws results of any size",
                    static_cast<double>(available) / gibibyte));
}

ViewerScene::ViewerScene(const std::string& file, Progress& stopping) : file_(file), stopping_(stopping) {
  bool copies = false;  // most facets are
  {
    const std::lock_guard lock(hdf5());
    // The stamp first: a file replaced meanwhile is then noticed rather than missed.
    stamp_ = file_stamp(file).value_or(FileStamp{});
    result_ = std::make_unique<Result>(file);
    const std::size_t kept = result_->facet_count();
    const std::size_t facets = kept > 0 ? kept : result_->geometry().facet_count();
    const std::size_t distinct = distinct_facets(*result_);
    check_viewer_memory(file, facets, distinct, available_bytes() / 4 * 3);
    copies = 2 * distinct <= facets;
    stopping_.check();
    scene_ = stored_scene(*result_);
    stopping_.check();
    organ_area_ = result_->rows<float>("organs/area", 0, scene_.organs.size());
    for (const auto& name : quantity_names())
      if (is_kept(*result_, name)) quantities_.push_back(name);
    if (copies) drawn_ = std::make_unique<DrawnScene>(*result_);
  }
  stopping_.check();
  const std::size_t n = scene_.size(), m = scene_.organs.size();
  const auto first_tree = [&] {
    if (copies)
      rays_ = std::make_unique<PlacedRays>(*drawn_);
    else
      quick_ = std::make_unique<QuickRays>(scene_);
  };
  tbb::parallel_invoke(first_tree, [&] { framing_ = framing_of(scene_); });
  organ_first_.assign(m + 1, 0);
  for (const auto o : scene_.organ) ++organ_first_[o + 1];
  for (std::size_t o = 0; o < m; ++o) organ_first_[o + 1] += organ_first_[o];
  organ_facets_.resize(n);
  auto next = organ_first_;
  for (std::uint32_t f = 0; f < n; ++f) organ_facets_[next[scene_.organ[f]]++] = f;

  exact_ready_ = copies;
}

void ViewerScene::build_exact() const {
  std::call_once(begun_, [this] {
    building_ = std::async(where_threads_last, [this] {
                  if (exact_ready_) return;
                  stopping_.check();
                  {
                    const std::lock_guard lock(hdf5());
                    drawn_ = std::make_unique<DrawnScene>(*result_);
                  }
                  rays_ = std::make_unique<PlacedRays>(*drawn_);
                  exact_ready_ = true;
                }).share();
    if (is_deferred(building_)) building_.wait();
  });
}

ViewerScene::~ViewerScene() {
  if (building_.valid()) building_.wait();
  for (auto& [state, natural] : naturals_)
    if (!is_deferred(natural)) natural.wait();
  const std::lock_guard lock(hdf5());
  result_.reset();
}

RayHit ViewerScene::first_hit(const Vec3& origin, const Vec3& direction, std::uint32_t start, double range, bool infinite) const {
  if (!exact_ready_) return quick_->first_hit(origin, direction, start, range);
  const auto part = infinite ? PlacedRays::Part::repeated : PlacedRays::Part::all;
  const PlacedHit met = rays_->first_hit(origin, direction, part, 0, range, start == no_facet ? no_placed_facet : start);
  RayHit hit;
  if (!met) return hit;
  hit.facet = static_cast<std::uint32_t>(met.facet), hit.u = met.u, hit.v = met.v, hit.distance = met.distance;
  hit.front = glm::dot(area_vector(scene_.corners[hit.facet]), direction) < 0;
  return hit;
}

Vec3 ViewerScene::normal(std::size_t facet) const {
  return front_normal(scene_.corners[facet]);
}

void ViewerScene::wait_for_exact() const {
  build_exact();
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
  build_exact();
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
  build_exact();
  made->bands = colour_bands(bands());
  for (const auto& material : scene_.materials) {
    auto& row = made->surfaces.emplace_back();
    for (const auto& type : scene_.organs.types) row.push_back(surface_of(type, material.name));
  }
  if (lights_.size() >= lights_kept) lights_.erase(lights_.begin());
  return lights_[state] = made;
}

namespace {

/// A paint with the light that it looks at.
struct HeldPaint {
  std::shared_ptr<const ViewerLight> light;
  LightSource source;
  std::optional<NaturalPaint> paint;
};

std::shared_ptr<const NaturalPaint> paint_of(const DrawnScene& scene, const PlacedRays& rays, std::shared_ptr<const ViewerLight> light,
                                             bool open_ground, Progress& stopping) {
  auto held = std::make_shared<HeldPaint>();
  held->light = std::move(light);
  held->source = light_source(held->light->stored, scene.size());
  held->paint.emplace(scene, rays, held->source, std::numeric_limits<std::size_t>::max());
  if (open_ground) held->paint->mark_ground();
  held->paint->read(stopping);
  return {held, &*held->paint};
}

}  // namespace

std::shared_ptr<const NaturalPaint> ViewerScene::natural(std::size_t state, bool wait) const {
  if (!exact_ready_ && !wait) return nullptr;
  const auto stored = light(state);
  build_exact();
  std::shared_future<std::shared_ptr<const NaturalPaint>> future;
  {
    const std::lock_guard lock(reading_);
    auto& slot = naturals_[state];
    if (!slot.valid()) {
      slot = std::async(where_threads_last, [this, stored] {
               building_.get();
               return paint_of(*drawn_, *rays_, stored, !scene_.periodic && scene_.plant_facets < scene_.size(), stopping_);
             }).share();
      for (auto old = naturals_.begin(); naturals_.size() > lights_kept && old != naturals_.end();) {
        const bool done = old->second.wait_for(std::chrono::seconds(0)) != std::future_status::timeout;
        old = old->first != state && done ? naturals_.erase(old) : std::next(old);
      }
    }
    future = naturals_[state];
  }
  if (!wait && future.wait_for(std::chrono::seconds(0)) == std::future_status::timeout) return nullptr;
  return future.get();
}

SceneMatch ViewerScene::match(const ViewerScene& other) const {
  const std::lock_guard lock(matching_);
  if (!match_ || matched_ != other.stamp()) {
    const std::lock_guard file(hdf5());
    match_ = match_scenes(*result_, *other.result_), matched_ = other.stamp();
  }
  return *match_;
}

std::vector<float> ViewerScene::row(const std::string& dataset, std::size_t state, std::size_t row) const {
  const std::lock_guard file(hdf5());
  return result_->has(dataset) ? result_->state_rows<float>(dataset, state, row, 1) : std::vector<float>{};
}

}  // namespace sunfleck
