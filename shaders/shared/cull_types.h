// Structs of the culling passes that C++ writes and shaders read. Scalar layout.
#ifndef EYE_SHADERS_CULL_TYPES_H
#define EYE_SHADERS_CULL_TYPES_H

#include "shared/config.h"

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
namespace eye::shader {
using glm::ivec2;
using glm::vec2;
using glm::vec3;
using uint = uint32_t;
#endif

// A cluster of a resident chunk: a run of the index pool and bounds, see ChunkCluster for how they are quantised.
struct ClusterRecord {
  uint firstIndex, indexCount;
  uint boxMinXY, boxMinZMaxX, boxMaxYZ;  // 16 bits each, the first named one low
  uint cone;                             // 8 bits each, signed: axis x, y, z, cutoff
};

// A chunk drawn in this frame: its oriented box, relative to the eye, axes of half length.
struct CullChunk {
  vec3 centre_ecef;
  int vertexOffset;
  vec3 axisX_ecef;
  uint draw;  // which DrawData
  vec3 axisY_ecef;
  uint unused0;
  vec3 axisZ_ecef;
  uint unused1;
};

// A cluster that may be drawn in this frame.
struct CullCandidate {
  uint cluster;  // of the resident ones
  uint chunk;    // of the drawn ones
};

// VkDrawIndexedIndirectCommand.
struct DrawCommand {
  uint indexCount, instanceCount, firstIndex;
  int vertexOffset;
  uint firstInstance;
};

// Read from a storage buffer, never a uniform one: lavapipe compiles a shader anew for each value of a uniform that
// steers a branch or a loop.
struct CullParams {
  vec3 clipX_ecef, clipY_ecef, clipW_ecef;  // rows of clipFromEcef; w is the distance along the view's axis
  float nearM;
  ivec2 picturePx, mapPx;
  uint candidateCount;
  uint isFrozen;  // not 0: draw what the last late pass found visible, test nothing
  int levelCount;
  int levelOffset[EYE_MAX_DEPTH_LEVELS];  // into the pyramid's floats
};

// Push constants of the depth pyramid's passes: the level to make and what it is made from, a finer one or the picture.
// They steer no branch by themselves, so lavapipe compiles nothing anew.
struct DepthLevel {
  ivec2 size, finerSize;
  int offset, finerOffset;  // into the pyramid's floats
};

// Push constants of the view of the depth pyramid: the level shown and where on the picture.
struct DepthViewLevel {
  vec2 cornerPx, texelsPerPx;
  ivec2 size;
  int offset;  // into the pyramid's floats
  float nearM;
};

#ifdef __cplusplus
static_assert(sizeof(DepthLevel) == 24 && sizeof(DepthViewLevel) == 32);
static_assert(sizeof(ClusterRecord) == 24 && sizeof(CullChunk) == 64 && sizeof(CullCandidate) == 8);
static_assert(sizeof(DrawCommand) == 20 && offsetof(DrawCommand, firstInstance) == 16);
static_assert(sizeof(CullParams) == 36 + 4 + 16 + 12 + 4 * EYE_MAX_DEPTH_LEVELS);
}  // namespace eye::shader
#endif

#endif
