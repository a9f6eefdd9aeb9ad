// The sky by pixel, where no terrain is: from heights whose limb is narrower than the dome's rings.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"

layout(location = 0) out vec4 outColour;

void main() {
  vec3 ray_eye = normalize(rayThrough(gl_FragCoord.xy));
  vec3 sky = skyColour(dot(ray_eye, frame.up_eye.xyz), dot(ray_eye, frame.sun_eye.xyz));
  outColour = vec4(dithered(sky, gl_FragCoord.xy), 1.0);
}
