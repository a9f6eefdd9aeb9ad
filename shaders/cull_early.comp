// Early pass: draws the clusters that were visible in the last frame and are still in view. Their depth becomes the
// depth map against which the late pass tests all clusters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/cull_buffers.h"

layout(local_size_x = EYE_CULL_GROUP) in;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= params.candidateCount) return;
  CullCandidate candidate = candidates[i];
  CullChunk chunk = chunks[candidate.chunk];
  ClusterRecord cluster = clusters[candidate.cluster];
  CullBox box = boxOf(chunk, cluster);
  bool inView = params.isFrozen != 0u || fateInView(box, clipBoxOf(params, box), cluster) == EYE_FATE_VISIBLE;
  early[i] = commandOf(chunk, cluster, inView && visible[candidate.cluster] != 0u);
}
