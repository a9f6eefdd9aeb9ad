// DIS Entity State PDUs (IEEE 1278.1-1995, -1995A and -2012, protocol versions 5 to 7): one entity a PDU, big-endian.
// Layout: docs/PROTOCOLS.md. Pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "geo/frames.h"
#include "link/entity_type.h"

namespace eye {

// Ways to carry an entity on between PDUs: F without, R with rotation; P at constant velocity, V accelerated;
// W in ecef, B in body coordinates. The numbers are those on the wire.
enum class DeadReckoning : uint8_t { other, hold, fpw, rpw, rvw, fvw, fpb, rpb, rvb, fvb };

struct DisEntityState {
  uint8_t version = 7, exercise = 1;
  uint32_t timestamp = 0;                          // see disSecondsPastHour
  uint16_t site = 0, application = 0, entity = 0;  // together the entity's name
  uint8_t force = 0;                               // 1 friendly, 2 opposing, 3 neutral
  EntityType type;
  Pose pose;  // as normaliseAngles leaves it
  // In ecef, but in body coordinates (x forward, y right, z down) with fpb, rpb, rvb and fvb.
  Vec3d velocityMS{}, accelerationMS2{};
  Vec3d turnRateBodyRadS{};
  DeadReckoning deadReckoning = DeadReckoning::hold;
  uint32_t appearance = 0, capabilities = 0;
  std::string marking;  // at most 11 printable ASCII characters
};

inline constexpr size_t kDisEntityStateBytes = 144;  // without variable parameters, which are passed over

// True for an Entity State PDU of one of these versions, whatever else is in it.
bool looksLikeDisEntityState(std::span<const std::byte> datagram);

// The first PDU of the datagram. Rejects other PDUs and versions, lengths that do not fit, NaN and infinities,
// positions out of the ranges of pose_limits.h, and speeds beyond 1e6.
Result<DisEntityState> parseDisEntityState(std::span<const std::byte> datagram);

// Without variable parameters.
std::vector<std::byte> buildDisEntityState(const DisEntityState& state);

// Of a timestamp, 0 to 3600; its lowest bit says whether that is UTC or only the sender's clock.
double disSecondsPastHour(uint32_t timestamp);
bool disIsUtc(uint32_t timestamp);
uint32_t disTimestamp(double secondsPastHour, bool utc);

}  // namespace eye
