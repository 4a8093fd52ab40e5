#include "original/entry.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include <sunfleck/core/cache_folder.hpp>

#include "original/harmonics.hpp"

namespace sunfleck {

namespace {

const std::string format_line = "sunfleck-original 1\n";
constexpr std::uint32_t byte_order = 0x01020304;

class Bytes {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    for (const auto& v : values) put(v);
  }
  std::string text;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  void get(T& value) {
    if (bytes_.size() < sizeof value) {
      sound = false;
      return;
    }
    std::memcpy(static_cast<void*>(&value), bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
  }
  void get(bool& value) {  // a byte that is neither 0 nor 1 is no bool
    std::uint8_t byte = 0;
    get(byte);
    sound = sound && byte <= 1;
    value = byte == 1;
  }
  template <class T>
  void get(std::vector<T>& values) {
    std::uint64_t count = 0;
    get(count);
    if (!sound || count > bytes_.size() / sizeof(T)) {
      sound = false;
      return;
    }
    values.resize(count);
    for (auto& v : values) get(v);
  }
  bool done() const { return sound && bytes_.empty(); }
  bool sound = true;

 private:
  std::string_view bytes_;
};

/// The same list for writing and reading.
template <class Stream, class Tables, class Call>
void each(Stream&, Tables& t, Call&& call) {
  call(t.basis), call(t.order), call(t.bands), call(t.sigma), call(t.intercepted), call(t.absorbed), call(t.phase), call(t.errors);
  call(t.sigma_error), call(t.hull), call(t.area_m2), call(t.facets), call(t.samples), call(t.rays), call(t.reached);
}

bool finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Numbers of the right sizes, and finite where light is reckoned with them.
bool plausible(const OriginalTables& t) {
  using Basis = TableSettings::Basis;
  if (t.basis == Basis::harmonics ? t.order > highest_order : t.basis != Basis::directions) return false;
  const std::size_t n = t.size(), bands = t.errors.size();
  if (t.bands != bands || bands == 0 || t.intercepted.size() != n || t.absorbed.size() != bands * n || t.phase.size() != bands * n * n ||
      t.sigma.size() != 49)
    return false;
  return finite(t.sigma) && finite(t.intercepted) && finite(t.absorbed) && finite(t.phase) && std::isfinite(t.area_m2) &&
         std::all_of(t.hull.begin(), t.hull.end(), [](const Triangle& h) { return finite(h[0]) && finite(h[1]) && finite(h[2]); });
}

}  // namespace

std::string to_entry(const OriginalTables& tables, const std::string& key) {
  Bytes bytes;
  bytes.put(byte_order);
  each(bytes, tables, [&](const auto& value) { bytes.put(value); });
  return sealed(format_line, key, bytes.text);
}

std::optional<OriginalTables> from_entry(std::string_view bytes, const std::string& key) {
  const auto payload = payload_of(bytes, format_line, key);
  if (!payload) return {};
  Reader reader(*payload);
  std::uint32_t order = 0;
  reader.get(order);
  OriginalTables t;
  each(reader, t, [&](auto& value) { reader.get(value); });
  if (order != byte_order || !reader.done() || !plausible(t)) return {};
  return t;
}

}  // namespace sunfleck
