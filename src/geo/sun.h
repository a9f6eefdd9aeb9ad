// Where the sun stands, for lighting. Good to 0.01 degrees between 1900 and 2100.
#pragma once

#include "geo/frames.h"

namespace eye {

struct CalendarDate {  // Gregorian
  int year, month, day;
};
// A spring equinox: the sun is up at 6 and down at 18, at every latitude.
inline constexpr CalendarDate kDefaultDate{2026, 3, 20};

// Days since noon of 1 January 4713 BC, of a date of the Gregorian calendar; `day` may have a fraction (UTC).
double julianDay(int year, int month, double day);

// Unit vector from the Earth towards the sun, ecef.
Vec3d sunDirectionEcef(double julianDayUtc);

// How far the Earth has turned under the stars: the right ascension over the zero meridian, radians.
double siderealRad(double julianDayUtc);

// The moment at which a sundial at `lonDeg` shows `hours` (0..24, 12 = the sun in the meridian) on the given local
// date.
double julianDayFromLocalSolarTime(double hours, double lonDeg, const CalendarDate& date = kDefaultDate);

}  // namespace eye
