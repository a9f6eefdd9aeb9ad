// From the ground to the eye: an entity, those that it is attached to, and the eye point in it, each with its motion.
// A value that goes through the mailbox whole; positions are composed in double when a frame asks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "geo/frames.h"

namespace eye {

// What carries a link on between packets. Frames: north, east, down for the first link, else the parent's body.
struct Motion {
  Vec3d velocityMS{}, accelerationMS2{};
  Vec3d turnRateRadS{}, turnAccelerationRadS2{};  // about the axes x, y, z
  bool velocityInBody = false, accelerationInBody = false;
  bool any() const;
};

// The alternatives are trivially copyable: their variant's assignment does not throw, which clang-tidy 14 cannot see.
struct ChainLink {                         // NOLINT(bugprone-exception-escape)
  std::variant<Geodetic, Vec3d> position;  // of the first link geodetic, of the others metres in the parent's body
  double yawDeg = 0, pitchDeg = 0, rollDeg = 0;
  Motion motion;
  int64_t atNs = 0;        // the moment that position and angles are of
  bool carriedOn = false;  // moves on from that moment
};

inline constexpr size_t kMaxChain = 16;
struct EyeChain {
  std::array<ChainLink, kMaxChain> links;
  size_t count = 0;                 // 0: not known where the eye is
  bool add(const ChainLink& link);  // false when it is full
};

// Columns are the axes of a body (forward, right, down) in its parent, of the same kind.
Mat3d parentFromBody(double yawDeg, double pitchDeg, double rollDeg);
// The rotation by a vector's length about its direction.
Mat3d rotationBy(const Vec3d& turnRad);
// North, east, down to ecef.
Mat3d ecefFromNed(double latDeg, double lonDeg);

// The link at another moment, its motion with it.
ChainLink carriedOn(const ChainLink& link, double seconds);

struct Placed {
  Vec3d ecefM{};
  Mat3d ecefFromBody{1.0};
};
// Where the chain's last body is. `nowNs`: a clock with that of the links.
std::optional<Placed> placeOf(const EyeChain& chain, int64_t nowNs);
// Something in it moves on by itself.
bool isCarriedOn(const EyeChain& chain);
// The same as a pose. A chain of one link at its own moment comes back as it was given.
std::optional<Pose> poseOf(const EyeChain& chain, int64_t nowNs);

}  // namespace eye
