#include <sunfleck/original/cache.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <type_traits>

#include <fcntl.h>
#include <sys/stat.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/folder.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/core/sha256.hpp>

#include "original/entry.hpp"

namespace sunfleck {

namespace {

namespace fs = std::filesystem;

/// Raised whenever the measurement changes its numbers.
constexpr std::uint32_t measurement_version = 1;
constexpr const char* suffix = ".original";

template <class T>
void put(std::string& text, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::string& text, const std::vector<float>& values) {
  put(text, static_cast<std::uint64_t>(values.size()));
  for (const float v : values) put(text, v);
}

/// KEY.original: other files of the folder are none of ours.
bool is_entry_name(const std::string& name) {
  constexpr std::size_t key_digits = 64;
  return name.size() == key_digits + std::string_view(suffix).size() && name.ends_with(suffix) &&
         name.find_first_not_of("0123456789abcdef") == key_digits;
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
    : folder_(std::move(folder)), limit_bytes_(limit_bytes), progress_(progress) {
  if (folder_.empty()) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (std::error_code none; !fs::is_directory(folder_, none))
    warn("cannot be made" + (error ? ": " + error.message() : std::string(": there is a file of that name")));
}

void OriginalCache::warn(const std::string& text) {
  if (!warned_) progress_.line("note: cache folder " + folder_ + " " + text + "; originals are measured without it");
  warned_ = true;
}

std::optional<OriginalTables> OriginalCache::find(const std::string& key, bool& damaged) const {
  damaged = false;
  if (folder_.empty()) return {};
  const std::string path = (fs::path(folder_) / (key + suffix)).string();
  std::error_code error;
  const auto status = fs::symlink_status(path, error);
  if (!fs::exists(status)) return {};
  std::optional<OriginalTables> tables;
  try {
    const InputRecord aside;  // an entry is no input: it may be replaced
    if (fs::is_regular_file(status)) tables = from_entry(read_input_file(path), key);
  } catch (const InputError&) {  // as good as damaged
  }
  damaged = !tables;
  if (tables) ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);  // used now
  return tables;
}

bool OriginalCache::store(const std::string& key, const OriginalTables& tables) {
  if (folder_.empty()) return false;
  const std::string path = (fs::path(folder_) / (key + suffix)).string(), bytes = to_entry(tables, key);
  if (bytes.size() > limit_bytes_) return false;
  try {
    ReplacedFile file(path, ReplacedFile::Links::replace);
    file.write(bytes);
    file.commit();
  } catch (const OutputError& error) {
    const std::string text = error.what(), reason = text.substr(text.rfind(": ") + 2);
    warn("cannot be written: " + reason);
    return false;
  }
  shrink(path);
  return true;
}

void OriginalCache::shrink(const std::string& newest) const {
  struct Entry {
    fs::file_time_type used;
    std::uint64_t bytes;
    fs::path path;
  };
  std::vector<Entry> entries;
  std::uint64_t total = 0;
  std::error_code error;  // another process may be shrinking the same folder: what is gone is gone
  for (const auto& name : names_in(folder_)) {
    const fs::path path = fs::path(folder_) / name;
    const auto used = fs::last_write_time(path, error);
    if (error) {
      error.clear();
      continue;
    }
    if (is_entry_name(name)) {
      const auto bytes = fs::file_size(path, error);
      if (!error) {
        entries.push_back({used, bytes, path});
        total += bytes;
      }
    }
    error.clear();
  }
  remove_abandoned(folder_, suffix);
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const auto& e : entries) {
    if (total <= limit_bytes_) break;
    if (e.path == newest) continue;
    fs::remove(e.path, error);
    total -= e.bytes;
  }
}

OriginalTables OriginalCache::tables(const OriginalGeometry& geometry, const MeasureSettings& settings, CacheState& state) {
  if (folder_.empty()) {
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
