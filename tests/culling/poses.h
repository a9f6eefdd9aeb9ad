// Where culling is put to the test: eyes anywhere, and a flight between ridges.
#pragma once

#include <random>

#include "geo/view.h"
#include "terrain/database.h"

namespace eye::test {

class Ground {
 public:
  explicit Ground(const std::string& database);
  // No terrain of the finest tile at the place is higher.
  double highestM(double latDeg, double lonDeg) const;

 private:
  DatabaseReader reader_;
};

struct Eye {
  Pose pose;
  double fovDeg = 60;
  bool isOffAxis = false;
  View view(int widthPx, int heightPx) const;
  std::string text() const;  // as --pose takes it, with the angles
};

// Heights evenly in their logarithm from 30 m above the ground to 62,763 km, most of them low; every attitude, half of
// them towards the ground. `near`: within the bounds, else anywhere, with poles, date line and the parallels
// at which the grid's columns halve more often than by chance.
Eye randomEye(std::mt19937& random, const Ground& ground, const TileBounds* near);
// Another eye at the same place and height: its terrain is there already.
Eye turned(std::mt19937& random, const Eye& eye);

// Frame `number` of a flight through valleys 60 m above their ground, 15 m a frame, in turns of up to 80 degrees of
// bank that reverse every three seconds.
Eye flightEye(int number, const Ground& ground, const TileBounds& bounds);

}  // namespace eye::test
