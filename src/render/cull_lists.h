// What the culling passes read and write in one frame: the drawn chunks and their clusters in, indirect commands and
// the clusters' fates out, and the depth pyramid. Owner thread: render.
#pragma once

#include "gpu/memory.h"
#include "render/chunk_pools.h"
#include "render/depth_pyramid.h"
#include "render/host_cull.h"
#include "render/renderer.h"
#include "shared/cull_types.h"

namespace eye {

class CullLists {
 public:
  // `onHost`: the CPU culls, see cullEarly and cullLate; else the shaders do, see CullPass.
  CullLists(GpuDevices gpus, bool onHost);
  // Whether buffers and dispatches for so much are within the device's limits.
  static bool fits(const GpuDevice& gpu, std::span<const ChunkDraw> draws, glm::ivec2 picturePx, glm::ivec2 mapPx);
  // Makes room; nothing may be in flight. True where a buffer was made anew: descriptors are to be written again.
  bool reserve(GpuDevices gpus, std::span<const ChunkDraw> draws, glm::ivec2 picturePx, glm::ivec2 mapPx);
  // Fills what the shaders read: every cluster of the draws is a candidate, in the draws' order, which is partByHaze's:
  // the first `byVertex` have haze by vertex.
  void write(std::span<const ChunkDraw> draws, size_t byVertex, const View& view, const glm::mat4& clipFromEcef,
             glm::ivec2 mapPx, bool frozen);
  // With onHost, before the early draws and when their depth has been copied: what else the passes of CullPass do. The
  // pools' clusters must be mapped.
  void cullEarly(const ChunkPools& pools, const BandTest& bandTest);
  void cullLate(const ChunkPools& pools, const BandTest& bandTest, bool atCentres);  // see TriangleCull
  // Of the frame that has just finished.
  CullCounts counts() const;
  bool onHost() const { return onHost_; }
  // By cluster of the pool; empty without onHost.
  std::span<const TriangleBits> visibleTriangles() const { return visibleTriangles_; }

  int longestSpanPx() const { return longestSpanPx_; }  // pixels that a texel of the map touches along an axis
  uint32_t chunkCount() const { return chunkCount_; }
  uint32_t candidateCount() const { return candidateCount_; }
  uint32_t candidatesByVertex() const { return candidatesByVertex_; }  // the first of them
  const shader::CullParams& params() const { return params_.as<shader::CullParams>()[0]; }

  // By binding, EYE_BIND_CULL_PARAMS and so on; the clusters and their visibility are the pools'.
  const GpuBuffer& paramsBuffer() const { return params_; }
  const GpuBuffer& chunksBuffer() const { return chunks_; }
  const GpuBuffer& candidatesBuffer() const { return candidates_; }
  // By device, that is by band. With onHost packedIndices() is what earlyBuffer() and lateBuffer() draw from; else that
  // is the pools'.
  const GpuBuffer& packedIndices(size_t device = 0) const { return perDevice_[device].packed; }
  const GpuBuffer& earlyBuffer(size_t device = 0) const { return perDevice_[device].early; }
  const GpuBuffer& lateBuffer(size_t device = 0) const { return perDevice_[device].late; }
  const GpuBuffer& depthBuffer(size_t device = 0) const { return depth_[device]; }
  const GpuBuffer& fatesBuffer() const { return fates_; }
  const GpuBuffer& pyramidBuffer() const { return pyramid_; }
  const GpuBuffer& pixelSpansBuffer() const { return pixelSpans_; }

 private:
  struct PerDevice {
    GpuBuffer early, late, packed;
  };

  std::vector<BandDraws> bandDraws(GpuBuffer PerDevice::*commands) const;
  HostCull hostCull(const ChunkPools& pools, std::span<const BandDraws> bands, const BandTest& bandTest);
  void writePixelSpans(glm::ivec2 picturePx, glm::ivec2 mapPx);

  bool onHost_;
  DepthPyramid hostPyramid_;
  size_t chunkCapacity_ = 0, candidateCapacity_ = 0, depthCapacity_ = 0, pyramidCapacity_ = 0, spansCapacity_ = 0,
         packedCapacity_ = 0;
  // With onHost: by chunk, by cluster of the pool, and of the frame.
  std::vector<VertexFrame> frames_;
  std::vector<TriangleBits> visibleTriangles_;
  TriangleCounts triangles_;
  std::vector<size_t> earlyIndices_;  // of the frame's early draws, by band
  uint32_t chunkCount_ = 0, candidateCount_ = 0, candidatesByVertex_ = 0;
  GpuBuffer params_, chunks_, candidates_, fates_, pyramid_, pixelSpans_;
  std::vector<GpuBuffer> depth_;  // one that all devices see
  std::vector<PerDevice> perDevice_;
  glm::ivec2 spansMapPx_{0, 0}, spansPicturePx_{0, 0};  // what pixelSpans_ is for
  int longestSpanPx_ = 0;
};

}  // namespace eye
