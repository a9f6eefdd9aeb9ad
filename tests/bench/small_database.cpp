#include "bench/small_database.h"

#include <catch2/catch.hpp>

#include "bake/baked_ground.h"

namespace eye {

double swellsAndRidgesM(double latDeg, double lonDeg) {
  const double rough = latDeg > 49.3 && lonDeg > 20.3 ? 1 : 0;
  return 300 + 8 * std::sin(latDeg * 61) * std::cos(lonDeg * 47) +
         rough * 500 * (1 + std::sin(latDeg * 200) * std::cos(lonDeg * 150));
}

const std::string& smallDatabase() {
  static const BakedGround ground(postGrid(49, 20, 1.0 / 200, 121, 121), swellsAndRidgesM, 4);
  return ground.database;
}

}  // namespace eye
