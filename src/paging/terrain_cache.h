// What is resident, as the render thread sees it: a forest of chunks under the eight roots, each with its place on the
// GPU. Owner thread: render.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "terrain/chunk.h"
#include "terrain/database.h"

namespace eye {

// A chunk ready for the GPU: decoded, skirts appended, mip chain made. Made by the paging thread.
struct LoadedChunk {
  ChunkMeta meta;
  ChunkMesh mesh;  // surface first, skirts behind
  uint32_t surfaceIndexCount = 0;
  std::array<SkirtRange, 4> skirts{};  // by Side
  float longestEdgeM = 0;              // of the surface's triangles
  std::vector<uint8_t> texels;         // RGBA8 mip chain; empty where the chunk shows an ancestor's imagery
  size_t bytes() const;
};

// The renderer's side of residency. Handles are small integers that the renderer gives out; none is ever reused before
// the frame that last drew it is finished (with one frame in flight: before the next exchange).
struct GpuChunk {
  uint32_t vertexOffset = 0, firstIndex = 0;  // into the renderer's pools
  uint32_t vertexCount = 0, indexCount = 0;
  uint32_t clusterOffset = 0, clusterCount = 0;
  int32_t textureLayer = -1;  // -1: none of its own
};
class GpuStore {
 public:
  virtual ~GpuStore() = default;
  // Whether all of these would fit into the pools (the hard budget) now, one upload after the other.
  virtual bool hasRoomFor(std::span<const LoadedChunk> chunks) = 0;
  // Whether the chunk's release would give any of what the last hasRoomFor that said no was short of.
  virtual bool wouldHelp(const GpuChunk& chunk) const = 0;
  // Queues the upload for the next frame; nothing where the pools have no room.
  virtual std::optional<GpuChunk> upload(const LoadedChunk& chunk) = 0;
  virtual void release(const GpuChunk& chunk) = 0;
  virtual uint64_t bytesResident() const = 0;
};

// What the last walk that reached a node did with it; none: it has only just been inserted.
enum class Visit : uint8_t { none, drawn, refined, outsideFrustum, belowHorizon };

// A node of the forest. Children are resident all together or not at all.
struct CacheNode {
  static constexpr uint32_t kNoNode = ~uint32_t{0};

  ChunkMeta meta;
  GpuChunk gpu;
  std::array<SkirtRange, 4> skirts{};
  uint32_t surfaceIndexCount = 0;
  float longestEdgeM = 0;
  uint32_t parent = kNoNode;
  uint32_t firstChild = kNoNode;   // children lie behind one another, in the order of TileKey::children
  uint32_t textureNode = kNoNode;  // itself or the nearest ancestor with imagery
  glm::vec2 textureScale{1.0f}, textureOffset{0.0f};  // from its own TileParam to textureNode's
  // By Side: the resident nodes of its own level across it, kNoNode where one is not resident; how many the grid has.
  std::array<std::array<uint32_t, 2>, 4> neighbours{};
  std::array<uint8_t, 4> neighbourCount{};
  Visit visit = Visit::none;  // of usedFrame
  uint64_t usedFrame = 0;     // last frame that visited it, at first that of its insertion
  // Of the scheduling region, the same for all members of a group: the last plan that had it, its frame, and when the
  // group is needed on the pager's clock.
  uint32_t plan = 0;
  uint64_t scheduledFrame = 0;
  double neededAtS = 0;
};

// What may be evicted, and in which order.
struct EvictionRule {
  uint64_t usedBefore = 0;        // no walk has reached it since
  uint32_t plan = 0;              // the plan in force
  double framesPerInterval = 60;  // k t of equation (12)
};
struct EvictableGroup {
  uint32_t parent = 0;
  double p = 0;          // equation (12)
  double neededAtS = 0;  // infinite where no plan has it
};

// A chunk that is on the GPU and about to join the forest.
struct ResidentChunk {
  ChunkMeta meta;
  GpuChunk gpu;
  std::array<SkirtRange, 4> skirts{};
  uint32_t surfaceIndexCount = 0;
  float longestEdgeM = 0;
};

class TerrainCache {
 public:
  const CacheNode& node(uint32_t index) const { return nodes_[index]; }
  CacheNode& node(uint32_t index) { return nodes_[index]; }
  std::span<const uint32_t> roots() const { return roots_; }
  std::optional<uint32_t> find(const TileKey& key) const;
  uint64_t frame() const { return frame_; }  // counts calls of beginFrame
  void beginFrame() { ++frame_; }            // before each selectChunks; a walk that starts again has one of its own
  size_t size() const { return indexOf_.size(); }
  size_t groupCount() const { return groupParents_.size() - freeGroups_.size() - roots_.size() / kSlots; }

  // Insertion and eviction are the pager's. Indices of other nodes stay valid, references do not.
  // The eight roots in the order of their octants, once, all with imagery.
  void insertRoots(std::span<const ResidentChunk> roots);
  // All children of a node that has none resident, in the order of TileKey::children.
  void insertChildren(uint32_t parent, std::span<const ResidentChunk> children);
  void removeChildren(uint32_t parent);  // which have no children themselves
  // Groups whose members are all childless and that no walk from `rule.usedBefore` on has reached. First those outside
  // the region, by p = f + k t l (paper 000, equation 12; f: the last frame that used or scheduled it, l: 0 for the
  // finest level), so that of one age the finer goes first; then those inside, the last to be needed first.
  void evictableGroups(const EvictionRule& rule, std::vector<EvictableGroup>& groups) const;
  // How many groups no walk from that frame on has reached, whether or not they have children.
  size_t groupsUnusedSince(uint64_t usedBefore) const;
  // Resident children of a node: empty or three or four, behind one another.
  std::span<const CacheNode> children(uint32_t parent) const;

 private:
  uint32_t takeSlots();  // of four nodes
  void place(uint32_t index, uint32_t parent, const ResidentChunk& chunk);
  void link(uint32_t index);
  void unlink(uint32_t index);

  static constexpr uint32_t kSlots = 4;  // nodes are given out in fours: a group's slots lie behind one another

  std::vector<CacheNode> nodes_;
  std::vector<uint32_t> groupParents_;  // of slots 4 i to 4 i + 3; kNoNode: roots or free
  std::vector<uint32_t> freeGroups_;
  std::vector<uint32_t> roots_;
  std::unordered_map<TileKey, uint32_t> indexOf_;
  uint64_t frame_ = 0;
};

}  // namespace eye
