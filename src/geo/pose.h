// Where an eye or aircraft is and how it is turned. Degrees at every outside edge; matrices are made from this in
// frames.h.
#pragma once

namespace eye {

// WGS84 geodetic. Altitude in metres above the terrain database's vertical datum.
struct Geodetic {
  double latDeg = 0;
  double lonDeg = 0;
  double altM = 0;
  bool operator==(const Geodetic&) const = default;
};

// Heading clockwise from true north, pitch nose-up, roll right-wing-down; applied yaw, pitch, roll.
struct Pose {
  Geodetic position;
  double headingDeg = 0;
  double pitchDeg = 0;
  double rollDeg = 0;
  bool operator==(const Pose&) const = default;
};

}  // namespace eye
