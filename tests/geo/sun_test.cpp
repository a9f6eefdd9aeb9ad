#include "geo/sun.h"

#include <cmath>

#include <catch2/catch.hpp>

namespace eye {
namespace {

double declinationDeg(const Vec3d& direction) {
  return degFromRad(std::asin(direction.z));
}
double overLonDeg(const Vec3d& direction) {
  return degFromRad(std::atan2(direction.y, direction.x));
}

// Sundial minus clock, minutes, at Greenwich noon.
double equationOfTimeMinutes(int year, int month, double day) {
  return -overLonDeg(sunDirectionEcef(julianDay(year, month, day + 0.5))) * 4.0;
}

double dialHours(double julianDayUtc, double lonDeg) {
  const double hours = 12.0 + (lonDeg - overLonDeg(sunDirectionEcef(julianDayUtc))) / 15.0;
  return hours - 24.0 * std::floor(hours / 24.0);
}

TEST_CASE("Julian days are Meeus's examples") {
  CHECK(julianDay(1957, 10, 4.81) == Approx(2436116.31).epsilon(1e-12));  // Sputnik, example 7.a
  CHECK(julianDay(2000, 1, 1.5) == 2451545.0);
  CHECK(julianDay(1999, 1, 1.0) == 2451179.5);
  CHECK(julianDay(1988, 6, 19.5) == 2447332.0);
  CHECK(julianDay(1900, 1, 1.0) == 2415020.5);
  CHECK(julianDay(2024, 3, 1) - julianDay(2024, 2, 28) == 2.0);
}

TEST_CASE("the sun is where Meeus's worked example has it") {
  // Examples 25.a and 28.b: 1992 October 13, 0 h: declination -7.78507 degrees, equation of time +3.427351 degrees.
  const Vec3d sun = sunDirectionEcef(2448908.5);
  CHECK(glm::length(sun) == Approx(1.0));
  CHECK(declinationDeg(sun) == Approx(-7.78507).margin(0.005));
  CHECK(overLonDeg(sun) == Approx(180.0 - 3.427351).margin(0.005));
}

TEST_CASE("solstices and equinoxes have their declinations") {
  // Times of the almanac for the year 2000 (US Naval Observatory).
  const double dayHours = 24.0;
  CHECK(declinationDeg(sunDirectionEcef(julianDay(2000, 3, 20 + 7.58 / dayHours))) == Approx(0).margin(0.01));
  CHECK(declinationDeg(sunDirectionEcef(julianDay(2000, 6, 21 + 1.80 / dayHours))) == Approx(23.44).margin(0.01));
  CHECK(declinationDeg(sunDirectionEcef(julianDay(2000, 9, 22 + 17.46 / dayHours))) == Approx(0).margin(0.01));
  CHECK(declinationDeg(sunDirectionEcef(julianDay(2000, 12, 21 + 13.62 / dayHours))) == Approx(-23.44).margin(0.01));
}

TEST_CASE("the equation of time has its four extremes") {
  CHECK(equationOfTimeMinutes(2000, 2, 11) == Approx(-14.25).margin(0.1));
  CHECK(equationOfTimeMinutes(2000, 5, 14) == Approx(3.68).margin(0.1));
  CHECK(equationOfTimeMinutes(2000, 7, 26) == Approx(-6.54).margin(0.1));
  CHECK(equationOfTimeMinutes(2000, 11, 3) == Approx(16.42).margin(0.1));
}

TEST_CASE("at a local solar time the sun has that hour angle") {
  for (const double lon : {-180.0, -179.0, -74.0, 0.0, 20.1, 179.9})
    for (const double hours : {0.0, 3.25, 6.0, 12.0, 18.0, 23.99, 24.0})
      for (const int month : {2, 3, 11}) {
        CAPTURE(lon, hours, month);
        const double jd = julianDayFromLocalSolarTime(hours, lon, {2024, month, 11});
        const double second = 1.0 / 3600;
        CHECK(std::abs(std::remainder(dialHours(jd, lon) - hours, 24.0)) < second);
        // The date is the local one.
        CHECK(std::abs(jd - julianDay(2024, month, 11) - (hours - lon / 15) / 24) < 17.0 / 1440);
      }
}

TEST_CASE("on the default date the sun rises at 6 in the east and stands over the equator at noon") {
  const double lat = 49.2, lon = 20.1;
  const Mat3d enu = glm::transpose(ecefFromEnu(lat, lon));
  const Vec3d rise = enu * sunDirectionEcef(julianDayFromLocalSolarTime(6, lon));
  CHECK(rise.x > 0.999);
  CHECK(std::abs(rise.z) < 0.01);
  const Vec3d noon = enu * sunDirectionEcef(julianDayFromLocalSolarTime(12, lon));
  CHECK(noon.y < 0);  // in the south
  CHECK(std::abs(noon.x) < 1e-4);
  CHECK(degFromRad(std::asin(noon.z)) == Approx(90 - lat).margin(0.3));
  CHECK((enu * sunDirectionEcef(julianDayFromLocalSolarTime(18, lon))).x < -0.999);
  CHECK((enu * sunDirectionEcef(julianDayFromLocalSolarTime(0, lon))).z < -0.6);
}

}  // namespace
}  // namespace eye
