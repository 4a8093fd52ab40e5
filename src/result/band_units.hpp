// Units of values per band.
#pragma once

#include <string>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck::h5 {

/// "W m^-2", or "umol m^-2 s^-1" where the bands count photons; where they differ, one a band, in their order: "W m^-2, umol m^-2 s^-1".
std::string irradiance_unit(const Scene& scene);
/// The same without the area: "W" or "umol s^-1".
std::string power_unit(const Scene& scene);
/// Of variances: "W^2 m^-4".
std::string squared(const std::string& unit);

}  // namespace sunfleck::h5
