#include <sunfleck/core/cache_folder.hpp>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/folder.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/core/sha256.hpp>

namespace sunfleck {

namespace fs = std::filesystem;

std::string sealed(const std::string& format_line, const std::string& key, std::string_view payload) {
  return format_line + key + "\n" + sha256_hex(payload) + "\n" + std::string(payload);
}

std::optional<std::string_view> payload_of(std::string_view entry, const std::string& format_line, const std::string& key) {
  const std::string head = format_line + key + "\n";
  constexpr std::size_t digits = 64;
  if (entry.size() < head.size() + digits + 1 || entry.substr(0, head.size()) != head) return {};
  entry.remove_prefix(head.size());
  const auto sum = entry.substr(0, digits);
  entry.remove_prefix(digits + 1);
  return sha256_hex(entry) == sum ? std::optional(entry) : std::nullopt;
}

CacheFolder::CacheFolder(std::string folder, std::string suffix, std::uint64_t limit_bytes, std::string without, Progress& progress)
    : folder_(std::move(folder)), suffix_(std::move(suffix)), limit_bytes_(limit_bytes), without_(std::move(without)), progress_(progress) {
  if (folder_.empty()) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (std::error_code none; !fs::is_directory(folder_, none))
    warn("cannot be made" + (error ? ": " + error.message() : std::string(": there is a file of that name")));
}

void CacheFolder::warn(const std::string& text) {
  if (!warned_) progress_.line("note: cache folder " + folder_ + " " + text + "; " + without_ + " without it");
  warned_ = true;
}

std::string CacheFolder::path(const std::string& key) const {
  return (fs::path(folder_) / (key + suffix_)).string();
}

bool CacheFolder::is_entry_name(const std::string& name) const {
  constexpr std::size_t key_digits = 64;
  return name.size() == key_digits + suffix_.size() && name.ends_with(suffix_) && name.find_first_not_of("0123456789abcdef") == key_digits;
}

std::optional<std::string> CacheFolder::find(const std::string& key, bool& there) const {
  there = false;
  if (folder_.empty()) return {};
  const std::string file = path(key);
  std::error_code error;
  const auto status = fs::symlink_status(file, error);
  there = fs::exists(status);
  if (!fs::is_regular_file(status)) return {};
  try {
    const InputRecord aside;  // an entry is no input: it may be replaced
    auto bytes = read_input_file(file);
    ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0);  // used now
    return bytes;
  } catch (const InputError&) {  // as good as damaged
    return {};
  }
}

bool CacheFolder::store(const std::string& key, std::string_view bytes) {
  if (folder_.empty() || bytes.size() > limit_bytes_) return false;
  try {
    ReplacedFile file(path(key), ReplacedFile::Links::replace);
    file.write(bytes);
    file.commit();
  } catch (const OutputError& error) {
    const std::string text = error.what(), reason = text.substr(text.rfind(": ") + 2);
    warn("cannot be written: " + reason);
    return false;
  }
  shrink(path(key));
  return true;
}

void CacheFolder::shrink(const std::string& newest) const {
  struct Entry {
    fs::file_time_type used;
    std::uint64_t bytes;
    fs::path path;
  };
  std::vector<Entry> entries;
  std::uint64_t total = 0;
  std::error_code error;  // another process may be shrinking the same folder: what is gone is gone
  for (const auto& name : names_in(folder_)) {
    if (!is_entry_name(name)) continue;
    const fs::path entry = fs::path(folder_) / name;
    const auto used = fs::last_write_time(entry, error);
    const auto bytes = error ? 0 : fs::file_size(entry, error);
    if (!error) {
      entries.push_back({used, bytes, entry});
      total += bytes;
    }
    error.clear();
  }
  remove_abandoned(folder_, suffix_);
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const auto& e : entries) {
    if (total <= limit_bytes_) break;
    if (e.path == newest) continue;
    fs::remove(e.path, error);
    total -= e.bytes;
  }
}

}  // namespace sunfleck
