// One level of the depth pyramid from the next finer one: the farthest of the texels that each texel covers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/cull_buffers.h"

layout(local_size_x = EYE_DEPTH_GROUP, local_size_y = EYE_DEPTH_GROUP) in;

layout(push_constant) uniform Push { int level; };  // the one to make; steers no branch

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = levelSize(params.mapPx, level), finerSize = levelSize(params.mapPx, level - 1);
  if (texel.x >= size.x || texel.y >= size.y) return;
  ivec2 columns = finerSpan(texel.x, size.x, finerSize.x), rows = finerSpan(texel.y, size.y, finerSize.y);
  int finer = params.levelOffset[level - 1];
  float farthest = 1.0;
  for (int row = rows.x; row <= rows.y; ++row) {
    for (int column = columns.x; column <= columns.y; ++column)
      farthest = min(farthest, pyramid[finer + row * finerSize.x + column]);
  }
  pyramid[params.levelOffset[level] + texel.y * size.x + texel.x] = farthest;
}
