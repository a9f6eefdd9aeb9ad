// One level of the depth pyramid from the next finer one: the farthest of the texels that each texel covers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/cull_buffers.h"

layout(local_size_x = EYE_DEPTH_GROUP, local_size_y = EYE_DEPTH_GROUP) in;

layout(push_constant, scalar) uniform Push { DepthLevel level; };

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= level.size.x || texel.y >= level.size.y) return;
  int left = 2 * texel.x, right = min(left + 1, level.finerSize.x - 1);
  int top = level.finerOffset + 2 * texel.y * level.finerSize.x;
  int bottom = level.finerOffset + min(2 * texel.y + 1, level.finerSize.y - 1) * level.finerSize.x;
  pyramid[level.offset + texel.y * level.size.x + texel.x] =
      min(min(pyramid[top + left], pyramid[top + right]), min(pyramid[bottom + left], pyramid[bottom + right]));
}
