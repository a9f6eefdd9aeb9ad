#include "render/host_cull.h"

#include <algorithm>

#include "shared/cull.h"

namespace eye {
namespace {

using namespace shader;

// What can be told without the depth map.
uint32_t fateInView(const CullParams& params, const CullBox& box, const ClipBox& clip, const ClusterRecord& cluster) {
  if (isOutsideFrustum(params, clip)) return EYE_FATE_OUTSIDE;
  return isBackFacing(box, cluster.cone) ? EYE_FATE_BACK_FACING : EYE_FATE_VISIBLE;
}

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

// Clusters of a chunk that are drawn and lie behind one another become one draw: the command of the first of them has
// the indices of all.
class Runs {
 public:
  explicit Runs(const HostCull& cull) : cull_(cull) {}

  // For each candidate in turn.
  void put(size_t i, bool isDrawn) {
    cull_.commands[i] = {};
    if (!isDrawn) {
      isOpen_ = false;
      return;
    }
    const CullCandidate& candidate = cull_.candidates[i];
    const ClusterRecord& cluster = cull_.clusters[candidate.cluster];
    if (isOpen_ && cull_.candidates[first_].chunk == candidate.chunk) {
      cull_.commands[first_].indexCount += cluster.indexCount;
      return;
    }
    const CullChunk& chunk = cull_.chunks[candidate.chunk];
    cull_.commands[i] = {cluster.indexCount, 1, cluster.firstIndex, chunk.vertexOffset, chunk.draw};
    isOpen_ = true;
    first_ = i;
  }

 private:
  const HostCull& cull_;
  bool isOpen_ = false;  // the candidate before is drawn
  size_t first_ = 0;     // of its run
};

}  // namespace

void cullEarly(const HostCull& cull) {
  Runs runs(cull);
  for (size_t i = 0; i < cull.candidates.size(); ++i) {
    const CullCandidate& candidate = cull.candidates[i];
    const ClusterRecord& cluster = cull.clusters[candidate.cluster];
    bool isDrawn = cull.visible[candidate.cluster] != 0;
    if (isDrawn && cull.params.isFrozen == 0) {
      const CullBox box = boxOf(cull.chunks[candidate.chunk], cluster);
      isDrawn = fateInView(cull.params, box, clipBoxOf(cull.params, box), cluster) == EYE_FATE_VISIBLE;
    }
    runs.put(i, isDrawn);
    cull.fates[i] = (isDrawn ? EYE_FATE_EARLY : 0u) | (cluster.indexCount / 3u << EYE_FATE_BITS);
  }
}

void cullLate(const HostCull& cull, std::span<const float> pyramid) {
  Runs runs(cull);
  for (size_t i = 0; i < cull.candidates.size(); ++i) {
    const CullCandidate& candidate = cull.candidates[i];
    const ClusterRecord& cluster = cull.clusters[candidate.cluster];
    const CullBox box = boxOf(cull.chunks[candidate.chunk], cluster);
    const ClipBox clip = clipBoxOf(cull.params, box);
    uint32_t fate = fateInView(cull.params, box, clip, cluster);
    if (fate == EYE_FATE_VISIBLE && isOccluded(cull.params, pyramid, mapRectOf(cull.params, clip)))
      fate = EYE_FATE_OCCLUDED;
    const uint32_t wasDrawn = cull.fates[i] & EYE_FATE_EARLY;
    const bool isDrawn = fate == EYE_FATE_VISIBLE && wasDrawn == 0;
    runs.put(i, isDrawn);
    cull.visible[candidate.cluster] = fate == EYE_FATE_VISIBLE ? 1 : 0;
    cull.fates[i] =
        fate | wasDrawn | (isDrawn ? uint32_t{EYE_FATE_LATE} : 0u) | (cluster.indexCount / 3u << EYE_FATE_BITS);
  }
}

}  // namespace eye
