// Photometric files of luminaires (IES LM-63).
#pragma once

#include <string>

#include <sunfleck/light/photometry.hpp>

namespace sunfleck {

/// Reads IES LM-63 of 1986, 1991, 1995, 2002 and 2019, photometry of type C. Candela values, multiplier and ballast factors set the
/// strength of a real lamp, which scenes give per band: only the ratios between directions are used, so a TILT table, which
/// scales all of them alike, is read past. Throws InputError naming file and line.
Photometry read_ies(const std::string& file);

}  // namespace sunfleck
