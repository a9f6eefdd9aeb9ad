// What is resident, as the render thread sees it: a forest of chunks under the eight roots, each with its place on the GPU.
// Owner thread: render.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "terrain/chunk.h"
#include "terrain/database.h"

namespace eye {

// A chunk ready for the GPU: decoded, skirts appended, mip chain made. Made by the paging thread.
struct LoadedChunk {
  ChunkMeta meta;
  ChunkMesh mesh;                         // surface first, skirts behind
  uint32_t surfaceIndexCount = 0;
  std::array<SkirtRange, 4> skirts{};     // by Side
  std::vector<uint8_t> texels;            // RGBA8 mip chain; empty where the chunk shows an ancestor's imagery
  size_t bytes() const;
};

// The renderer's side of residency. Handles are small integers that the renderer gives out; none is ever reused before
// the frame that last drew it is finished (with one frame in flight: before the next exchange).
struct GpuChunk {
  uint32_t vertexOffset = 0, firstIndex = 0;  // into the renderer's pools
  uint32_t vertexCount = 0, indexCount = 0;
  int32_t textureLayer = -1;                  // -1: none of its own
};
class GpuStore {
 public:
  virtual ~GpuStore() = default;
  // Queues the upload for the next frame; nothing where the pools (the hard budget) have no room.
  virtual std::optional<GpuChunk> upload(const LoadedChunk& chunk) = 0;
  virtual void release(const GpuChunk& chunk) = 0;
  virtual uint64_t bytesResident() const = 0;
};

// A node of the forest. Children are resident all together or not at all.
struct CacheNode {
  ChunkMeta meta;
  GpuChunk gpu;
  std::array<SkirtRange, 4> skirts{};
  uint32_t surfaceIndexCount = 0;
  uint32_t parent = kNoNode;
  uint32_t firstChild = kNoNode;  // children lie behind one another
  uint32_t textureNode = kNoNode; // itself or the nearest ancestor with imagery
  uint64_t usedFrame = 0;         // last frame that visited it
  static constexpr uint32_t kNoNode = ~uint32_t{0};
};

class TerrainCache {
 public:
  const CacheNode& node(uint32_t index) const;
  CacheNode& node(uint32_t index);
  std::span<const uint32_t> roots() const;
  std::optional<uint32_t> find(const TileKey& key) const;
  uint64_t frame() const;  // counts calls of beginFrame
  void beginFrame();
  // ... insertion and eviction are the pager's.
};

}  // namespace eye
