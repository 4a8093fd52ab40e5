#include <sunfleck/original/cache.hpp>

#include <cstdlib>
#include <type_traits>

#include <sunfleck/core/sha256.hpp>

#include "original/entry.hpp"

namespace sunfleck {

namespace {

/// Raised whenever the measurement changes its numbers.
constexpr std::uint32_t measurement_version = 1;

template <class T>
void put(std::string& text, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::string& text, const std::vector<float>& values) {
  put(text, static_cast<std::uint64_t>(values.size()));
  for (const float v : values) put(text, v);
}

}  // namespace

std::string original_key(const OriginalGeometry& geometry, const MeasureSettings& settings) {
  std::string text = "sunfleck original";
  put(text, measurement_version);
  put(text, static_cast<std::uint32_t>(settings.tables.basis));
  put(text, settings.tables.basis == TableSettings::Basis::harmonics ? settings.tables.order : 0u);
  put(text, settings.tables.error);
  put(text, settings.seed);
  put(text, settings.most_samples);
  put(text, settings.fit);
  put(text, geometry.bands);
  put(text, static_cast<std::uint64_t>(geometry.materials.size()));
  for (const auto& m : geometry.materials) {  // names do not count
    put(text, m.reflectance_front);
    put(text, m.reflectance_back);
    put(text, m.transmittance);
  }
  for (std::size_t i = 0; i < geometry.corners.size(); ++i) {
    for (const auto& p : geometry.corners[i])
      for (int k = 0; k < 3; ++k) put(text, p[k] + 0.0);  // -0 is 0
    put(text, geometry.optics[i]);
  }
  return sha256_hex(text);
}

std::string name_of(CacheState state) {
  switch (state) {
    case CacheState::off:
      return "off";
    case CacheState::found:
      return "found";
    case CacheState::stored:
      return "stored";
    case CacheState::rebuilt:
      return "rebuilt";
    case CacheState::unsaved:
      return "unsaved";
  }
  return {};
}

OriginalCache::OriginalCache(std::string folder, std::uint64_t limit_bytes, Progress& progress)
    : files_(std::move(folder), ".original", limit_bytes, "originals are measured", progress), progress_(progress) {}

std::optional<OriginalTables> OriginalCache::find(const std::string& key, bool& damaged) const {
  const auto entry = files_.find(key, damaged);
  std::optional<OriginalTables> tables;
  if (entry) tables = from_entry(*entry, key);
  damaged = damaged && !tables;
  return tables;
}

bool OriginalCache::store(const std::string& key, const OriginalTables& tables) {
  return !files_.off() && files_.store(key, to_entry(tables, key));
}

OriginalTables OriginalCache::tables(const OriginalGeometry& geometry, const MeasureSettings& settings, CacheState& state) {
  if (files_.off()) {
    state = CacheState::off;
    return measure_original(geometry, settings, progress_);
  }
  const std::string key = original_key(geometry, settings);
  bool damaged = false;
  if (auto found = find(key, damaged)) {
    state = CacheState::found;
    return std::move(*found);
  }
  OriginalTables measured = measure_original(geometry, settings, progress_);
  state = !store(key, measured) ? CacheState::unsaved : damaged ? CacheState::rebuilt : CacheState::stored;
  return measured;
}

std::string default_cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache == '/') return std::string(cache) + "/sunfleck";  // the specification: relative paths do not count
  const char* home = std::getenv("HOME");
  return home && *home ? std::string(home) + "/.cache/sunfleck" : std::string{};
}

}  // namespace sunfleck
