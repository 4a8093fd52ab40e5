// Scattered light that sampling lost or made, given back or taken.
#pragma once

#include <vector>

#include "line_links.hpp"
#include "lit_elements.hpp"

namespace sunfleck {

/// The first reflection of sun and lamps as lines counted it [columns] [W]: all of it, and what left the scene.
struct FirstReflection {
  std::vector<double> all, escaped;
};

FirstReflection first_reflection(const std::array<HalfLight, 2>& along, double area_of_line, std::size_t columns);

/// Scattered light of a state and band must be absorbed or escape, all of it. Lines sample the area of what scatters, and cells share it
/// out by their true areas, so sums differ by the sampling: both the light gathered and that which escapes are multiplied by one factor,
/// which Balance::scattered_scale keeps. Of the first reflection, lines tell the share that escapes; how much there is, cells tell.
/// `balance` [s][b] holds in `escaped` what escapes after the first reflection, and gets the whole. A factor that is further than 5 % from
/// 1 is not the sampling's doing: it is not applied, and the balance shows what is amiss. Returns the largest |factor - 1|.
double conserve(const LitElements& lit, const FirstReflection& first, ScatteredLight& light, std::vector<std::vector<Balance>>& balance);

}  // namespace sunfleck
