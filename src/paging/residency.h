// What is on the GPU: takes groups in and lets others go for them, within the store's hard budget. Owner thread:
// render.
#pragma once

#include <functional>
#include <vector>

#include "paging/chunk_loader.h"
#include "paging/terrain_cache.h"

namespace eye {

class Residency {
 public:
  // `onEvicted`: told the parent of each group that has gone.
  Residency(GpuStore& gpu, std::function<void(const TileKey&)> onEvicted);
  ~Residency();  // gives everything back
  Residency(const Residency&) = delete;
  Residency& operator=(const Residency&) = delete;

  TerrainCache& cache() { return cache_; }
  const TerrainCache& cache() const { return cache_; }
  GpuStore& gpu() const { return gpu_; }

  // Once an exchange, before the rest.
  void begin(const EvictionRule& rule);
  // Whether something may go for a group that is needed at `neededAtS`: nothing that a walk has reached of late, no
  // ancestor of anything, and inside the region only what is needed clearly later.
  // After a takeIn that failed: and that would help.
  bool canEvict(double neededAtS);
  // The group's children into the forest; false, and nothing changed but what has gone for it, where there is no room.
  // Its parent is resident, its children are not.
  bool takeIn(const ChunkGroup& group, double neededAtS);
  // Of the resident groups, the share that could go, one after the other, for something visible.
  double spareShare() const;

  struct Counts {
    uint64_t loaded = 0, evicted = 0;  // chunks
    uint64_t refused = 0;              // groups
  };
  const Counts& counts() const { return counts_; }

 private:
  std::vector<ResidentChunk> upload(const ChunkGroup& group);
  std::optional<size_t> nextToGo(double neededAtS);
  bool helps(uint32_t parent) const;
  bool evictOne(double neededAtS);

  GpuStore& gpu_;
  const std::function<void(const TileKey&)> onEvicted_;
  TerrainCache cache_;
  Counts counts_;
  EvictionRule rule_;
  std::vector<EvictableGroup> evictable_;  // made when first needed after begin()
  bool isListed_ = false;
};

ResidentChunk residentFrom(const LoadedChunk& chunk, const GpuChunk& gpu);

}  // namespace eye
