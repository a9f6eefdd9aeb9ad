#include "paging/ram_cache.h"

namespace eye {

void RamCache::insert(ChunkGroup group) {
  if (entryOf_.contains(group.parent)) return;
  const uint64_t bytes = group.bytes();
  const TileKey parent = group.parent;
  entries_.push_front({std::move(group), bytes});
  entryOf_[parent] = entries_.begin();
  bytes_ += bytes;
}

const ChunkGroup* RamCache::use(const TileKey& parent) {
  const auto found = entryOf_.find(parent);
  if (found == entryOf_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return &found->second->group;
}

void RamCache::trim(uint64_t budgetBytes) {
  while (bytes_ > budgetBytes) {
    const Entry& last = entries_.back();
    bytes_ -= last.bytes;
    entryOf_.erase(last.group.parent);
    entries_.pop_back();
  }
}

uint64_t RamCache::chunksBeside(const TerrainCache& cache) const {
  uint64_t chunks = 0;
  for (const Entry& entry : entries_) {
    if (!cache.find(entry.group.chunks.front().meta.key)) chunks += entry.group.chunks.size();
  }
  return chunks;
}

}  // namespace eye
