// Terrain: light and haze by vertex, so that a pixel is a texel times one colour plus another. Where a chunk's triangles
// are so wide that this would show, terrain_wide draws it: see render/haze_width.h.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/terrain_vertex.h"

// Packed: on a CPU device each output costs a triangle its slopes, used or not.
layout(location = 0) out vec4 outLightS;  // light of sun and sky on the ground, as much as comes through the haze; s
layout(location = 1) out vec4 outHazeT;   // light that the haze adds; t
layout(location = 2) flat out uint outLayer;

void main() {
  vec3 position_ecef = placeVertex();
  GroundLight ground = lightAt(position_ecef);
  float distanceM = length(position_ecef);
  float seenThrough = exp2(-hazePerMetre(position_ecef) * EYE_LOG2_E * distanceM);
  float towardsSun = dot(position_ecef, frame.sun_ecef.xyz) / max(distanceM, 1e-3);
  vec2 at = textureAt();
  outLightS = vec4(ground.colour * seenThrough, at.x);
  outHazeT = vec4(hazeColour(towardsSun, ground.lit) * (1.0 - seenThrough), at.y);
  outLayer = inLayer;
}
