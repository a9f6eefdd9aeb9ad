// Ground colour where there is no imagery: from elevation, slope and latitude. docs/BAKING.md describes it.
#pragma once

#include <glm/glm.hpp>

namespace eye {

struct GroundSample {
  double heightM = 0;
  double slope = 0;      // rise over run
  double curvature = 0;  // height above the mean of the neighbours over their distance; positive on ridges
  double latDeg = 0;
  float broadNoise = 0;  // -1..1, kilometres: moves the borders between kinds of ground
  float grainNoise = 0;  // -1..1, tens of metres: brightness
};

// sRGB, 0..1.
glm::vec3 groundColour(const GroundSample& ground);

// Metres above sea level where forest ends and where snow lies all year, by latitude.
double treelineM(double latDeg);
double snowlineM(double latDeg);

}  // namespace eye
