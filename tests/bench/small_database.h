// A database for the benchmark's tests, baked once a process: low swells in the south-west, ridges of 1,000 m in the
// north-east.
#pragma once

#include <string>

#include "terrain/database.h"

namespace eye {

double swellsAndRidgesM(double latDeg, double lonDeg);
const std::string& smallDatabase();

}  // namespace eye
