// Terrain in the colours of a debug view: no haze, so that the farthest cluster shows its colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/config.h"

layout(set = 0, binding = EYE_BIND_TEXTURES) uniform sampler2DArray textures;

layout(location = 0) in vec2 inTexture;
layout(location = 1) in float inLight;
layout(location = 2) flat in uint inLayer;
layout(location = 3) flat in vec4 inTint;

layout(location = 0) out vec4 outColour;

void main() {
  vec3 ground = texture(textures, vec3(inTexture, float(inLayer))).rgb;
  outColour = vec4(mix(ground, inTint.rgb, inTint.a) * inLight, 1.0);
}
