#include "paging/residency.h"

#include <limits>

namespace eye {
namespace {

// Inside the region a group makes room only for one that is needed this much sooner: between near equals the next plan
// may say the opposite.
constexpr double kClearlyLaterS = 1;

}  // namespace

ResidentChunk residentFrom(const LoadedChunk& chunk, const GpuChunk& gpu) {
  return {chunk.meta, gpu, chunk.skirts, chunk.surfaceIndexCount};
}

Residency::Residency(GpuStore& gpu, std::function<void(const TileKey&)> onEvicted)
    : gpu_(gpu), onEvicted_(std::move(onEvicted)) {}

Residency::~Residency() {
  for (uint32_t root : cache_.roots()) {
    std::vector<uint32_t> parents{root};
    while (!parents.empty()) {
      const uint32_t node = parents.back();
      parents.pop_back();
      gpu_.release(cache_.node(node).gpu);
      const uint32_t first = cache_.node(node).firstChild;
      for (uint32_t i = 0; i < cache_.children(node).size(); ++i) parents.push_back(first + i);
    }
  }
}

void Residency::begin(const EvictionRule& rule) {
  rule_ = rule;
  isListed_ = false;
}

bool Residency::canEvict(double neededAtS) {
  if (!isListed_ || next_ == evictable_.size()) {  // again at the end: parents of what has gone may be leaves now
    cache_.evictableGroups(rule_, evictable_);
    next_ = 0;
    isListed_ = true;
  }
  return next_ < evictable_.size() && evictable_[next_].neededAtS > neededAtS + kClearlyLaterS;
}

double Residency::evictableShare() {
  canEvict(-std::numeric_limits<double>::infinity());
  const size_t groups = cache_.groupCount();
  return groups == 0 ? 1 : static_cast<double>(evictable_.size() - next_) / static_cast<double>(groups);
}

bool Residency::evictOne(double neededAtS) {
  if (!canEvict(neededAtS)) return false;
  const uint32_t parent = evictable_[next_++].parent;
  for (const CacheNode& child : cache_.children(parent)) {
    gpu_.release(child.gpu);
    ++counts_.evicted;
  }
  onEvicted_(cache_.node(parent).meta.key);
  cache_.removeChildren(parent);
  return true;
}

std::optional<std::vector<ResidentChunk>> Residency::upload(const ChunkGroup& group) {
  std::vector<ResidentChunk> uploaded;
  for (const LoadedChunk& chunk : group.chunks) {
    const std::optional<GpuChunk> place = gpu_.upload(chunk);
    if (!place) {
      for (const ResidentChunk& done : uploaded) gpu_.release(done.gpu);
      return std::nullopt;
    }
    uploaded.push_back(residentFrom(chunk, *place));
  }
  return uploaded;
}

bool Residency::takeIn(const ChunkGroup& group, double neededAtS) {
  for (;;) {
    if (const auto uploaded = upload(group)) {
      const uint32_t parent = *cache_.find(group.parent);
      cache_.insertChildren(parent, *uploaded);
      const uint32_t first = cache_.node(parent).firstChild;
      for (uint32_t i = first; i < first + uploaded->size(); ++i) {
        CacheNode& child = cache_.node(i);
        child.plan = rule_.plan;
        child.scheduledFrame = cache_.frame();
        child.neededAtS = neededAtS;
      }
      counts_.loaded += uploaded->size();
      return true;
    }
    if (evictOne(neededAtS)) continue;
    ++counts_.refused;
    return false;
  }
}

}  // namespace eye
