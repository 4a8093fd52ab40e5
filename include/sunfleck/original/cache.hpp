// Tables on disk, by the hash of all that they depend on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <sunfleck/core/cache_folder.hpp>
#include <sunfleck/core/progress.hpp>
#include <sunfleck/original/measure.hpp>

namespace sunfleck {

/// 64 hexadecimal digits that change with geometry, optics, settings and the version of the measurement, and with nothing else.
std::string original_key(const OriginalGeometry& geometry, const MeasureSettings& settings);

/// Where tables come from.
enum class CacheState {
  off,      ///< no cache
  found,    ///< read from the cache
  stored,   ///< measured and stored
  rebuilt,  ///< measured and stored in place of an entry that was damaged or of another format
  unsaved   ///< measured; the cache could not be written
};
std::string name_of(CacheState state);

/// A folder (CacheFolder) with one file per original, KEY.original; what does not fit is measured anew.
class OriginalCache {
 public:
  /// An empty folder name is no cache.
  OriginalCache(std::string folder, std::uint64_t limit_bytes, Progress& progress);

  const std::string& folder() const { return files_.folder(); }
  /// Reads or measures.
  OriginalTables tables(const OriginalGeometry& geometry, const MeasureSettings& settings, CacheState& state);
  /// The entry, if there is a sound one; `damaged` tells that there was another.
  std::optional<OriginalTables> find(const std::string& key, bool& damaged) const;
  /// False if it could not be written.
  bool store(const std::string& key, const OriginalTables& tables);

 private:
  CacheFolder files_;
  Progress& progress_;
};

inline constexpr std::uint64_t default_cache_bytes = std::uint64_t{256} << 20;

/// $XDG_CACHE_HOME/sunfleck, else $HOME/.cache/sunfleck, else empty.
std::string default_cache_folder();

}  // namespace sunfleck
