// Flights made of legs, as a pilot would brief them, turned into a path that is smooth in position and attitude.
#pragma once

#include <functional>
#include <vector>

#include "geo/frames.h"
#include "geo/pose.h"

namespace eye {

// Metres turned into degrees with the curvature at the origin: a smooth map, true to a hundredth over tens of
// kilometres. Not for the neighbourhood of a pole.
Geodetic offsetBy(const Geodetic& origin, double eastM, double northM);

// One leg: within it speed changes evenly, turn and climb rates hold. The path rounds off what jumps between legs.
struct Leg {
  double durationS = 0;
  double endSpeedMS = 0;  // over ground
  double turnDegS = 0;    // clockwise
  double climbMS = 0;
};

struct FlightPlan {
  Geodetic start;
  double startHeadingDeg = 0;
  double startSpeedMS = 0;
  std::vector<Leg> legs;
};

// A quintic B-spline through local metres around the start: positions with four continuous derivatives.
class FlightPath {
 public:
  explicit FlightPath(const FlightPlan& plan);
  double durationS() const { return durationS_; }
  // Any time; before the start and after the end the path goes on along its tangent for a few seconds.
  Geodetic positionAt(double timeS) const;
  // Clamped to the duration. Looks where it flies; banks as a coordinated turn needs.
  Pose poseAt(double timeS) const;

 private:
  Geodetic origin_;
  double originHeadingDeg_ = 0;
  double durationS_ = 0;
  std::vector<Vec3d> controlEnuM_;  // east, north, altitude; one every kStepS, with margins at both ends
};

// The pose of a body that moves along `positionAt` (seconds to position, smooth), nose along the path, in coordinated
// flight. Slower than a walk it keeps `restingHeadingDeg` and is level.
Pose poseAlongPath(const std::function<Geodetic(double)>& positionAt, double timeS, double restingHeadingDeg);

}  // namespace eye
