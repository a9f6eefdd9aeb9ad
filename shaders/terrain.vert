// Terrain chunks: places vertices without a crack between neighbours and lights them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"
#include "shared/bend.h"

layout(location = EYE_AT_POSITION_SKIRT) in ivec4 inPositionSkirt;  // lattice steps; w: sides a skirt's lower rim hangs from
layout(location = EYE_AT_PARAM) in vec2 inParam;                    // (s, t)
layout(location = EYE_AT_NORMAL) in vec2 inNormal;                  // octahedral, ecef
// Of the chunk, see DrawData.
layout(location = EYE_AT_ORIGIN) in ivec3 inOriginMinusEyeCell;
layout(location = EYE_AT_STEP) in float inStepM;
layout(location = EYE_AT_FRACTION_SKIRT) in vec4 inEyeFractionSkirtM;
layout(location = EYE_AT_UP) in vec3 inUp_ecef;
layout(location = EYE_AT_LAYER) in uint inLayer;
layout(location = EYE_AT_OUTWARD) in vec3 inOutward_ecef[4];
layout(location = EYE_AT_TEXTURE_MAP) in vec4 inTextureMap;

layout(location = 0) out vec2 outTexture;
layout(location = 1) out vec3 outLight;  // of sun and sky, on the ground
layout(location = 2) out vec2 outHaze;   // optical depth per metre, base 2; how far the haze is lit
layout(location = 3) flat out uint outLayer;

vec3 normalFromOctahedral(vec2 o) {
  vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
  float under = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -under : under;
  n.y += n.y >= 0.0 ? -under : under;
  return normalize(n);
}

void main() {
  // Integers up to here, so that two chunks of one level get the same bits for a point that they share.
  ivec3 cell_ecef = inPositionSkirt.xyz + inOriginMinusEyeCell;
  precise vec3 position_ecef = vec3(cell_ecef) * inStepM - inEyeFractionSkirtM.xyz;
  if (inPositionSkirt.w != 0) {
    vec4 hangs = vec4(notEqual(inPositionSkirt.wwww & ivec4(1, 2, 4, 8), ivec4(0)));
    vec3 outward = inOutward_ecef[0] * hangs.x + inOutward_ecef[1] * hangs.y + inOutward_ecef[2] * hangs.z +
                   inOutward_ecef[3] * hangs.w;
    position_ecef += inEyeFractionSkirtM.w * (EYE_SKIRT_FLARE * outward - inUp_ecef);
  }
  if (kBends) position_ecef = bent(position_ecef);
  precise vec4 position_clip = frame.clipFromEcef * vec4(position_ecef, 1.0);
  gl_Position = position_clip;

  // The local vertical, for light alone: in units of the Earth's radius floats are plenty.
  vec3 up = normalize(frame.up_ecef.xyz * frame.up_eye.w + position_ecef * (1.0 / EYE_EARTH_RADIUS_M));
  vec3 normal = normalFromOctahedral(inNormal);
  float sunHeight = dot(up, frame.sun_ecef.xyz);
  float lit = skyLit(sunHeight);
  // The sun's disc rises over two degrees; the sky lights a slope by how much of it the slope sees; moon and stars
  // leave a third of that, so that terrain stays faintly visible.
  float sunlight = max(dot(normal, frame.sun_ecef.xyz), 0.0) * smoothstep(-0.02, 0.06, sunHeight);
  float skylight = (0.6 + 0.4 * dot(normal, up)) * (0.25 + 0.75 * lit);
  outLight = frame.sunLight.rgb * sunlight + frame.skyLight.rgb * skylight;
  outHaze = vec2(hazePerMetre(position_ecef) * EYE_LOG2_E, lit);
  outTexture = inParam * inTextureMap.xy + inTextureMap.zw;
  outLayer = inLayer;
}
