#include "render/host_cull.h"

#include <algorithm>

#include "shared/cull.h"

namespace eye {
namespace {

using namespace shader;

// Behind the farthest depth of the rectangle's footprint. What shows is mostly told by the first row of texels.
bool isOccluded(const CullParams& params, std::span<const float> pyramid, const MapRect& rect) {
  if (!rect.isKnown) return false;
  const int level = levelOf(rect);
  const glm::ivec2 low = texelAt(rect.low, level), high = texelAt(rect.high, level);
  const int width = levelSize(params.mapPx, level).x;
  const float* texels = pyramid.data() + params.levelOffset[level];
  for (int y = low.y; y <= high.y; ++y) {
    const float* row = texels + static_cast<std::ptrdiff_t>(y) * width;
    if (rect.nearest >= *std::min_element(row + low.x, row + high.x + 1)) return false;
  }
  return true;
}

// The commands, chunk by chunk.
class DrawPacker {
 public:
  DrawPacker(const HostCull& cull, size_t packedCount) : cull_(cull), count_(packedCount) {}

  // For each candidate in turn, drawn or not.
  void put(size_t i, bool isDrawn) {
    cull_.commands[i] = {};
    if (!isDrawn) return;
    const CullCandidate& candidate = cull_.candidates[i];
    const ClusterRecord& cluster = cull_.clusters[candidate.cluster];
    if (first_ == kNone || cull_.candidates[first_].chunk != candidate.chunk) {
      const CullChunk& chunk = cull_.chunks[candidate.chunk];
      cull_.commands[i] = {0, 1, static_cast<uint32_t>(count_), chunk.vertexOffset, chunk.draw};
      first_ = i;
    }
    std::ranges::copy(cull_.indices.subspan(cluster.firstIndex, cluster.indexCount),
                      cull_.packed.subspan(count_).begin());
    count_ += cluster.indexCount;
    cull_.commands[first_].indexCount += cluster.indexCount;
  }
  size_t count() const { return count_; }

 private:
  static constexpr size_t kNone = ~size_t{0};

  const HostCull& cull_;
  size_t count_;          // indices packed
  size_t first_ = kNone;  // that is drawn of the chunk at hand
};

}  // namespace

size_t cullEarly(const HostCull& cull) {
  DrawPacker packer(cull, 0);
  for (size_t i = 0; i < cull.candidates.size(); ++i) {
    const CullCandidate& candidate = cull.candidates[i];
    const ClusterRecord& cluster = cull.clusters[candidate.cluster];
    bool isDrawn = cull.visible[candidate.cluster] != 0;
    if (isDrawn && cull.params.isFrozen == 0) {
      const CullBox box = boxOf(cull.chunks[candidate.chunk], cluster);
      isDrawn = fateInView(cull.params, box, clipBoxOf(cull.params, box), cluster.cone) == EYE_FATE_VISIBLE;
    }
    packer.put(i, isDrawn);
    cull.fates[i] = (isDrawn ? EYE_FATE_EARLY : 0u) | (cluster.indexCount / 3u << EYE_FATE_BITS);
  }
  return packer.count();
}

void cullLate(const HostCull& cull, std::span<const float> pyramid, size_t earlyIndices) {
  DrawPacker packer(cull, earlyIndices);
  for (size_t i = 0; i < cull.candidates.size(); ++i) {
    const CullCandidate& candidate = cull.candidates[i];
    const ClusterRecord& cluster = cull.clusters[candidate.cluster];
    const CullBox box = boxOf(cull.chunks[candidate.chunk], cluster);
    const ClipBox clip = clipBoxOf(cull.params, box);
    uint32_t fate = fateInView(cull.params, box, clip, cluster.cone);
    if (fate == EYE_FATE_VISIBLE && isOccluded(cull.params, pyramid, mapRectOf(cull.params, clip)))
      fate = EYE_FATE_OCCLUDED;
    const uint32_t wasDrawn = cull.fates[i] & EYE_FATE_EARLY;
    const bool isDrawn = fate == EYE_FATE_VISIBLE && wasDrawn == 0;
    packer.put(i, isDrawn);
    cull.visible[candidate.cluster] = fate == EYE_FATE_VISIBLE ? 1 : 0;
    cull.fates[i] =
        fate | wasDrawn | (isDrawn ? uint32_t{EYE_FATE_LATE} : 0u) | (cluster.indexCount / 3u << EYE_FATE_BITS);
  }
}

}  // namespace eye
