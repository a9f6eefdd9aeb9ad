// After Jean Meeus, Astronomical Algorithms, 2nd edition, chapters 7 (Julian day), 12 (sidereal time) and 25 (the sun's
// position, low accuracy). UTC stands for terrestrial time, 70 s ahead: in that time the sun moves 0.001 degrees.
#include "geo/sun.h"

#include <cmath>

namespace eye {
namespace {

constexpr double kJ2000 = 2451545.0;
constexpr double kDaysInCentury = 36525.0;

double sinDeg(double deg) {
  return std::sin(radFromDeg(deg));
}
double cosDeg(double deg) {
  return std::cos(radFromDeg(deg));
}

struct EquatorialDeg {
  double rightAscension, declination;
};

// The moon's ascending node, degrees: what nutation depends on.
double lunarNodeDeg(double centuries) {
  return 125.04 - 1934.136 * centuries;
}

double obliquityDeg(double centuries) {
  return 23.4392911 - 0.0130042 * centuries + 0.00256 * cosDeg(lunarNodeDeg(centuries));
}

EquatorialDeg apparentSun(double centuries) {
  const double t = centuries;
  const double meanLongitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
  const double meanAnomaly = 357.52911 + t * (35999.05029 - t * 0.0001537);
  const double centre = (1.914602 - t * (0.004817 + t * 0.000014)) * sinDeg(meanAnomaly) +
                        (0.019993 - t * 0.000101) * sinDeg(2.0 * meanAnomaly) + 0.000289 * sinDeg(3.0 * meanAnomaly);
  const double aberrationAndNutation = -0.00569 - 0.00478 * sinDeg(lunarNodeDeg(t));
  const double longitude = meanLongitude + centre + aberrationAndNutation;
  const double obliquity = obliquityDeg(t);
  return EquatorialDeg{
      degFromRad(std::atan2(cosDeg(obliquity) * sinDeg(longitude), cosDeg(longitude))),
      degFromRad(std::asin(sinDeg(obliquity) * sinDeg(longitude))),
  };
}

double apparentSiderealDeg(double julianDayUtc) {
  const double days = julianDayUtc - kJ2000, t = days / kDaysInCentury;
  const double nutation = -0.00478 * sinDeg(lunarNodeDeg(t)) * cosDeg(obliquityDeg(t));
  return 280.46061837 + 360.98564736629 * days + 0.000387933 * t * t + nutation;
}

}  // namespace

double julianDay(int year, int month, double day) {
  // January and February count as months 13 and 14 of the year before, so that a leap day is a year's last.
  const int y = month <= 2 ? year - 1 : year, m = month <= 2 ? month + 12 : month;
  const int century = y / 100, gregorian = 2 - century + century / 4;
  return std::floor(365.25 * (y + 4716)) + std::floor(30.6001 * (m + 1)) + day + gregorian - 1524.5;
}

Vec3d sunDirectionEcef(double julianDayUtc) {
  const EquatorialDeg sun = apparentSun((julianDayUtc - kJ2000) / kDaysInCentury);
  const double lonDeg = sun.rightAscension - apparentSiderealDeg(julianDayUtc);
  return Vec3d(cosDeg(sun.declination) * cosDeg(lonDeg), cosDeg(sun.declination) * sinDeg(lonDeg),
               sinDeg(sun.declination));
}

double siderealRad(double julianDayUtc) {
  return radFromDeg(std::remainder(apparentSiderealDeg(julianDayUtc), 360.0));
}

double julianDayFromLocalSolarTime(double hours, double lonDeg, const CalendarDate& date) {
  // Mean solar time first, which a sundial is up to 17 minutes off; then the sun itself says by how much. The equation
  // of time changes by 30 s a day at most, so one correction leaves less than a second.
  const double meanJd = julianDay(date.year, date.month, date.day) + (hours - lonDeg / 15.0) / 24.0;
  const Vec3d sun = sunDirectionEcef(meanJd);
  const double dialHours = 12.0 + (lonDeg - degFromRad(std::atan2(sun.y, sun.x))) / 15.0;
  return meanJd + std::remainder(hours - dialHours, 24.0) / 24.0;
}

}  // namespace eye
