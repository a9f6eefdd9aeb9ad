// The sky as a dome of colours about the eye, its rings closest along the horizon. An instance is the strip between two
// meridians, from the nadir up; render/sky_dome.h says which of them are in view.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"

layout(location = 0) out vec3 outColour;

void main() {
  // Both strips of a meridian compute it from the same numbers.
  int meridian = (gl_InstanceIndex + (gl_VertexIndex & 1)) % EYE_DOME_MERIDIANS;
  int ring = gl_VertexIndex / 2 - EYE_DOME_RINGS;
  float azimuth = float(meridian) * (2.0 * EYE_PI / float(EYE_DOME_MERIDIANS));
  float share = float(abs(ring)) * (1.0 / float(EYE_DOME_RINGS));
  float elevation = (exp(EYE_DOME_CROWDING * share) - 1.0) * (0.5 * EYE_PI / (exp(EYE_DOME_CROWDING) - 1.0));
  float rise = ring < 0 ? -sin(elevation) : sin(elevation);
  vec3 up = frame.up_ecef.xyz;
  vec3 ahead = frame.domeAhead_ecef.xyz;
  vec3 level = ahead * cos(azimuth) + cross(up, ahead) * sin(azimuth);
  vec3 ray_ecef = up * rise + level * cos(elevation);
  gl_Position = frame.clipFromEcef * vec4(ray_ecef, 0.0);
  gl_Position.z = EYE_CLEAR_DEPTH;
  outColour = skyColour(rise, dot(ray_ecef, frame.sun_ecef.xyz));
}
