// How many tiles a bake will make, before it knows which of them are flat.
#pragma once

#include <vector>

#include "bake/bake_plan.h"

namespace eye {

// Tiles by level if every tile is refined as far as its sources go; large levels are sampled.
std::vector<double> mostTiles(const BakePlan& plan);

}  // namespace eye
