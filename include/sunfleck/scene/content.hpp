// Keys of what things are, by content: two things with the same key are the same for light, wherever they come from.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Grows by values, ends as 64 hexadecimal digits (SHA-256 of its pieces, each with the hash of those before it).
class ContentKey {
 public:
  explicit ContentKey(std::string_view kind) { put(std::string(kind)); }

  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    append(&value, sizeof value);
  }
  void put(double value) {
    value += 0.0;  // -0 is 0
    append(&value, sizeof value);
  }
  void put(const std::string& text) {
    put(static_cast<std::uint64_t>(text.size()));
    append(text.data(), text.size());
  }
  void put(const Vec3& p) { put(p.x), put(p.y), put(p.z); }
  void put(const Affine& map) { put(map.linear[0]), put(map.linear[1]), put(map.linear[2]), put(map.translation); }
  template <class T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    if constexpr (std::is_arithmetic_v<T>)
      append(values.data(), values.size() * sizeof(T));
    else
      for (const auto& v : values) put(v);
  }

  std::string hex() const;

 private:
  void append(const void* bytes, std::size_t count);
  std::string piece_;
};

/// Geometry and topology of a plant, as light and the order of elements ask for them; names, attributes and files do not count.
void put_plant(ContentKey& key, const Plant& plant);
/// Values of optics; names do not count.
void put_optics(ContentKey& key, const Optics& optics);

/// All of a scene but what shines: plants, placements, groups, ground, optics, the period, sensors, and where lamps hang.
/// Same bits of light need the same key; whole scenes have the same light where scene_key() is the same. `geometry`: its geometry_key().
std::string geometry_key(const Scene& scene);
std::string scene_key(const Scene& scene, const std::string& geometry);

}  // namespace sunfleck
