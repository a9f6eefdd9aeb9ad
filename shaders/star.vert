// Stars: a spot each, behind everything, as bright as the air before it and the sky around it let it be.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"

layout(location = 0) in vec4 inNdcHalf;  // centre and half size of the spot
layout(location = 1) in vec4 inRayBrightness;

layout(location = 0) out vec2 outFromCentre;  // -1 to 1
layout(location = 1) flat out float outBrightness;

void main() {
  vec2 corner = vec2((0x32 >> gl_VertexIndex) & 1, (0x2C >> gl_VertexIndex) & 1) * 2.0 - 1.0;
  outFromCentre = corner;
  vec3 ray_eye = inRayBrightness.xyz;
  float rise = dot(ray_eye, frame.up_eye.xyz);
  // Through the air, whose depth is given as displayed, and drowned by a sky brighter than itself.
  float through = exp(-0.25 * frame.airDepth.g * skyColumn(rise));
  vec3 sky = skyColour(rise, dot(ray_eye, frame.sun_eye.xyz));
  float dark = max(1.0 - 3.0 * max(max(sky.r, sky.g), sky.b), 0.0) * (1.0 - frame.airDepth.w);
  outBrightness = inRayBrightness.w * through * dark;
  gl_Position = vec4(inNdcHalf.xy + inNdcHalf.zw * corner, EYE_CLEAR_DEPTH, 1.0);
}
