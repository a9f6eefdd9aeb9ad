// Terrain in triangles too wide for haze by vertex: see terrain_wide.frag.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/terrain_vertex.h"

layout(location = 0) out vec2 outTexture;
layout(location = 1) out vec3 outLight;
layout(location = 2) out vec2 outHaze;  // optical depth per metre, base 2; how far the haze is lit
layout(location = 3) flat out uint outLayer;

void main() {
  vec3 position_ecef = placeVertex();
  GroundLight ground = lightAt(position_ecef);
  outTexture = textureAt();
  outLight = ground.colour;
  outHaze = vec2(hazePerMetre(position_ecef) * EYE_LOG2_E, ground.lit);
  outLayer = inLayer;
}
