// Of a picture with several samples a pixel: the farthest of each pixel's, for the depth pyramid. What shows at any of
// them is then not hidden.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/config.h"

layout(local_size_x = EYE_DEPTH_GROUP, local_size_y = EYE_DEPTH_GROUP) in;

layout(set = 0, binding = 0) uniform sampler2DMS samples;
layout(set = 0, binding = 1, scalar) writeonly buffer DepthBlock { float depth[]; };

void main() {
  ivec2 size = textureSize(samples), pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  float farthest = 1.0;
  for (int i = 0; i < EYE_MOST_SAMPLES; ++i) farthest = min(farthest, texelFetch(samples, pixel, i).r);
  depth[pixel.y * size.x + pixel.x] = farthest;
}
