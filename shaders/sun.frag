// The sun's disc, added to the sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"

layout(location = 0) out vec4 outColour;

void main() {
  vec3 ray_eye = normalize(rayThrough(gl_FragCoord.xy));
  outColour = vec4(vec3(sunDisc(ray_eye, dot(ray_eye, frame.up_eye.xyz))), 0.0);
}
