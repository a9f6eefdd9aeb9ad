#include "render/cull_mirror.h"

#include <algorithm>

#include "shared/cull.h"

namespace eye::test {
namespace {

using namespace eye::shader;

std::vector<float> pyramidOf(const CullReadBack& gpu) {
  const CullParams& p = gpu.params;
  std::vector<float> pyramid(gpu.pyramid.size(), -1.0f);
  const auto at = [&](int level, int x, int y) -> float& {
    return pyramid[static_cast<size_t>(p.levelOffset[level] + y * levelSize(p.mapPx, level).x + x)];
  };
  const auto farthestOf = [](ivec2 columns, ivec2 rows, const auto& value) {
    float farthest = 1.0f;
    for (int y = rows.x; y <= rows.y; ++y)
      for (int x = columns.x; x <= columns.y; ++x) farthest = std::min(farthest, value(x, y));
    return farthest;
  };
  for (int level = 0; level < p.levelCount; ++level) {
    const ivec2 size = levelSize(p.mapPx, level), finer = levelSize(p.mapPx, std::max(0, level - 1));
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        at(level, x, y) =
            level == 0
                ? farthestOf(pixelSpan(x, p.mapPx.x, p.picturePx.x), pixelSpan(y, p.mapPx.y, p.picturePx.y),
                             [&](int px, int py) { return gpu.depth[static_cast<size_t>(py * p.picturePx.x + px)]; })
                : farthestOf({2 * x, std::min(2 * x + 1, finer.x - 1)}, {2 * y, std::min(2 * y + 1, finer.y - 1)},
                             [&](int tx, int ty) { return at(level - 1, tx, ty); });
      }
    }
  }
  return pyramid;
}

bool isOccluded(const CullParams& p, const std::vector<float>& pyramid, const MapRect& rect) {
  if (!rect.isKnown) return false;
  const int level = levelOf(rect);
  const ivec2 low = texelAt(rect.low, level), high = texelAt(rect.high, level);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      const float farthest = pyramid[static_cast<size_t>(p.levelOffset[level] + y * levelSize(p.mapPx, level).x + x)];
      if (!(rect.nearest < farthest)) return false;
    }
  }
  return true;
}

}  // namespace

CullMirror mirrorOf(const CullReadBack& gpu) {
  CullMirror mirror;
  mirror.pyramid = pyramidOf(gpu);
  for (size_t i = 0; i < gpu.candidates.size(); ++i) {
    const CullChunk& chunk = gpu.chunks[gpu.candidates[i].chunk];
    const ClusterRecord& cluster = gpu.clusters[gpu.candidates[i].cluster];
    const CullBox box = boxOf(chunk, cluster);
    const ClipBox clip = clipBoxOf(gpu.params, box);
    uint32_t fate = EYE_FATE_VISIBLE;
    if (isOutsideFrustum(gpu.params, clip)) {
      fate = EYE_FATE_OUTSIDE;
    } else if (isBackFacing(box, cluster.cone)) {
      fate = EYE_FATE_BACK_FACING;
    } else if (isOccluded(gpu.params, mirror.pyramid, mapRectOf(gpu.params, clip))) {
      fate = EYE_FATE_OCCLUDED;
    }
    const uint32_t early = gpu.fates[i] & EYE_FATE_EARLY;
    const uint32_t late = fate == EYE_FATE_VISIBLE && early == 0 ? EYE_FATE_LATE : 0u;
    mirror.fates.push_back(fate | early | late | (cluster.indexCount / 3u << EYE_FATE_BITS));
  }
  return mirror;
}

namespace {

// Times that each candidate is drawn where commands draw from the pool: clusters that lie behind one another.
std::vector<uint32_t> drawnFromPool(const CullReadBack& gpu, const std::vector<DrawCommand>& commands) {
  std::vector<uint32_t> times(gpu.candidates.size());
  for (size_t i = 0; i < commands.size(); ++i) {
    if (commands[i].instanceCount == 0) continue;
    uint32_t next = commands[i].firstIndex, left = commands[i].indexCount;
    for (size_t k = i; left > 0; ++k) {
      const ClusterRecord& cluster = gpu.clusters.at(gpu.candidates.at(k).cluster);
      if (cluster.firstIndex != next || cluster.indexCount > left ||
          gpu.chunks[gpu.candidates[k].chunk].draw != commands[i].firstInstance)
        return {};
      ++times[k];
      next += cluster.indexCount;
      left -= cluster.indexCount;
    }
  }
  return times;
}

// And where they draw packed indices: clusters of the chunk in their order, each with the indices that the pool has.
std::vector<uint32_t> drawnPacked(const CullReadBack& gpu, const std::vector<DrawCommand>& commands,
                                  const std::vector<uint16_t>& packed) {
  std::vector<uint32_t> times(gpu.candidates.size());
  for (size_t i = 0; i < commands.size(); ++i) {
    if (commands[i].instanceCount == 0) continue;
    const CullChunk& chunk = gpu.chunks[gpu.candidates[i].chunk];
    if (commands[i].firstInstance != chunk.draw || commands[i].vertexOffset != chunk.vertexOffset) return {};
    auto next = packed.begin() + commands[i].firstIndex;
    const auto end = next + commands[i].indexCount;
    for (size_t k = i; next != end; ++k) {
      if (k == gpu.candidates.size() || gpu.candidates[k].chunk != gpu.candidates[i].chunk) return {};
      const ClusterRecord& cluster = gpu.clusters.at(gpu.candidates[k].cluster);
      const auto first = gpu.indices.begin() + cluster.firstIndex;
      if (cluster.indexCount > static_cast<size_t>(end - next) || !std::equal(first, first + cluster.indexCount, next))
        continue;
      ++times[k];
      next += cluster.indexCount;
    }
  }
  return times;
}

}  // namespace

std::vector<uint32_t> clustersDrawn(const CullReadBack& gpu,
                                    std::vector<DrawCommand> CullReadBack::BandDraws::*commands) {
  std::vector<uint32_t> most(gpu.candidates.size());
  for (const CullReadBack::BandDraws& band : gpu.bands) {
    const std::vector<uint32_t> times =
        band.packed.empty() ? drawnFromPool(gpu, band.*commands) : drawnPacked(gpu, band.*commands, band.packed);
    if (times.empty()) return {};
    for (size_t i = 0; i < most.size(); ++i) most[i] = std::max(most[i], times[i]);
  }
  return most;
}

}  // namespace eye::test
