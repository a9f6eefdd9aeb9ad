// Whether a summit shows from an eye, whatever the picture: in double precision on the finest meshes.
#pragma once

#include "geo/scene_bend.h"
#include "paging/ground_query.h"

namespace eye {

// How much nearer than a summit its own slope may be met and still stand for it, metres: two posts of 3 arc-seconds, or
// a fiftieth of the way up to a kilometre, which is what lies under a far pixel.
double ownSlopeM(double distanceM);

// Whether the top shows by more than `underRad` of angle: the bent line of sight so far under it meets nothing before
// the top's own slope. That is ground within ownSlopeM of the top from which the line stays inside the mountain: where
// it comes out again there is a gap, and what it met is another ridge.
Result<bool> isInSight(GroundQuery& ground, const Geodetic& eye, const Geodetic& top, const SceneBend& bend,
                       double underRad);

}  // namespace eye
