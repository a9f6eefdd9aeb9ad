// Early pass: draws the clusters that were visible in the last frame and are still in view. Their depth becomes the
// depth map against which the late pass tests all clusters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/cull_buffers.h"

layout(local_size_x = EYE_CULL_GROUP) in;

void main() {
  // Invocations beyond the last candidate stay for the barrier, on the last candidate's data.
  uint i = gl_GlobalInvocationID.x;
  CullCandidate candidate = candidates[min(i, params.candidateCount - 1u)];
  CullChunk chunk = chunks[candidate.chunk];
  ClusterRecord cluster = clusters[candidate.cluster];
  CullBox box = boxOf(chunk, cluster);
  uint fate = fateInView(params, box, clipBoxOf(params, box), cluster.cone);
  bool inView = params.isFrozen != 0u || fate == EYE_FATE_VISIBLE;
  bool isDrawn = i < params.candidateCount && inView && visible[candidate.cluster] != 0u;
  DrawCommand command = commandOf(candidate.chunk, chunk.vertexOffset, chunk.draw, cluster, isDrawn);
  if (i >= params.candidateCount) return;
  early[i] = command;
  fates[i] = (isDrawn ? EYE_FATE_EARLY : 0u) | (cluster.indexCount / 3u << EYE_FATE_BITS);
}
