// The descriptor set of the culling passes. GLSL only.
#extension GL_EXT_scalar_block_layout : require

#include "shared/cull.h"

layout(set = 0, binding = EYE_BIND_CULL_PARAMS, scalar) readonly buffer ParamsBlock {
  CullParams params;
};
layout(set = 0, binding = EYE_BIND_CULL_CHUNKS, scalar) readonly buffer ChunksBlock {
  CullChunk chunks[];
};
layout(set = 0, binding = EYE_BIND_CULL_CANDIDATES, scalar) readonly buffer CandidatesBlock {
  CullCandidate candidates[];
};
layout(set = 0, binding = EYE_BIND_CLUSTERS, scalar) readonly buffer ClustersBlock {
  ClusterRecord clusters[];
};
layout(set = 0, binding = EYE_BIND_VISIBLE, scalar) buffer VisibleBlock {
  uint visible[];
};  // by cluster, last frame
layout(set = 0, binding = EYE_BIND_EARLY, scalar) buffer EarlyBlock {
  DrawCommand early[];
};
layout(set = 0, binding = EYE_BIND_LATE, scalar) writeonly buffer LateBlock {
  DrawCommand late[];
};
layout(set = 0, binding = EYE_BIND_FATES, scalar) buffer FatesBlock {
  uint fates[];
};
layout(set = 0, binding = EYE_BIND_DEPTH, scalar) readonly buffer DepthBlock {
  float depth[];
};  // of the early pass
layout(set = 0, binding = EYE_BIND_PYRAMID, scalar) buffer PyramidBlock {
  float pyramid[];
};
// pixelSpan of each column, then of each row, of the depth map: integer division is slow on CPUs.
layout(set = 0, binding = EYE_BIND_PIXEL_SPANS, scalar) readonly buffer SpansBlock {
  ivec2 pixelSpans[];
};

// Of the clusters of a group: their indices where they are drawn, else 0, and their chunks.
shared uint drawnIndices[EYE_CULL_GROUP];
shared uint groupChunks[EYE_CULL_GROUP];

// Clusters of a chunk that are drawn and lie behind one another become one draw: the command of the first of them has
// the indices of all, the others' draw nothing. Call it in all invocations of a group.
DrawCommand commandOf(uint chunkIndex, int vertexOffset, uint drawIndex, ClusterRecord cluster, bool isDrawn) {
  uint lane = gl_LocalInvocationID.x;
  drawnIndices[lane] = isDrawn ? cluster.indexCount : 0u;
  groupChunks[lane] = chunkIndex;
  barrier();
  bool goesOn = lane > 0u && drawnIndices[max(lane, 1u) - 1u] != 0u && groupChunks[max(lane, 1u) - 1u] == chunkIndex;
  uint indexCount = 0u;
  if (isDrawn && !goesOn) {
    for (uint k = lane; k < EYE_CULL_GROUP && drawnIndices[k] != 0u && groupChunks[k] == chunkIndex; ++k)
      indexCount += drawnIndices[k];
  }
  return DrawCommand(indexCount, indexCount != 0u ? 1u : 0u, cluster.firstIndex, vertexOffset, drawIndex);
}
