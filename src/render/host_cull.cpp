#include "render/host_cull.h"

#include <algorithm>
#include <bit>
#include <optional>

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

// The commands of a band, chunk by chunk.
class DrawPacker {
 public:
  DrawPacker(const HostCull& cull, const BandDraws& draws, size_t packedCount)
      : cull_(cull), draws_(draws), count_(packedCount) {}

  // For each candidate in turn: which of its triangles are drawn.
  void put(size_t i, TriangleBits triangles) {
    draws_.commands[i] = {};
    if (triangles == 0) return;
    const CullCandidate& candidate = cull_.candidates[i];
    if (first_ == kNone || cull_.candidates[first_].chunk != candidate.chunk) {
      const CullChunk& chunk = cull_.chunks[candidate.chunk];
      draws_.commands[i] = {0, 1, static_cast<uint32_t>(count_), chunk.vertexOffset, chunk.draw};
      first_ = i;
    }
    const size_t before = count_;
    const auto indices = cull_.indicesOf(candidate.cluster);
    if (triangles == kAllTriangles) {
      std::ranges::copy(indices, draws_.packed.subspan(count_).begin());
      count_ += indices.size();
    }
    for (; triangles != 0 && triangles != kAllTriangles; triangles &= triangles - 1, count_ += 3)
      std::copy_n(&indices[3 * static_cast<size_t>(std::countr_zero(triangles))], 3, &draws_.packed[count_]);
    draws_.commands[first_].indexCount += static_cast<uint32_t>(count_ - before);
  }
  size_t count() const { return count_; }

 private:
  static constexpr size_t kNone = ~size_t{0};

  const HostCull& cull_;
  const BandDraws& draws_;
  size_t count_;          // indices packed
  size_t first_ = kNone;  // that is drawn of the chunk at hand
};

// Triangles of a candidate, drawn in the bands where they may show.
void putInBands(std::span<DrawPacker> packers, size_t i, TriangleBits triangles, const BandTest& test,
                const CullBox& box) {
  const uint32_t bands = triangles != 0 ? test.bandsOf(box) : 0;
  for (size_t band = 0; band < packers.size(); ++band) packers[band].put(i, (bands >> band & 1) != 0 ? triangles : 0);
}

uint64_t countOf(TriangleBits triangles, const ClusterRecord& cluster) {
  return triangles == kAllTriangles ? cluster.indexCount / 3 : static_cast<uint64_t>(std::popcount(triangles));
}

}  // namespace

std::vector<size_t> cullEarly(const HostCull& cull, TriangleCounts& counts) {
  std::vector<DrawPacker> packers;
  for (const BandDraws& draws : cull.bands) packers.emplace_back(cull, draws, 0);
  for (size_t i = 0; i < cull.candidates.size(); ++i) {
    const CullCandidate& candidate = cull.candidates[i];
    const ClusterRecord& cluster = cull.clusters[candidate.cluster];
    bool isDrawn = cull.visible[candidate.cluster] != 0;
    CullBox box{};
    if (isDrawn) box = boxOf(cull.chunks[candidate.chunk], cluster);
    if (isDrawn && cull.params.isFrozen == 0)
      isDrawn = fateInView(cull.params, box, clipBoxOf(cull.params, box), cluster.cone) == EYE_FATE_VISIBLE;
    const TriangleBits triangles = isDrawn ? cull.visibleTriangles[candidate.cluster] : 0;
    putInBands(packers, i, triangles, cull.bandTest, box);
    counts.drawn += countOf(triangles, cluster);
    cull.fates[i] = (isDrawn ? EYE_FATE_EARLY : 0u) | (cluster.indexCount / 3u << EYE_FATE_BITS);
  }
  std::vector<size_t> packed;
  for (const DrawPacker& packer : packers) packed.push_back(packer.count());
  return packed;
}

void cullLate(const HostCull& cull, std::span<const float> pyramid, TriangleCull& triangles,
              std::span<const size_t> earlyIndices, TriangleCounts& counts) {
  std::vector<DrawPacker> packers;
  for (size_t band = 0; band < cull.bands.size(); ++band)
    packers.emplace_back(cull, cull.bands[band], earlyIndices[band]);
  std::optional<uint32_t> placed;  // the chunk whose vertices are projected
  for (size_t i = 0; i < cull.candidates.size(); ++i) {
    const auto [number, chunk] = cull.candidates[i];
    const ClusterRecord& cluster = cull.clusters[number];
    const CullBox box = boxOf(cull.chunks[chunk], cluster);
    const ClipBox clip = clipBoxOf(cull.params, box);
    uint32_t fate = fateInView(cull.params, box, clip, cluster.cone);
    if (fate == EYE_FATE_VISIBLE && isOccluded(cull.params, pyramid, mapRectOf(cull.params, clip)))
      fate = EYE_FATE_OCCLUDED;
    const uint32_t wasDrawn = cull.fates[i] & EYE_FATE_EARLY;
    TriangleBits late = 0;
    if (fate == EYE_FATE_VISIBLE) {
      if (placed != chunk) triangles.place(cull.frames[chunk], cull.verticesOf(chunk));
      placed = chunk;
      const TriangleFates found = triangles.fatesOf(cull.indicesOf(number));
      TriangleBits& visible = cull.visibleTriangles[number];
      late = found.visible & ~(wasDrawn != 0 ? visible : 0);
      visible = found.visible;
      counts.drawn += countOf(late, cluster);
      counts.spared += cluster.indexCount / 3 - countOf(found.visible, cluster);
    }
    putInBands(packers, i, late, cull.bandTest, box);
    cull.visible[number] = fate == EYE_FATE_VISIBLE ? 1 : 0;
    const bool isNew = fate == EYE_FATE_VISIBLE && wasDrawn == 0;
    cull.fates[i] =
        fate | wasDrawn | (isNew ? uint32_t{EYE_FATE_LATE} : 0u) | (cluster.indexCount / 3u << EYE_FATE_BITS);
  }
}

}  // namespace eye
