// Times as scene files write them.
#pragma once

#include <string>

namespace sunfleck {

/// A moment and the calendar day of the place.
struct Moment {
  double julian_date = 0;  ///< days of UTC since noon of 1 January 4713 BC (proleptic Julian calendar)
  int day_of_year = 1;     ///< of the date as written, in its own zone; 1 = 1 January
};

/// Parses ISO 8601 "YYYY-MM-DDThh:mm[:ss[.fraction]]ZONE" with ZONE "Z" or "+hh:mm" or "-hh:mm" (Gregorian calendar). The zone is not
/// optional: a time without it could be hours off. Throws InputError(where ...) otherwise, and for dates that do not exist.
Moment parse_time(const std::string& iso_time, const std::string& where);

}  // namespace sunfleck
