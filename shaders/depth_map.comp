// The finest level of the depth map: for each texel the farthest depth of all pixels that it touches, so that a map
// coarser than the picture hides nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/cull_buffers.h"

layout(local_size_x = EYE_DEPTH_GROUP, local_size_y = EYE_DEPTH_GROUP) in;

// Pixels that a texel touches along either axis, at most; 0: any number. Loops of known length cost a CPU device a
// quarter of others.
layout(constant_id = 0) const int kTaps = 0;

layout(push_constant, scalar) uniform Push { DepthLevel level; };

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= level.size.x || texel.y >= level.size.y) return;
  ivec2 columns = pixelSpans[texel.x], rows = pixelSpans[level.size.x + texel.y];
  int width = kTaps > 0 ? kTaps : columns.y - columns.x + 1, height = kTaps > 0 ? kTaps : rows.y - rows.x + 1;
  float farthest = 1.0;
  for (int y = 0; y < height; ++y) {
    int row = min(rows.x + y, rows.y) * level.finerSize.x;
    for (int x = 0; x < width; ++x) farthest = min(farthest, depth[row + min(columns.x + x, columns.y)]);
  }
  pyramid[texel.y * level.size.x + texel.x] = farthest;
}
