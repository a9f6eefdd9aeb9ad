// The ids and sizes of the packets that are understood, in 3.x and in 4.0.
#pragma once

#include "link/cigi_fields.h"

namespace eye::cigi {

// The headers of 3.0 and 3.1 are shorter: they end before the frame of the other side.
inline constexpr uint8_t kOldHeaderBytes = 16;

struct Shape {
  uint8_t id3 = 0, bytes3 = 0;
  uint16_t id4 = 0;
  uint8_t bytes4 = 0;
  const char* name3 = nullptr;
  const char* name4 = name3;

  constexpr const char* name(Version version) const { return version.major == 3 ? name3 : name4; }
  constexpr uint16_t id(Version version) const { return version.major == 3 ? id3 : id4; }
  constexpr bool isHeader() const { return id4 == 0x0000 || id4 == 0xffff; }
  constexpr size_t bytes(Version version) const {
    if (isHeader() && !isSince(version, 2)) return kOldHeaderBytes;
    return version.major == 3 ? bytes3 : bytes4;
  }
};

// Sources for 3.x: Boeing's ICD 3.3 as Wireshark's packet-cigi.c reads it, and sessions of the CIGI Class Library
// (CCL). Sources for 4.0: CCL 4.0.2's Pack functions and a session of it; for Acceleration Control, which that session
// lacks, CCL's CigiAccelerationCtrlV4, and Boeing's Host Emulator, whose structs for 4.0 agree with all of these.
template <class T>
inline constexpr Shape kShape{};

template <>
inline constexpr Shape kShape<IgControl>{1, 24, 0x0000, 24, "IG Control"};
template <>
inline constexpr Shape kShape<EntityTraits>{2, 48, 0x0025, 16, "Entity Control"};
template <>
inline constexpr Shape kShape<EntityPlace>{2, 48, 0x0001, 48, "Entity Control", "Entity Position"};
template <>
inline constexpr Shape kShape<ViewControl>{16, 32, 0x000f, 40, "View Control"};
template <>
inline constexpr Shape kShape<ViewDefinition>{21, 32, 0x0014, 40, "View Definition"};
template <>
inline constexpr Shape kShape<Velocity>{8, 32, 0x0007, 32, "Rate Control", "Velocity Control"};
template <>
inline constexpr Shape kShape<Acceleration>{20, 24, 0x0013, 32, "Trajectory Definition", "Acceleration Control"};
template <>
inline constexpr Shape kShape<CelestialSphere>{9, 16, 0x0008, 24, "Celestial Sphere Control"};
template <>
inline constexpr Shape kShape<Atmosphere>{10, 32, 0x0009, 32, "Atmosphere Control"};
template <>
inline constexpr Shape kShape<Weather>{12, 56, 0x000b, 72, "Weather Control"};
template <>
inline constexpr Shape kShape<HeightRequest>{24, 32, 0x0017, 40, "HAT/HOT Request"};
template <>
inline constexpr Shape kShape<SightSegmentRequest>{25, 64, 0x0018, 72, "Line of Sight Segment Request"};
template <>
inline constexpr Shape kShape<SightVectorRequest>{26, 56, 0x0019, 64, "Line of Sight Vector Request"};
template <>
inline constexpr Shape kShape<StartOfFrame>{101, 24, 0xffff, 24, "Start of Frame"};
template <>
inline constexpr Shape kShape<HeightResponse>{102, 16, 0x0fff, 16, "HAT/HOT Response"};
template <>
inline constexpr Shape kShape<HeightExtendedResponse>{103, 40, 0x0ffe, 40, "HAT/HOT Extended Response"};
template <>
inline constexpr Shape kShape<SightResponse>{104, 16, 0x0ffd, 24, "Line of Sight Response"};
template <>
inline constexpr Shape kShape<SightExtendedResponse>{105, 56, 0x0ffc, 64, "Line of Sight Extended Response"};

// What the headers of 3.0 and 3.1 do not have.
inline std::optional<uint32_t>& otherSidesFrame(IgControl& header) {
  return header.igFrame;
}
inline std::optional<uint32_t>& otherSidesFrame(StartOfFrame& header) {
  return header.hostFrame;
}
template <class T>
inline constexpr bool kIsHeader = std::is_same_v<T, IgControl> || std::is_same_v<T, StartOfFrame>;

inline constexpr At kEntityId{2, 6};  // in both of an entity's packets
// The largest packet that is built: Weather Control of 4.0 and the segment request share it.
inline constexpr size_t kMaxBuiltBytes = 72;

}  // namespace eye::cigi
