// Terrain chunks: places vertices without a crack between neighbours and lights them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"

layout(set = 0, binding = EYE_BIND_DRAWS, scalar) readonly buffer DrawBlock { DrawData draws[]; };

layout(location = 0) in ivec4 inPositionSkirt;  // lattice steps; w: bits of the sides a skirt's lower rim hangs from
layout(location = 1) in vec2 inParam;           // (s, t)
layout(location = 2) in vec2 inNormal;          // octahedral, ecef

layout(location = 0) out vec2 outTexture;
layout(location = 1) out vec2 outLight;  // sunlight, skylight: 0..1
layout(location = 2) flat out uint outLayer;

vec3 normalFromOctahedral(vec2 o) {
  vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
  float under = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -under : under;
  n.y += n.y >= 0.0 ? -under : under;
  return normalize(n);
}

void main() {
  DrawData chunk = draws[gl_InstanceIndex];
  // Integers up to here, so that two chunks of one level get the same bits for a point that they share.
  ivec3 cell_ecef = inPositionSkirt.xyz + chunk.originMinusEyeCell;
  precise vec3 position_ecef = vec3(cell_ecef) * chunk.stepM - chunk.eyeFractionM;
  if (inPositionSkirt.w != 0) {
    vec3 outward = vec3(0.0);
    for (int side = 0; side < 4; ++side) {
      if ((inPositionSkirt.w & (1 << side)) != 0) outward += chunk.outward_ecef[side].xyz;
    }
    position_ecef += chunk.skirtDepthM * (EYE_SKIRT_FLARE * outward - chunk.up_ecef);
  }
  precise vec4 position_clip = frame.clipFromEcef * vec4(position_ecef, 1.0);
  gl_Position = position_clip;

  // The local vertical, for light alone: in units of the Earth's radius floats are plenty.
  vec3 up = normalize(frame.up_ecef.xyz * frame.up_eye.w + position_ecef * (1.0 / EYE_EARTH_RADIUS_M));
  vec3 normal = normalFromOctahedral(inNormal);
  float sunHeight = dot(up, frame.sun_ecef.xyz);
  float day = smoothstep(-0.02, 0.06, sunHeight);
  float dusk = smoothstep(-0.20, 0.12, sunHeight);
  outLight.x = max(dot(normal, frame.sun_ecef.xyz), 0.0) * day;
  outLight.y = (0.6 + 0.4 * dot(normal, up)) * (0.16 + 0.84 * dusk);
  outTexture = inParam * chunk.textureScale + chunk.textureOffset;
  outLayer = chunk.textureLayer;
}
