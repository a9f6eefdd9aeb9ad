// What both ways of drawing terrain share in the vertex shader: a chunk's vertex placed without a crack to its
// neighbours, and the light on it. GLSL only; needs `frame`.
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

vec3 normalFromOctahedral(vec2 o) {
  vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
  float under = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -under : under;
  n.y += n.y >= 0.0 ? -under : under;
  return normalize(n);
}

// Sets gl_Position, `precise` since two pipelines draw neighbours, whose shared points must have the same bits; returns where the vertex lies from the eye.
vec3 placeVertex() {
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
  return position_ecef;
}

struct GroundLight {
  vec3 colour;  // of sun and sky, on the ground
  float lit;    // how far the haze over it is lit
};

GroundLight lightAt(vec3 position_ecef) {
  GroundLight ground;
  // The local vertical, for light alone: in units of the Earth's radius floats are plenty.
  vec3 up = normalize(frame.up_ecef.xyz * frame.up_eye.w + position_ecef * (1.0 / EYE_EARTH_RADIUS_M));
  vec3 normal = normalFromOctahedral(inNormal);
  float sunHeight = dot(up, frame.sun_ecef.xyz);
  float lit = skyLit(sunHeight);
  ground.lit = mix(lit, frame.skyLight.w, frame.airDepth.w);
  // The sun's disc rises over two degrees; the sky lights a slope by how much of it the slope sees; moon and stars
  // leave a third of that, so that terrain stays faintly visible.
  float sunlight = max(dot(normal, frame.sun_ecef.xyz), 0.0) * smoothstep(-0.02, 0.06, sunHeight);
  float skylight = (0.6 + 0.4 * dot(normal, up)) * (0.25 + 0.75 * lit);
  ground.colour = frame.sunLight.rgb * sunlight + frame.skyLight.rgb * skylight;
  return ground;
}

vec2 textureAt() { return inParam * inTextureMap.xy + inTextureMap.zw; }
