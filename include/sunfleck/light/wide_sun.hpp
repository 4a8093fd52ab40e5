// Discs of the sun that are wide.
#pragma once

namespace sunfleck {

/// Wider discs light both sides of many surfaces, and their parts are weighted by cosines of their own [degrees]: methods `flat`,
/// `clustering`, `direct` and `reference` know them.
inline constexpr double widest_narrow_sun_deg = 5.0;

}  // namespace sunfleck
