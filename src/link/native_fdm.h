// FlightGear's "native-fdm" packets (FGNetFDM): one aircraft state a datagram, big-endian, without a sequence number.
// Layout: docs/PROTOCOLS.md. Pure functions: bytes in, a state or the reason against it out.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "geo/pose.h"
#include "link/datagram_shape.h"

namespace eye {

inline constexpr size_t kNativeFdmBytesV24 = 408;  // FlightGear to 2020.3, JSBSim
inline constexpr size_t kNativeFdmBytesV25 =
    552;  // FlightGear since; what is read here lies where it did, but visibility

struct NativeFdmState {
  Pose pose;                          // in the ranges of normaliseAngles; longitude in [-180, 180]
  std::optional<double> visibilityM;  // absent when the packet's is nonsense (many hosts leave it 0)
  uint32_t clockTicks = 0;            // cur_time: of a unit, if it runs at all, that only the host knows
};

// True when version and length are those of a native-fdm packet, whatever else is in it.
bool looksLikeNativeFdm(std::span<const std::byte> packet);

// What parseNativeFdm() believes has one of these.
std::span<const DatagramShape> nativeFdmShapes();

// Rejects another version or length, NaN, infinities, latitudes beyond 90 degrees, longitudes beyond 360, altitudes
// outside -1,000 m to 1e8 m.
Result<NativeFdmState> parseNativeFdm(std::span<const std::byte> packet);

// A version 24 packet with position, attitude, visibility and clock; every other field is 0.
std::vector<std::byte> buildNativeFdm(const NativeFdmState& state);

}  // namespace eye
