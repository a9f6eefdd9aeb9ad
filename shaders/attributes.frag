// What the shading pass needs to know of a pixel of terrain, in 8 bytes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/config.h"

layout(location = 0) in vec2 inTexture;
layout(location = 1) in vec2 inLight;
layout(location = 2) flat in uint inLayer;

layout(location = 0) out uvec2 outAttributes;

void main() {
  uint sun = uint(clamp(inLight.x, 0.0, 1.0) * float((1 << EYE_SUN_BITS) - 1) + 0.5);
  uint sky = uint(clamp(inLight.y, 0.0, 1.0) * float((1 << EYE_SKY_BITS) - 1) + 0.5);
  outAttributes = uvec2(packUnorm2x16(inTexture), inLayer | (sun << EYE_LAYER_BITS) | (sky << (EYE_LAYER_BITS + EYE_SUN_BITS)));
}
