// The sun as a disc, and its position from time and place.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// The sun's beam. Absent where it is below the horizon.
struct Sun {
  Vec3 direction{0, 0, 1};             ///< unit vector towards the centre of the disc, z up, x east, y north
  std::vector<double> irradiance;      ///< per band, on a plane that faces the sun [W m^-2]
  double angular_diameter_deg = 0.53;  ///< 0 = a point
};

/// Unit vectors towards points of the disc that each stand for the same solid angle: a sunflower spiral (Vogel 1979,
/// doi:10.1016/0025-5564(79)90080-4), turned by an angle that depends on the seed.
std::vector<Vec3> sun_disc(const Sun& sun, std::uint32_t points, std::uint64_t seed);

/// Points of the disc that a shadow needs: `fewest` x (1 + w), where w is the width of the penumbra over that of a leaf, for a ray that
/// goes on for `way` [m] behind what it grazes, among leaves of `leaf_area` [m^2]. Where leaves are narrower than their penumbrae, each
/// point of the disc casts a shadow pattern of its own, and few points are few samples of it.
std::uint32_t sun_disc_points(const Sun& sun, std::uint32_t fewest, double way, double leaf_area);

/// Unit vector towards the sun from its elevation above the horizon and its azimuth from north over east [degrees].
Vec3 direction_from_angles(double elevation_deg, double azimuth_deg);

struct SolarPosition {
  double elevation_deg;  ///< topocentric, without refraction
  double azimuth_deg;    ///< from north over east
};

/// Position of the sun for an ISO 8601 time with zone ("2026-06-21T09:00:00+02:00", "…Z", see time.hpp) at a place on Earth;
/// latitude north and longitude east positive [degrees]. The algorithm of NREL's SPA (Reda & Andreas 2004,
/// doi:10.1016/j.solener.2003.12.003), from which we leave out terms below a fifth of an arc second and refraction, and take the
/// time between UTC and dynamical time from one parabola: better than 0.005 degrees from 1800 to 2200 (of which .004 is that UTC
/// may be .9 s from the Earth's rotation). Throws InputError(where ...) for a malformed time or a place that does not exist.
SolarPosition solar_position(const std::string& iso_time, double latitude_deg, double longitude_deg, double altitude_m,
                             const std::string& where);

}  // namespace sunfleck
