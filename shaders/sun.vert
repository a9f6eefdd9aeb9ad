// A square about the sun, behind everything.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"

// Half its side as a tangent: the disc's rim ends at 0.0047.
const float kHalf = 0.005;

void main() {
  vec2 corner = vec2((0x32 >> gl_VertexIndex) & 1, (0x2C >> gl_VertexIndex) & 1) * 2.0 - 1.0;
  vec3 sun = frame.sun_ecef.xyz;
  vec3 aside = normalize(cross(sun, abs(sun.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
  vec3 ray_ecef = sun + kHalf * (corner.x * aside + corner.y * cross(sun, aside));
  gl_Position = frame.clipFromEcef * vec4(ray_ecef, 0.0);
  gl_Position.z = EYE_CLEAR_DEPTH;
}
