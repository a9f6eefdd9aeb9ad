#include "paging/residency.h"

#include <algorithm>

namespace eye {
namespace {

// Inside the region a group makes room only for one that is needed this much sooner: between near equals the next plan
// may say the opposite.
constexpr double kClearlyLaterS = 1;

}  // namespace

ResidentChunk residentFrom(const LoadedChunk& chunk, const GpuChunk& gpu) {
  return {chunk.meta, gpu, chunk.skirts, chunk.surfaceIndexCount, chunk.longestEdgeM};
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

// Whether the group's going gives any of what is short, or opens the way to one above it that does and has fallen out
// of use as well.
bool Residency::helps(uint32_t parent) const {
  const auto gives = [this](const CacheNode& member) { return gpu_.wouldHelp(member.gpu); };
  for (;;) {
    if (std::ranges::any_of(cache_.children(parent), gives)) return true;
    const CacheNode& above = cache_.node(parent);
    if (above.parent == CacheNode::kNoNode || above.usedFrame >= rule_.usedBefore) return false;
    parent = above.parent;
  }
}

std::optional<size_t> Residency::nextToGo(double neededAtS) {
  // Again when something has gone: its parent may be a leaf now.
  if (!isListed_) cache_.evictableGroups(rule_, evictable_);
  isListed_ = true;
  for (size_t i = 0; i < evictable_.size() && evictable_[i].neededAtS > neededAtS + kClearlyLaterS; ++i)
    if (helps(evictable_[i].parent)) return i;
  return std::nullopt;
}

bool Residency::canEvict(double neededAtS) {
  return nextToGo(neededAtS).has_value();
}

double Residency::spareShare() const {
  const size_t groups = cache_.groupCount();
  return groups == 0 ? 1
                     : static_cast<double>(cache_.groupsUnusedSince(rule_.usedBefore)) / static_cast<double>(groups);
}

bool Residency::evictOne(double neededAtS) {
  const std::optional<size_t> next = nextToGo(neededAtS);
  if (!next) return false;
  const uint32_t parent = evictable_[*next].parent;
  for (const CacheNode& child : cache_.children(parent)) {
    gpu_.release(child.gpu);
    ++counts_.evicted;
  }
  onEvicted_(cache_.node(parent).meta.key);
  cache_.removeChildren(parent);
  isListed_ = false;
  return true;
}

// There is room for all of it.
std::vector<ResidentChunk> Residency::upload(const ChunkGroup& group) {
  std::vector<ResidentChunk> uploaded;
  for (const LoadedChunk& chunk : group.chunks) {
    const std::optional<GpuChunk> place = gpu_.upload(chunk);
    if (!place) break;
    uploaded.push_back(residentFrom(chunk, *place));
  }
  if (uploaded.size() == group.chunks.size()) return uploaded;
  for (const ResidentChunk& done : uploaded) gpu_.release(done.gpu);  // larger than the staging memory
  return {};
}

bool Residency::takeIn(const ChunkGroup& group, double neededAtS) {
  while (!gpu_.hasRoomFor(group.chunks)) {
    // What goes must not be the group that holds the parent: that is in use for what comes under it.
    if (evictOne(neededAtS) && cache_.find(group.parent)) continue;
    ++counts_.refused;
    return false;
  }
  const std::vector<ResidentChunk> uploaded = upload(group);
  if (uploaded.empty()) {
    ++counts_.refused;
    return false;
  }
  const uint32_t parent = *cache_.find(group.parent);
  cache_.insertChildren(parent, uploaded);
  const uint32_t first = cache_.node(parent).firstChild;
  for (uint32_t i = first; i < first + uploaded.size(); ++i) {
    CacheNode& child = cache_.node(i);
    child.plan = rule_.plan;
    child.scheduledFrame = cache_.frame();
    child.neededAtS = neededAtS;
  }
  counts_.loaded += uploaded.size();
  isListed_ = false;
  return true;
}

}  // namespace eye
