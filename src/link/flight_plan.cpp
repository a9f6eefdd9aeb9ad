#include "link/flight_plan.h"

#include <algorithm>
#include <cmath>

#include "link/angles.h"

namespace eye {
namespace {

constexpr double kStepS = 2;  // between control points: a roll into a turn takes about three of them
constexpr int kDegree = 5;
constexpr int kMarginPoints = 4;   // before the start and after the end, so that the spline is defined there too
constexpr double kSubStepS = 0.1;  // of the integration of legs
constexpr double kGravityMS2 = 9.80665;
constexpr double kWalkMS = 1;

// Uniform B-spline basis by de Boor's recursion; `local` holds kDegree + 1 control points, u in [0, 1].
Vec3d splinePoint(std::vector<Vec3d> local, double u) {
  for (int round = 1; round <= kDegree; ++round)
    for (int i = kDegree; i >= round; --i) {
      const double weight = (u + kDegree - i) / (kDegree + 1 - round);
      const auto at = static_cast<size_t>(i);
      local[at] = local[at - 1] * (1 - weight) + local[at] * weight;
    }
  return local[kDegree];
}

struct Flyer {
  Vec3d enuM{};  // east, north, altitude
  double headingDeg = 0, speedMS = 0, climbMS = 0;

  void advance(double seconds, double accelerationMS2, double turnDegS) {
    // Midpoint values: exact for straight legs, and to millimetres for turns.
    const double headingRad = radFromDeg(headingDeg + turnDegS * seconds / 2);
    const double wayM = (speedMS + accelerationMS2 * seconds / 2) * seconds;
    enuM += Vec3d(std::sin(headingRad) * wayM, std::cos(headingRad) * wayM, climbMS * seconds);
    headingDeg += turnDegS * seconds;
    speedMS += accelerationMS2 * seconds;
  }
};

}  // namespace

Geodetic offsetBy(const Geodetic& origin, double eastM, double northM) {
  const double sinLat = std::sin(radFromDeg(origin.latDeg)), cosLat = std::cos(radFromDeg(origin.latDeg));
  const double e2 = kFlattening * (2 - kFlattening), w2 = 1 - e2 * sinLat * sinLat;
  const double primeVerticalM = kSemiMajorM / std::sqrt(w2), meridianM = primeVerticalM * (1 - e2) / w2;
  return {origin.latDeg + degFromRad(northM / meridianM), origin.lonDeg + degFromRad(eastM / (primeVerticalM * cosLat)),
          origin.altM};
}

FlightPath::FlightPath(const FlightPlan& plan) : origin_(plan.start), originHeadingDeg_(plan.startHeadingDeg) {
  Flyer flyer{{0, 0, plan.start.altM}, plan.startHeadingDeg, plan.startSpeedMS, 0};
  const Vec3d backwards = -Vec3d(std::sin(radFromDeg(flyer.headingDeg)), std::cos(radFromDeg(flyer.headingDeg)), 0.0);
  for (int i = kMarginPoints; i > 0; --i) controlEnuM_.push_back(flyer.enuM + backwards * (flyer.speedMS * kStepS * i));
  controlEnuM_.push_back(flyer.enuM);

  const int subSteps = static_cast<int>(std::lround(kStepS / kSubStepS));
  int sinceControl = 0;
  const auto advance = [&](double acceleration, double turnDegS) {
    flyer.advance(kSubStepS, acceleration, turnDegS);
    if (++sinceControl < subSteps) return;
    sinceControl = 0;
    controlEnuM_.push_back(flyer.enuM);
  };
  for (const Leg& leg : plan.legs) {
    flyer.climbMS = leg.climbMS;
    const double acceleration = (leg.endSpeedMS - flyer.speedMS) / leg.durationS;
    for (long i = 0, count = std::lround(leg.durationS / kSubStepS); i < count; ++i)
      advance(acceleration, leg.turnDegS);
    durationS_ += leg.durationS;
  }
  const size_t wanted = controlEnuM_.size() + kMarginPoints;
  while (controlEnuM_.size() < wanted) advance(0, 0);
}

Geodetic FlightPath::positionAt(double timeS) const {
  // The basis of a segment is centred on the middle of its six control points.
  const double parameter = timeS / kStepS + kMarginPoints - (kDegree - 1) / 2.0;
  const double last = static_cast<double>(controlEnuM_.size()) - kDegree - 1;
  const double segment = std::clamp(std::floor(parameter), 0.0, last);
  const auto first = controlEnuM_.begin() + static_cast<std::ptrdiff_t>(segment);
  const Vec3d enuM = splinePoint({first, first + kDegree + 1}, std::clamp(parameter - segment, 0.0, 1.0));

  Geodetic position = offsetBy(origin_, enuM.x, enuM.y);
  position.altM = enuM.z;
  return position;
}

Pose FlightPath::poseAt(double timeS) const {
  const double clampedS = std::clamp(timeS, 0.0, durationS_);
  return poseAlongPath([this](double t) { return positionAt(t); }, clampedS, originHeadingDeg_);
}

Pose poseAlongPath(const std::function<Geodetic(double)>& positionAt, double timeS, double restingHeadingDeg) {
  // Central differences over this: rounding of ecef (1 nm) stays 1e-8 of the velocity, curvature 1e-5 of a turn.
  constexpr double kDeltaS = 0.05;
  const Geodetic here = positionAt(timeS);
  const Mat3d enuFromEcef = glm::transpose(ecefFromEnu(here.latDeg, here.lonDeg));
  const Vec3d before = enuFromEcef * ecefFromGeodetic(positionAt(timeS - kDeltaS));
  const Vec3d now = enuFromEcef * ecefFromGeodetic(here);
  const Vec3d after = enuFromEcef * ecefFromGeodetic(positionAt(timeS + kDeltaS));
  const Vec3d velocityMS = (after - before) / (2 * kDeltaS);
  const Vec3d accelerationMS2 = (after - 2.0 * now + before) / (kDeltaS * kDeltaS);

  Pose pose;
  pose.position = here;
  const double levelMS = std::hypot(velocityMS.x, velocityMS.y);
  if (levelMS < kWalkMS) {
    pose.headingDeg = wrappedDeg360(restingHeadingDeg);
    return pose;
  }
  pose.headingDeg = wrappedDeg360(degFromRad(std::atan2(velocityMS.x, velocityMS.y)));
  pose.pitchDeg = degFromRad(std::atan2(velocityMS.z, levelMS));
  // Sideways acceleration, positive to the right of the course: east * cos(heading) - north * sin(heading).
  const double rightMS2 = (accelerationMS2.x * velocityMS.y - accelerationMS2.y * velocityMS.x) / levelMS;
  pose.rollDeg = degFromRad(std::atan2(rightMS2, kGravityMS2));
  return pose;
}

}  // namespace eye
