// The decisions of cull_early.comp and cull_late.comp by plain code, for devices that are a CPU: the same fates and the
// same clusters drawn, at a twentieth of what lavapipe takes for the shaders. Most of that is what lanes of a shader
// must do and a loop need not: go on when a visible texel is found, compute what only a neighbour asks for.
//
// Of a cluster that shows only those triangles are drawn that do (triangle_cull.h), which shaders do not look into.
//
// The indices of what is drawn of a chunk are packed behind one another, so that it is one draw, for each band of the
// picture in which they may show.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/bands.h"
#include "render/triangle_cull.h"
#include "shared/cull_types.h"

namespace eye {

// What a band draws.
struct BandDraws {
  std::span<shader::DrawCommand> commands;  // one for each candidate: the first drawn one's of a chunk draws all that
                                            // are, the others nothing
  std::span<uint16_t> packed;               // indices that they draw; room for every candidate's
};

// Of one frame, each as shaders/shared/cull_buffers.h has it.
struct HostCull {
  const shader::CullParams& params;
  std::span<const shader::CullChunk> chunks;
  std::span<const shader::CullCandidate> candidates;
  std::span<const shader::ClusterRecord> clusters;  // the resident ones
  std::span<uint32_t> visible;                      // of them
  std::span<const uint16_t> indices;                // of the resident chunks
  std::span<const ChunkVertex> vertices;            // of these
  std::span<const VertexFrame> frames;              // one for each chunk
  std::span<TriangleBits> visibleTriangles;         // of each resident cluster that is visible
  std::span<uint32_t> fates;                        // one for each candidate
  std::span<const BandDraws> bands;
  const BandTest& bandTest;

  std::span<const uint16_t> indicesOf(uint32_t cluster) const {
    return indices.subspan(clusters[cluster].firstIndex, clusters[cluster].indexCount);
  }
  std::span<const ChunkVertex> verticesOf(uint32_t chunk) const {
    return vertices.subspan(static_cast<size_t>(chunks[chunk].vertexOffset), frames[chunk].count);
  }
};

// Of the surfaces.
struct TriangleCounts {
  uint64_t drawn = 0;
  uint64_t spared = 0;  // one by one, in clusters that show
};

// Commands for what was visible in the last frame and is in view; fates: EYE_FATE_EARLY where it is drawn. Returns how
// many indices are packed for each band.
std::vector<size_t> cullEarly(const HostCull& cull, TriangleCounts& counts);
// Commands for what shows and was not drawn early, packed behind the early ones' indices; all fates; visibility for the
// next frame. EYE_FATE_LATE: none of the cluster was drawn early.
void cullLate(const HostCull& cull, std::span<const float> pyramid, TriangleCull& triangles,
              std::span<const size_t> earlyIndices, TriangleCounts& counts);

}  // namespace eye
