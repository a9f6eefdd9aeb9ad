// Terrain chunks in the colours of a debug view: placed as terrain.vert places them, lit by the sun alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"

layout(location = EYE_AT_POSITION_SKIRT) in ivec4 inPositionSkirt;
layout(location = EYE_AT_PARAM) in vec2 inParam;
layout(location = EYE_AT_NORMAL) in vec2 inNormal;
layout(location = EYE_AT_ORIGIN) in ivec3 inOriginMinusEyeCell;
layout(location = EYE_AT_STEP) in float inStepM;
layout(location = EYE_AT_FRACTION_SKIRT) in vec4 inEyeFractionSkirtM;
layout(location = EYE_AT_UP) in vec3 inUp_ecef;
layout(location = EYE_AT_LAYER) in uint inLayer;
layout(location = EYE_AT_OUTWARD) in vec4 inOutwardTint[4];  // w of the four: the tint's red, green, blue and strength
layout(location = EYE_AT_TEXTURE_MAP) in vec4 inTextureMap;

layout(location = 0) out vec2 outTexture;
layout(location = 1) out float outLight;
layout(location = 2) flat out uint outLayer;
layout(location = 3) flat out vec4 outTint;

vec3 normalFromOctahedral(vec2 o) {
  vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
  float under = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -under : under;
  n.y += n.y >= 0.0 ? -under : under;
  return normalize(n);
}

void main() {
  vec3 position_ecef = vec3(inPositionSkirt.xyz + inOriginMinusEyeCell) * inStepM - inEyeFractionSkirtM.xyz;
  vec4 hangs = vec4(notEqual(inPositionSkirt.wwww & ivec4(1, 2, 4, 8), ivec4(0)));
  vec3 outward = inOutwardTint[0].xyz * hangs.x + inOutwardTint[1].xyz * hangs.y + inOutwardTint[2].xyz * hangs.z +
                 inOutwardTint[3].xyz * hangs.w;
  position_ecef += min(dot(hangs, hangs), 1.0) * inEyeFractionSkirtM.w * (EYE_SKIRT_FLARE * outward - inUp_ecef);
  gl_Position = frame.clipFromEcef * vec4(position_ecef, 1.0);
  outTexture = inParam * inTextureMap.xy + inTextureMap.zw;
  outLight = 0.45 + 0.55 * max(dot(normalFromOctahedral(inNormal), frame.sun_ecef.xyz), 0.0);
  outLayer = inLayer;
  outTint = vec4(inOutwardTint[0].w, inOutwardTint[1].w, inOutwardTint[2].w, inOutwardTint[3].w);
}
