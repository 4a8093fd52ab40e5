// One result file as the viewer holds it.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <future>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/result/scene_match.hpp>
#include <sunfleck/view/picture.hpp>
#include <sunfleck/view/stored.hpp>
#include <sunfleck/visibility/quick_rays.hpp>

#include "view/natural_paint.hpp"

namespace sunfleck {

/// Which file lies under a name, as far as the file system tells.
struct FileStamp {
  std::uint64_t device = 0, inode = 0, bytes = 0;
  std::int64_t modified_ns = 0;
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};
std::optional<FileStamp> file_stamp(const std::string& file);

/// Throws InputError if so many facets, of which `distinct` are stored and the others are copies, need more bytes than they may take
/// (0: not known): at the most 220 bytes for corners and values of each, 350 for the trees of rays and the mesh of a distinct one.
void check_viewer_memory(const std::string& file, std::size_t facets, std::size_t distinct, std::size_t available);

/// Values of a quantity, with the scales they suggest.
struct ViewerMap {
  FacetMap map;
  ValueScale linear, logarithmic;
};

/// The drawn part of a light: for quick pictures as stored, for fine ones with sharp shadows.
struct ViewerLight {
  StateLight stored;
  ColourBands bands;
  std::vector<std::vector<SurfaceKind>> surfaces;  ///< [material][organ type]
};

/// How far the default camera stands from its target [m]: the larger of `by_height` and `by_width` / (width / height of the picture).
struct Framing {
  Vec3 target{0.0};
  double by_height = 1, by_width = 1;
};

/// Everything of one version of a file. All members may be called from any number of threads; what is read later comes under one lock,
/// since HDF5 knows one thread only. The file stays open: a file that is replaced by renaming does not disturb it.
class ViewerScene {
 public:
  /// Reads what the first picture needs; the exact ray tree is then built in the background, unless most facets are copies: then it is
  /// there at once. Throws what Result throws; InputError where memory does not suffice; Stopped when `stopping`, which must outlive it,
  /// is cancelled.
  explicit ViewerScene(const std::string& file, Progress& stopping = silent());
  ~ViewerScene();
  ViewerScene(const ViewerScene&) = delete;
  ViewerScene& operator=(const ViewerScene&) = delete;

  const std::string& file() const { return file_; }
  const FileStamp& stamp() const { return stamp_; }
  const ResultHeader& header() const { return result_->header(); }
  const std::vector<std::string>& bands() const { return result_->bands(); }
  const std::vector<std::string>& units() const { return result_->band_units(); }
  const std::vector<LightState>& states() const { return result_->states(); }
  const FacetScene& scene() const { return scene_; }
  const std::vector<std::string>& quantities() const { return quantities_; }  ///< those of quantity_names() that the file keeps

  /// Facets of organ o: organ_facets()[organ_first()[o] ... organ_first()[o + 1]).
  const std::vector<std::uint32_t>& organ_first() const { return organ_first_; }
  const std::vector<std::uint32_t>& organ_facets() const { return organ_facets_; }
  float organ_area(std::size_t organ) const { return organ_area_[organ]; }  ///< the file's [m^2]
  Vec3 normal(std::size_t facet) const;                                     ///< unit, of the front

  /// How far this one, the first, and another are of one scene.
  SceneMatch match(const ViewerScene& other) const;

  const Framing& framing() const { return framing_; }

  /// Nearest facet; `infinite`: a periodic scene repeats. From the exact tree once it is there; u and v are then those of the mesh's own
  /// corners, as in PlacedHit.
  RayHit first_hit(const Vec3& origin, const Vec3& direction, std::uint32_t start, double range, bool infinite) const;
  bool exact() const { return exact_ready_; }
  void wait_for_exact() const;

  /// Throws UsageError for an unknown quantity, InputError where the file does not hold it or is damaged.
  std::shared_ptr<const ViewerMap> map(const std::string& quantity, std::size_t band, std::size_t state) const;
  std::shared_ptr<const ViewerLight> light(std::size_t state) const;
  /// Null while it is being prepared in the background (and before the exact tree is there); `wait` waits for it.
  std::shared_ptr<const NaturalPaint> natural(std::size_t state, bool wait = false) const;

  /// Rows of one organ or facet: [width] floats of a dataset [states][rows][...]; empty where it is not kept.
  std::vector<float> row(const std::string& dataset, std::size_t state, std::size_t row) const;

 private:
  /// Begins to build the exact tree: after the first values are read, so that the first picture need not wait for the file.
  void build_exact() const;

  std::string file_;
  Progress& stopping_;
  FileStamp stamp_;
  std::unique_ptr<Result> result_;
  FacetScene scene_;
  std::vector<std::string> quantities_;
  std::vector<std::uint32_t> organ_first_, organ_facets_;
  std::vector<float> organ_area_;
  Framing framing_;
  std::unique_ptr<QuickRays> quick_;  ///< none where the exact tree is there at once
  mutable std::unique_ptr<DrawnScene> drawn_;
  mutable std::unique_ptr<PlacedRays> rays_;  ///< both written once, before exact_ready_
  mutable std::atomic<bool> exact_ready_{false};
  mutable std::once_flag begun_;
  mutable std::shared_future<void> building_;

  mutable std::mutex matching_;  ///< guards the latest match
  mutable FileStamp matched_;
  mutable std::optional<SceneMatch> match_;

  mutable std::mutex reading_;  ///< guards the file and the caches below
  struct CachedMap {
    std::string quantity;
    std::size_t band, state;
    std::shared_ptr<const ViewerMap> map;
  };
  mutable std::list<CachedMap> maps_;  ///< the latest first
  mutable std::map<std::size_t, std::shared_ptr<const ViewerLight>> lights_;
  mutable std::map<std::size_t, std::shared_future<std::shared_ptr<const NaturalPaint>>> naturals_;
};

}  // namespace sunfleck
