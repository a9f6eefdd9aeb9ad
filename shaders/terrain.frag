// Terrain: imagery in the light and haze of its vertices. No uniforms and no derivation on purpose: small triangles shade
// each pixel two to three times over on a CPU device, where this is half of a frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/config.h"

layout(set = 0, binding = EYE_BIND_TEXTURES) uniform sampler2DArray textures;

layout(location = 0) in vec4 inLightS;
layout(location = 1) in vec4 inHazeT;
layout(location = 2) flat in uint inLayer;

layout(location = 0) out vec4 outColour;

void main() {
  vec3 ground = texture(textures, vec3(inLightS.w, inHazeT.w, float(inLayer))).rgb;
  outColour = vec4(ground * inLightS.rgb + inHazeT.rgb, 1.0);
}
