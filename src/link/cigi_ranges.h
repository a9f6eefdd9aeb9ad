// The ranges in which numbers of CIGI packets are believed. Wider than the standard where senders are known to be:
// angles of either sign, and bounds on sizes only against garbage.
#pragma once

#include "link/cigi_fields.h"
#include "link/pose_limits.h"

namespace eye::cigi {

// The standard has -180 to 180 for roll and 0 to 360 for yaw; senders mix the two up, and a turn more does no harm.
inline constexpr Range kRoll{"roll", -360, 360};
inline constexpr Range kPitch{"pitch", -90, 90};
inline constexpr Range kYaw{"yaw", -360, 360};
inline constexpr Range kAzimuth{"azimuth", -360, 360};
inline constexpr Range kElevation{"elevation", -90, 90};
inline constexpr Range kDirection{"wind direction", -360, 360};

inline constexpr Range kEyeOffset{"offset", -1e6, 1e6};
inline constexpr Range kNear{"near plane", 1e-3, 1e3};  // as --near
inline constexpr Range kFar{"far plane", 1e-3, 1e9};
inline constexpr Range kHalfAngle{"half-angle", -89.9, 89.9};  // as geo/view.h has it
inline constexpr Range kEdgeM{"half-width", -1e6, 1e6};
inline constexpr Range kRange{"range", 0, 1e9};

inline constexpr Range kSpeed{"speed", -1e5, 1e5};  // escape velocity is 11,200 m/s
inline constexpr Range kAcceleration{"acceleration", -1e6, 1e6};
inline constexpr Range kTurnRate{"turn rate", -1e6, 1e6};

inline constexpr Range kHour{"hour", 0, 23};
inline constexpr Range kMinute{"minute", 0, 59};
inline constexpr Range kSecond{"second", 0, 61};  // leap seconds
inline constexpr Range kPercent{"percentage", 0, 100};
inline constexpr Range kTemperature{"temperature", -273.15, 1000};
inline constexpr Range kVisibility{"visibility", 0, 1e9};
inline constexpr Range kWind{"wind", -1000, 1000};
inline constexpr Range kPressure{"pressure", 0, 10'000};
inline constexpr Range kCloudBase{"base elevation", kMinAltitudeM, 1e6};
inline constexpr Range kCloudDepth{"thickness", 0, 1e6};
inline constexpr Range kAerosol{"aerosol concentration", 0, 1e6};

inline constexpr Range kHeight{"height", -kMaxAltitudeM, kMaxAltitudeM};
inline constexpr Range kCoordinate{"coordinate", -1e9, 1e9};

// Entities fly in the altitudes of every other source; test points may lie below all ground, as a ray's far end does.
inline constexpr double kLowestEntityM = kMinAltitudeM;
inline constexpr double kLowestTestPointM = -1e7;

}  // namespace eye::cigi
