#include "link/eye_chain.h"

#include <algorithm>
#include <cmath>

#include "link/angles.h"
#include "link/pose_limits.h"

namespace eye {
namespace {

// Along the ground and then by the height, so that level flight stays level however far it goes.
Geodetic movedBy(const Geodetic& from, const Vec3d& nedM) {
  const Vec3d level = ecefFromNed(from.latDeg, from.lonDeg) * Vec3d(nedM.x, nedM.y, 0);
  Geodetic to = geodeticFromEcef(ecefFromGeodetic(from) + level);
  to.altM = std::clamp(from.altM - nedM.z, kMinAltitudeM, kMaxAltitudeM);
  return to;
}

ChainLink atMoment(const ChainLink& link, int64_t nowNs) {
  if (!link.carriedOn || !link.motion.any()) return link;
  const int64_t sinceNs = nowNs - link.atNs;
  return sinceNs > 0 ? carriedOn(link, static_cast<double>(sinceNs) * 1e-9) : link;
}

}  // namespace

// Rodrigues.
Mat3d rotationBy(const Vec3d& turnRad) {
  const double angle = glm::length(turnRad);
  if (angle == 0) return Mat3d(1.0);
  const Vec3d axis = turnRad / angle;
  const double s = std::sin(angle), c = std::cos(angle);
  const Mat3d cross(0, axis.z, -axis.y, -axis.z, 0, axis.x, axis.y, -axis.x, 0);
  return Mat3d(c) + s * cross + (1 - c) * glm::outerProduct(axis, axis);
}

bool Motion::any() const {
  const Vec3d zero{};
  return velocityMS != zero || accelerationMS2 != zero || turnRateRadS != zero || turnAccelerationRadS2 != zero;
}

bool EyeChain::add(const ChainLink& link) {
  if (count == links.size()) return false;
  links[count++] = link;
  return true;
}

Mat3d parentFromBody(double yawDeg, double pitchDeg, double rollDeg) {
  const double y = radFromDeg(yawDeg), p = radFromDeg(pitchDeg), r = radFromDeg(rollDeg);
  const double cy = std::cos(y), sy = std::sin(y), cp = std::cos(p), sp = std::sin(p), cr = std::cos(r),
               sr = std::sin(r);
  // Columns: Rz(yaw) Ry(pitch) Rx(roll), with z down.
  return Mat3d(Vec3d(cy * cp, sy * cp, -sp), Vec3d(cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr),
               Vec3d(cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr));
}

Mat3d ecefFromNed(double latDeg, double lonDeg) {
  const Mat3d enu = ecefFromEnu(latDeg, lonDeg);
  return Mat3d(enu[1], enu[0], -enu[2]);
}

ChainLink carriedOn(const ChainLink& link, double seconds) {
  ChainLink moved = link;
  Motion& motion = moved.motion;
  moved.atNs += static_cast<int64_t>(seconds * 1e9);
  const Mat3d attitude = parentFromBody(link.yawDeg, link.pitchDeg, link.rollDeg);
  const auto inParent = [&](bool inBody, const Vec3d& v) { return inBody ? attitude * v : v; };
  const Vec3d alongM = inParent(motion.velocityInBody, motion.velocityMS) * seconds +
                       inParent(motion.accelerationInBody, motion.accelerationMS2) * (seconds * seconds / 2);
  if (const auto* place = std::get_if<Geodetic>(&link.position))
    moved.position = movedBy(*place, alongM);
  else
    moved.position = std::get<Vec3d>(link.position) + alongM;

  const Vec3d turnRad = motion.turnRateRadS * seconds + motion.turnAccelerationRadS2 * (seconds * seconds / 2);
  if (turnRad != Vec3d{}) {
    const Mat3d turned = motion.velocityInBody ? attitude * rotationBy(turnRad) : rotationBy(turnRad) * attitude;
    moved.yawDeg = degFromRad(std::atan2(turned[0].y, turned[0].x));
    moved.pitchDeg = degFromRad(std::asin(std::clamp(-turned[0].z, -1.0, 1.0)));
    moved.rollDeg = degFromRad(std::atan2(turned[1].z, turned[2].z));
  }
  // An acceleration of the other frame than the velocity's is turned into it.
  Vec3d gainedMS = motion.accelerationMS2 * seconds;
  if (motion.accelerationInBody && !motion.velocityInBody) gainedMS = attitude * gainedMS;
  if (!motion.accelerationInBody && motion.velocityInBody) gainedMS = glm::transpose(attitude) * gainedMS;
  motion.velocityMS += gainedMS;
  motion.turnRateRadS += motion.turnAccelerationRadS2 * seconds;
  return moved;
}

std::optional<Placed> placeOf(const EyeChain& chain, int64_t nowNs) {
  if (chain.count == 0) return std::nullopt;
  const ChainLink root = atMoment(chain.links[0], nowNs);
  const auto* place = std::get_if<Geodetic>(&root.position);
  if (place == nullptr) return std::nullopt;
  Placed placed{ecefFromGeodetic(*place),
                ecefFromNed(place->latDeg, place->lonDeg) * parentFromBody(root.yawDeg, root.pitchDeg, root.rollDeg)};
  for (size_t i = 1; i < chain.count; ++i) {
    const ChainLink link = atMoment(chain.links[i], nowNs);
    const auto* offsetM = std::get_if<Vec3d>(&link.position);
    if (offsetM == nullptr) return std::nullopt;
    placed.ecefM += placed.ecefFromBody * *offsetM;
    placed.ecefFromBody = placed.ecefFromBody * parentFromBody(link.yawDeg, link.pitchDeg, link.rollDeg);
  }
  return placed;
}

bool isCarriedOn(const EyeChain& chain) {
  const auto end = chain.links.begin() + static_cast<std::ptrdiff_t>(chain.count);
  return std::any_of(chain.links.begin(), end,
                     [](const ChainLink& link) { return link.carriedOn && link.motion.any(); });
}

std::optional<Pose> poseOf(const EyeChain& chain, int64_t nowNs) {
  if (chain.count == 1) {
    const ChainLink root = atMoment(chain.links[0], nowNs);
    const auto* place = std::get_if<Geodetic>(&root.position);
    if (place == nullptr) return std::nullopt;
    Pose pose{*place, root.yawDeg, root.pitchDeg, root.rollDeg};
    normaliseAngles(pose);
    return pose;
  }
  const auto placed = placeOf(chain, nowNs);
  if (!placed) return std::nullopt;
  // Offsets may lead out of the altitudes that are believed, below the ground for one: held at their edge.
  Geodetic position = geodeticFromEcef(placed->ecefM);
  position.altM = std::clamp(position.altM, kMinAltitudeM, kMaxAltitudeM);
  Pose pose = poseFromBody(position, placed->ecefFromBody);
  normaliseAngles(pose);
  return pose;
}

}  // namespace eye
