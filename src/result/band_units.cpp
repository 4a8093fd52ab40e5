#include "result/band_units.hpp"

#include <algorithm>
#include <sstream>

namespace sunfleck::h5 {

namespace {

constexpr const char* watts = "W m^-2";

/// Units of the bands after `change`, as one where they are alike.
template <class Change>
std::string units_of(const Scene& scene, Change&& change) {
  auto units = scene.band_units;
  units.resize(scene.band_count(), watts);
  std::string text;
  for (const auto& unit : units) text += (text.empty() ? "" : ", ") + change(unit);
  const bool alike = std::all_of(units.begin(), units.end(), [&](const std::string& unit) { return unit == units.front(); });
  return alike && !units.empty() ? change(units.front()) : text;
}

}  // namespace

std::string irradiance_unit(const Scene& scene) {
  return units_of(scene, [](const std::string& unit) { return unit; });
}

std::string power_unit(const Scene& scene) {
  return units_of(scene, [](std::string unit) {
    if (const auto area = unit.find(" m^-2"); area != std::string::npos) unit.erase(area, 5);
    return unit;
  });
}

std::string squared(const std::string& unit) {
  std::istringstream words(unit);
  std::string text;
  for (std::string word; words >> word;) {
    const bool comma = word.back() == ',';
    if (comma) word.pop_back();
    const auto power = word.find('^');
    const int exponent = power == std::string::npos ? 1 : std::stoi(word.substr(power + 1));
    text += (text.empty() ? "" : " ") + word.substr(0, power) + "^" + std::to_string(2 * exponent) + (comma ? "," : "");
  }
  return text;
}

}  // namespace sunfleck::h5
