// The finest level of the depth map: for each texel the farthest depth of all pixels that it touches, so that a map
// coarser than the picture hides nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/cull_buffers.h"

layout(local_size_x = EYE_DEPTH_GROUP, local_size_y = EYE_DEPTH_GROUP) in;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= params.mapPx.x || texel.y >= params.mapPx.y) return;
  ivec2 columns = pixelSpan(texel.x, params.mapPx.x, params.picturePx.x);
  ivec2 rows = pixelSpan(texel.y, params.mapPx.y, params.picturePx.y);
  float farthest = 1.0;
  for (int row = rows.x; row <= rows.y; ++row) {
    for (int column = columns.x; column <= columns.y; ++column)
      farthest = min(farthest, depth[row * params.picturePx.x + column]);
  }
  pyramid[texel.y * params.mapPx.x + texel.x] = farthest;
}
