// Which part of the sky's dome (shaders/sky_dome.vert) a view can see. Far below the horizon, where terrain hides it,
// the dome is a rough copy of the sky by pixel: at the nadir the latter goes from day to night at once. Where it is
// known to be hidden it is left out: the tests of its depth alone were 5 % of a frame.
#pragma once

#include <cstdint>

#include "geo/view.h"

namespace eye {

// Above this the limb is narrower than the dome's rings, and the sky is drawn by pixel.
inline constexpr double kDomeTopM = 12000;

// The strips between meridian i and i + 1, i modulo EYE_DOME_MERIDIANS; the vertices 2 r and 2 r + 1 of a strip lie on
// ring r, 0 the nadir, 2 EYE_DOME_RINGS the zenith.
struct DomePart {
  uint32_t firstStrip = 0, strips = 0;
  uint32_t firstRing = 0, rings = 0;
};

// Holds all that the view sees above the elevation `lowestRad`. `aheadEcef`: direction of meridian 0, level at the eye,
// where `upEcef` is up.
DomePart domePart(const View& view, const Vec3d& upEcef, const Vec3d& aheadEcef, double lowestRad);

// An elevation below which every ray from so high over the ellipsoid meets the ellipsoid lowered by `depthM`, radians;
// the nadir's where there is none, for an eye below that.
double horizonRad(double heightM, double depthM);

// A level direction, of which there are many.
Vec3d domeAhead(const Vec3d& upEcef);

// Elevation of a ring, radians, as the shader has it.
double domeRingRad(uint32_t ring);

}  // namespace eye
