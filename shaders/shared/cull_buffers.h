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
layout(set = 0, binding = EYE_BIND_FATES, scalar) writeonly buffer FatesBlock {
  uint fates[];
};
layout(set = 0, binding = EYE_BIND_DEPTH, scalar) readonly buffer DepthBlock {
  float depth[];
};  // of the early pass
layout(set = 0, binding = EYE_BIND_PYRAMID, scalar) buffer PyramidBlock {
  float pyramid[];
};

DrawCommand commandOf(CullChunk chunk, ClusterRecord cluster, bool isDrawn) {
  return DrawCommand(cluster.indexCount, isDrawn ? 1u : 0u, cluster.firstIndex, chunk.vertexOffset, chunk.draw);
}

// What can be told without the depth map.
uint fateInView(CullBox box, ClipBox clip, ClusterRecord cluster) {
  if (isOutsideFrustum(params, clip)) return EYE_FATE_OUTSIDE;
  return isBackFacing(box, cluster.cone) ? EYE_FATE_BACK_FACING : EYE_FATE_VISIBLE;
}
