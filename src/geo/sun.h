// Where the sun stands, for lighting. Good to 0.01 degrees between 1900 and 2100.
#pragma once

#include "geo/frames.h"

namespace eye {

// Days since noon of 1 January 4713 BC, of a date of the Gregorian calendar; `day` may have a fraction (UTC).
double julianDay(int year, int month, double day);

// Unit vector from the Earth towards the sun, ecef.
Vec3d sunDirectionEcef(double julianDayUtc);

// The moment at which a sundial at `lonDeg` shows `hours` (0..24, 12 = the sun in the meridian) on the given local
// date. The default date is a spring equinox: up at 6, down at 18, at every latitude.
double julianDayFromLocalSolarTime(double hours, double lonDeg, int year = 2024, int month = 3, double day = 20);

}  // namespace eye
