// X-Plane's RPOS over UDP: a host asks for it at a rate, and gets the aircraft's state in doubles. Little-endian.
// Layout: docs/PROTOCOLS.md. Pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/error.h"
#include "geo/frames.h"
#include "link/datagram_shape.h"

namespace eye {

struct RposState {
  Pose pose;  // altitude above mean sea level, as X-Plane has it; angles as normaliseAngles leaves them
  double aglM = 0;
  Vec3d velocityEnuMS{};
  double rollRateRadS = 0, pitchRateRadS = 0, yawRateRadS = 0;  // P, Q, R: about the body's axes
};

inline constexpr size_t kRposBytes = 69;
inline constexpr int kMaxRposRateHz = 99;       // X-Plane cannot be faster than its frames
inline constexpr uint16_t kXplanePort = 49000;  // where X-Plane listens

// "Send me RPOS so many times a second", 0: no more. The rate is brought within 0 to kMaxRposRateHz.
std::vector<std::byte> buildRposRequest(int rateHz);

// True for a datagram of the right length and name.
bool looksLikeRpos(std::span<const std::byte> datagram);

// What parseRpos() believes has one of these.
std::span<const DatagramShape> rposShapes();

// Rejects another length or name, NaN and infinities, and positions out of the ranges of pose_limits.h.
Result<RposState> parseRpos(std::span<const std::byte> datagram);

// As X-Plane answers.
std::vector<std::byte> buildRpos(const RposState& state);

}  // namespace eye
