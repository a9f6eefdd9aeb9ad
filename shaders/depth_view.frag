// A level of the depth pyramid as a picture: distance on a logarithmic scale from 32 m (pale yellow) to 260 km (dark
// violet), every other doubling a shade darker; blue where no terrain is.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/cull_types.h"

layout(set = 0, binding = 0, scalar) readonly buffer PyramidBlock { float pyramid[]; };
layout(push_constant, scalar) uniform Push { DepthViewLevel level; };

layout(location = 0) out vec4 outColour;

void main() {
  ivec2 texel = clamp(ivec2((gl_FragCoord.xy - level.cornerPx) * level.texelsPerPx), ivec2(0), level.size - 1);
  float depth = pyramid[level.offset + texel.y * level.size.x + texel.x];
  float doublings = log2(level.nearM / max(depth, 1e-12));
  float t = clamp((doublings - 5.0) / 13.0, 0.0, 1.0);
  vec3 colour = mix(mix(vec3(1.0, 0.96, 0.72), vec3(0.93, 0.47, 0.28), min(2.0 * t, 1.0)), vec3(0.20, 0.05, 0.31),
                    max(2.0 * t - 1.0, 0.0));
  colour *= 1.0 - 0.12 * step(1.0, mod(doublings, 2.0));
  outColour = vec4(mix(vec3(0.25, 0.45, 0.80), colour, step(1e-12, depth)), 1.0);
}
