// The site of the embedded demo: what its terrain is built around and its flights take off from. The terrain has the
// runway's plateau exactly at kDemoRunwayElevationM; mountains reach about kDemoHighestTerrainM.
#pragma once

namespace eye {

// The runway's middle (WGS84, degrees); it runs due east and west.
inline constexpr double kDemoRunwayLatDeg = 36.63;
inline constexpr double kDemoRunwayLonDeg = 128.35;
inline constexpr double kDemoRunwayElevationM = 150;
inline constexpr double kDemoRunwayHeadingDeg = 90;
inline constexpr double kDemoRunwayLengthM = 3000;
inline constexpr double kDemoRunwayWidthM = 60;

// The region in which the demo has detailed terrain.
inline constexpr double kDemoWestDeg = 127.85;
inline constexpr double kDemoEastDeg = 128.85;
inline constexpr double kDemoSouthDeg = 36.13;
inline constexpr double kDemoNorthDeg = 37.13;
inline constexpr double kDemoHighestTerrainM = 2000;

}  // namespace eye
