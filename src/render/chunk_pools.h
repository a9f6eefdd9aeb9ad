// Where chunks live on the GPU: one buffer of vertices, one of indices, one of clusters, one array of textures, all
// made at start with the budget split between them, so that the budget cannot be exceeded and no frame allocates. Owner
// thread: render.
#pragma once

#include <optional>
#include <vector>

#include "gpu/barrier.h"
#include "paging/terrain_cache.h"
#include "render/range_allocator.h"
#include "shared/cull_types.h"

namespace eye {

struct PoolPlan {
  uint32_t layers = 0, vertices = 0, indices = 0, clusters = 0;
  bool operator==(const PoolPlan&) const = default;
};

// Splits a budget. `layerBytes`: a texture with its mip chain. Nothing where the budget holds less than a view needs.
std::optional<PoolPlan> planPools(uint64_t budgetBytes, uint64_t layerBytes, uint32_t maxLayers);

class ChunkPools {
 public:
  // `cullsOnHost`: indices, clusters and their visibility are mapped, the latter two written at once. usage: the budget
  // is too small (says how much it needs). Throws vk::SystemError. The first device does the uploads.
  static Result<std::unique_ptr<ChunkPools>> create(GpuDevices gpus, uint64_t budgetBytes, int textureSize,
                                                    bool cullsOnHost);

  // As GpuStore says.
  bool hasRoomFor(std::span<const LoadedChunk> chunks);
  bool wouldHelp(const GpuChunk& chunk) const { return !onlyLayersShort_ || chunk.textureLayer >= 0; }
  // Copies into staging memory; on the GPU with the next recordUploads. Nothing that is drawn may be in flight.
  std::optional<GpuChunk> upload(const LoadedChunk& chunk);
  void release(const GpuChunk& chunk);
  uint64_t bytesResident() const;

  // Call once a frame, outside a render pass; afterwards the staging memory is in use until staged() is called.
  void recordUploads(const vk::raii::CommandBuffer& commands);
  // The same at once, where other devices are to see it.
  void flush();
  // The commands of the last recordUploads are finished.
  void staged();

  // By device.
  const GpuBuffer& vertexBuffer(size_t device = 0) const { return vertexBuffers_[device]; }
  const GpuBuffer& indexBuffer(size_t device = 0) const { return indexBuffers_[device]; }
  const GpuImage& textures(size_t device = 0) const { return textures_[device]; }
  const GpuBuffer& clusterBuffer() const { return clusterBuffer_; }
  uint32_t clusterCapacity() const { return clusters_.capacity(); }
  // A word for each cluster: not 0 where the last late pass found it visible. 0 for a chunk that has just come.
  const GpuBuffer& visibleBuffer() const { return visibleBuffer_; }

 private:
  ChunkPools(GpuDevices gpus, const PoolPlan& plan, std::vector<GpuImage> textures, int textureSize, bool cullsOnHost);
  std::optional<GpuChunk> allocate(const LoadedChunk& chunk);
  void giveBack(const GpuChunk& chunk);
  bool isPending(const GpuChunk& chunk) const;
  void putClusters(std::span<const ChunkCluster> clusters, const GpuChunk& made);
  uint64_t stage(const void* data, size_t bytes);

  const GpuDevice& gpu_;
  int textureSize_;
  uint64_t chainBytes_;  // of one texture as it is uploaded
  RangeAllocator vertices_, indices_, clusters_, layers_;
  std::vector<GpuBuffer> vertexBuffers_, indexBuffers_;
  GpuBuffer clusterBuffer_, visibleBuffer_, staging_;
  std::vector<GpuImage> textures_;
  uint64_t stagedBytes_ = 0;
  bool onlyLayersShort_ = false;  // in the last allocation that failed
  std::vector<vk::BufferCopy> vertexCopies_, indexCopies_, clusterCopies_;
  std::vector<shader::ClusterRecord> records_;  // of the chunk at hand
  std::vector<vk::BufferImageCopy> textureCopies_;
};

}  // namespace eye
