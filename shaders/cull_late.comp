// Late pass: tests every cluster against the depth map, draws those that show and were not drawn early, and keeps who
// is visible for the next frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/cull_buffers.h"

layout(local_size_x = EYE_CULL_GROUP) in;

float depthAt(ivec2 texel, int level) {
  return pyramid[params.levelOffset[level] + texel.y * levelSize(params.mapPx, level).x + texel.x];
}

// Behind the farthest depth of the rectangle's footprint.
bool isOccluded(MapRect rect) {
  if (!rect.isKnown) return false;
  int level = levelOf(rect);
  ivec2 low = texelAt(rect.low, level), high = texelAt(rect.high, level);
  float farthest = 1.0;
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) farthest = min(farthest, depthAt(ivec2(x, y), level));
  }
  return rect.nearest < farthest;
}

void main() {
  // Invocations beyond the last candidate stay for the barrier, on the last candidate's data.
  uint i = gl_GlobalInvocationID.x;
  bool isCandidate = i < params.candidateCount;
  i = min(i, params.candidateCount - 1u);
  CullCandidate candidate = candidates[i];
  CullChunk chunk = chunks[candidate.chunk];
  ClusterRecord cluster = clusters[candidate.cluster];
  CullBox box = boxOf(chunk, cluster);
  ClipBox clip = clipBoxOf(params, box);
  uint fate = fateInView(params, box, clip, cluster.cone);
  if (fate == EYE_FATE_VISIBLE && isOccluded(mapRectOf(params, clip))) fate = EYE_FATE_OCCLUDED;
  uint wasDrawn = fates[i] & EYE_FATE_EARLY;
  bool isDrawn = isCandidate && fate == EYE_FATE_VISIBLE && wasDrawn == 0u;
  DrawCommand command = commandOf(candidate.chunk, chunk.vertexOffset, chunk.draw, cluster, isDrawn);
  if (!isCandidate) return;
  visible[candidate.cluster] = fate == EYE_FATE_VISIBLE ? 1u : 0u;
  late[i] = command;
  fates[i] = fate | wasDrawn | (isDrawn ? EYE_FATE_LATE : 0u) | (cluster.indexCount / 3u << EYE_FATE_BITS);
}
