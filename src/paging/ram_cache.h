// Decoded groups in RAM: waiting for the GPU, or kept so that their return needs no disk. Least recently used go first.
// Owner thread: render.
#pragma once

#include <list>
#include <unordered_map>

#include "paging/chunk_loader.h"

namespace eye {

class RamCache {
 public:
  void insert(ChunkGroup group);                 // as most recently used
  const ChunkGroup* use(const TileKey& parent);  // marks it most recently used; null where it is not here
  void trim(uint64_t budgetBytes);               // drops until bytes() <= budgetBytes
  uint64_t bytes() const { return bytes_; }
  uint64_t chunksBeside(const TerrainCache& cache) const;  // chunks in groups that are not resident

 private:
  struct Entry {
    ChunkGroup group;
    uint64_t bytes;
  };
  std::list<Entry> entries_;  // most recently used first
  std::unordered_map<TileKey, std::list<Entry>::iterator> entryOf_;
  uint64_t bytes_ = 0;
};

}  // namespace eye
