#include "link/dis_motion.h"

#include <algorithm>
#include <cmath>

#include "link/angles.h"
#include "link/eye_chain.h"
#include "link/pose_limits.h"

namespace eye {
namespace {

bool turns(DeadReckoning algorithm) {
  return algorithm == DeadReckoning::rpw || algorithm == DeadReckoning::rvw || algorithm == DeadReckoning::rpb ||
         algorithm == DeadReckoning::rvb;
}
bool accelerates(DeadReckoning algorithm) {
  return algorithm == DeadReckoning::rvw || algorithm == DeadReckoning::fvw || algorithm == DeadReckoning::rvb ||
         algorithm == DeadReckoning::fvb;
}
bool isInBody(DeadReckoning algorithm) {
  return algorithm >= DeadReckoning::fpb;
}

// How far a body goes, in its axes at the beginning: the integral of its velocity in its own turning axes, by Simpson's
// rule. 64 steps of the 12 s that are looked ahead at most: to the millimetre for turns of a fighter.
Vec3d alongInBody(const Vec3d& velocityMS, const Vec3d& accelerationMS2, const Vec3d& turnRateRadS, double seconds) {
  constexpr int kSteps = 64;
  const auto velocityAt = [&](double t) { return rotationBy(turnRateRadS * t) * (velocityMS + accelerationMS2 * t); };
  Vec3d sum = velocityAt(0) + velocityAt(seconds);
  for (int i = 1; i < kSteps; ++i) sum += velocityAt(seconds * i / kSteps) * (i % 2 == 1 ? 4.0 : 2.0);
  return sum * (seconds / kSteps / 3);
}

}  // namespace

Pose deadReckoned(const DisEntityState& state, double seconds) {
  const DeadReckoning algorithm = state.deadReckoning;
  if (algorithm <= DeadReckoning::hold || seconds <= 0) return state.pose;
  const Mat3d attitude = ecefFromBody(state.pose);
  const Vec3d accelerationMS2 = accelerates(algorithm) ? state.accelerationMS2 : Vec3d{};
  const Vec3d turnRateRadS = turns(algorithm) ? state.turnRateBodyRadS : Vec3d{};
  const Vec3d alongEcefM = isInBody(algorithm)
                               ? attitude * alongInBody(state.velocityMS, accelerationMS2, turnRateRadS, seconds)
                               : state.velocityMS * seconds + accelerationMS2 * (seconds * seconds / 2);
  Geodetic position = geodeticFromEcef(ecefFromGeodetic(state.pose.position) + alongEcefM);
  position.altM = std::clamp(position.altM, kMinAltitudeM, kMaxAltitudeM);
  Pose pose = poseFromBody(position, attitude * rotationBy(turnRateRadS * seconds));
  normaliseAngles(pose);
  return pose;
}

}  // namespace eye
