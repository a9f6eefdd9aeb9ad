// The ids and sizes of the packets that are understood, in 3.x and in 4.0.
#pragma once

#include "link/cigi_fields.h"

namespace eye::cigi {

struct Shape {
  const char* name3;
  uint8_t id3, bytes3;
  const char* name4;
  uint16_t id4;
  uint8_t bytes4;

  constexpr const char* name(Version version) const { return version.major == 3 ? name3 : name4; }
  constexpr uint16_t id(Version version) const { return version.major == 3 ? id3 : id4; }
  constexpr size_t bytes(Version version) const { return version.major == 3 ? bytes3 : bytes4; }
};

// Sources for 3.x: Boeing's ICD 3.3 as Wireshark's packet-cigi.c reads it, and captures of the CIGI Class Library
// (CCL). Sources for 4.0: CCL 4.0.2's Pack functions and a capture of it; for Acceleration Control and the extended
// answers, which that capture lacks, CCL's CigiAccelerationCtrlV4, CigiHatHotXRespV4 and CigiLosXRespV4 and the structs
// of Boeing's Host Emulator for 4.0, which agree.
template <class T>
inline constexpr Shape kShape{};

template <>
inline constexpr Shape kShape<IgControl>{"IG Control", 1, 24, "IG Control", 0x0000, 24};
template <>
inline constexpr Shape kShape<EntityTraits>{"Entity Control", 2, 48, "Entity Control", 0x0025, 16};
template <>
inline constexpr Shape kShape<EntityPlace>{"Entity Control", 2, 48, "Entity Position", 0x0001, 48};
template <>
inline constexpr Shape kShape<ViewControl>{"View Control", 16, 32, "View Control", 0x000f, 40};
template <>
inline constexpr Shape kShape<ViewDefinition>{"View Definition", 21, 32, "View Definition", 0x0014, 40};
template <>
inline constexpr Shape kShape<Velocity>{"Rate Control", 8, 32, "Velocity Control", 0x0007, 32};
template <>
inline constexpr Shape kShape<Acceleration>{"Trajectory Definition", 20, 24, "Acceleration Control", 0x0013, 32};
template <>
inline constexpr Shape kShape<CelestialSphere>{"Celestial Sphere Control", 9,      16,
                                               "Celestial Sphere Control", 0x0008, 24};
template <>
inline constexpr Shape kShape<Atmosphere>{"Atmosphere Control", 10, 32, "Atmosphere Control", 0x0009, 32};
template <>
inline constexpr Shape kShape<Weather>{"Weather Control", 12, 56, "Weather Control", 0x000b, 72};
template <>
inline constexpr Shape kShape<HeightRequest>{"HAT/HOT Request", 24, 32, "HAT/HOT Request", 0x0017, 40};
template <>
inline constexpr Shape kShape<SightSegmentRequest>{"Line of Sight Segment Request", 25,     64,
                                                   "Line of Sight Segment Request", 0x0018, 72};
template <>
inline constexpr Shape kShape<SightVectorRequest>{"Line of Sight Vector Request", 26,     56,
                                                  "Line of Sight Vector Request", 0x0019, 64};
template <>
inline constexpr Shape kShape<StartOfFrame>{"Start of Frame", 101, 24, "Start of Frame", 0xffff, 24};
template <>
inline constexpr Shape kShape<HeightResponse>{"HAT/HOT Response", 102, 16, "HAT/HOT Response", 0x0fff, 16};
template <>
inline constexpr Shape kShape<HeightExtendedResponse>{"HAT/HOT Extended Response", 103,    40,
                                                      "HAT/HOT Extended Response", 0x0ffe, 40};
template <>
inline constexpr Shape kShape<SightResponse>{"Line of Sight Response", 104, 16, "Line of Sight Response", 0x0ffd, 24};
template <>
inline constexpr Shape kShape<SightExtendedResponse>{"Line of Sight Extended Response", 105,    56,
                                                     "Line of Sight Extended Response", 0x0ffc, 64};

// The headers of 3.0 and 3.1 are shorter: they end before the frame of the other side.
inline constexpr uint8_t kOldHeaderBytes = 16;
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
