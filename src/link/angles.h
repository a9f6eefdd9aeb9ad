// Angles brought into the ranges that every pose in the program has.
#pragma once

#include "geo/frames.h"

namespace eye {

// Into [-180, 180). A value already in range comes back bit for bit.
double wrappedDeg180(double deg);
// Into [0, 360). A value already in range comes back bit for bit.
double wrappedDeg360(double deg);

// The same rotation with heading in [0, 360), pitch in [-90, 90] and roll in [-180, 180): a pitch beyond the vertical,
// as after half a looping, becomes its twin with heading and roll turned by 180 degrees. The angles must be finite.
void normaliseAngles(Pose& pose);

// Body (x forward, y right, z down) to ecef.
Mat3d ecefFromBody(const Pose& pose);
// The inverse: heading, pitch and roll of a body at `position`. With the nose vertical, roll is 0.
Pose poseFromBody(const Geodetic& position, const Mat3d& ecefFromBody);

}  // namespace eye
