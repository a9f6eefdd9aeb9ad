// The embedded demo: a made-up world around a runway, as rasters in memory for the ordinary bake. Always the
// same, but for the globe beyond it, which is the real one where its relief is installed (demo_relief.h).
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace eye {

struct DemoSources {
  std::vector<std::string> elevation, imagery;  // in order of preference
};
Result<DemoSources> makeDemoSources();

// Metres, of features no shorter than `shortestM`; the sea is 0. On the airfield exactly its elevation.
double demoHeightM(double latDeg, double lonDeg, double shortestM);

}  // namespace eye
