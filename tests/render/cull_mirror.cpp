#include "render/cull_mirror.h"

#include <algorithm>

#include <fmt/format.h>

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

// Of each candidate's triangles, how often they are drawn. Where commands draw from the pool: clusters that lie behind
// one another.
std::optional<TriangleTimes> drawnFromPool(const CullReadBack& gpu, const std::vector<DrawCommand>& commands,
                                           TriangleTimes times) {
  for (size_t i = 0; i < commands.size(); ++i) {
    if (commands[i].instanceCount == 0) continue;
    uint32_t next = commands[i].firstIndex, left = commands[i].indexCount;
    for (size_t k = i; left > 0; ++k) {
      const ClusterRecord& cluster = gpu.clusters.at(gpu.candidates.at(k).cluster);
      if (cluster.firstIndex != next || cluster.indexCount > left ||
          gpu.chunks[gpu.candidates[k].chunk].draw != commands[i].firstInstance)
        return std::nullopt;
      for (uint32_t& triangle : times[k]) ++triangle;
      next += cluster.indexCount;
      left -= cluster.indexCount;
    }
  }
  return times;
}

// And where they draw packed indices: triangles of the chunk's clusters in their order.
std::optional<TriangleTimes> drawnPacked(const CullReadBack& gpu, const std::vector<DrawCommand>& commands,
                                         const std::vector<uint16_t>& packed, TriangleTimes times) {
  for (size_t i = 0; i < commands.size(); ++i) {
    if (commands[i].instanceCount == 0) continue;
    const CullChunk& chunk = gpu.chunks[gpu.candidates[i].chunk];
    if (commands[i].firstInstance != chunk.draw || commands[i].vertexOffset != chunk.vertexOffset) return std::nullopt;
    auto next = packed.begin() + commands[i].firstIndex;
    const auto end = next + commands[i].indexCount;
    for (size_t k = i; next != end; ++k) {
      if (k == gpu.candidates.size() || gpu.candidates[k].chunk != gpu.candidates[i].chunk) return std::nullopt;
      auto corner = gpu.indices.begin() + gpu.clusters.at(gpu.candidates[k].cluster).firstIndex;
      for (uint32_t& triangle : times[k]) {
        if (next != end && std::equal(next, next + 3, corner)) {
          ++triangle;
          next += 3;
        }
        corner += 3;
      }
    }
  }
  return times;
}

}  // namespace

std::optional<TriangleTimes> trianglesDrawn(const CullReadBack& gpu,
                                            std::vector<DrawCommand> CullReadBack::BandDraws::*commands) {
  TriangleTimes none;
  for (const CullCandidate& candidate : gpu.candidates)
    none.emplace_back(gpu.clusters[candidate.cluster].indexCount / 3);
  TriangleTimes most = none;
  for (const CullReadBack::BandDraws& band : gpu.bands) {
    const auto times = band.packed.empty() ? drawnFromPool(gpu, band.*commands, none)
                                           : drawnPacked(gpu, band.*commands, band.packed, none);
    if (!times) return std::nullopt;
    for (size_t i = 0; i < most.size(); ++i)
      for (size_t t = 0; t < most[i].size(); ++t) most[i][t] = std::max(most[i][t], (*times)[i][t]);
  }
  return most;
}

std::string wrongDraws(const CullReadBack& gpu) {
  const auto early = trianglesDrawn(gpu, &CullReadBack::BandDraws::early),
             late = trianglesDrawn(gpu, &CullReadBack::BandDraws::late);
  if (!early || !late) return "a command draws what is no cluster's";
  for (size_t i = 0; i < gpu.candidates.size(); ++i) {
    const bool drawsEarly = (gpu.fates[i] & EYE_FATE_EARLY) != 0, drawsLate = (gpu.fates[i] & EYE_FATE_LATE) != 0;
    const bool isVisible = (gpu.fates[i] & EYE_FATE_WHY) == EYE_FATE_VISIBLE;
    for (size_t t = 0; t < (*early)[i].size(); ++t) {
      const uint32_t before = (*early)[i][t], after = (*late)[i][t];
      const auto wrong = [&](const char* what) { return fmt::format("candidate {}, triangle {}: {}", i, t, what); };
      if (before + after > 1) return wrong("drawn twice");
      if (before > 0 && !drawsEarly) return wrong("drawn early, its cluster is not");
      if (after > 0 && !isVisible) return wrong("drawn late, its cluster does not show");
      if (gpu.visibleTriangles.empty()) {
        if (before != drawsEarly || after != drawsLate) return wrong("not as its cluster");
        continue;
      }
      const uint64_t visible = gpu.visibleTriangles[gpu.candidates[i].cluster];
      if (isVisible && before + after == 0 && (visible >> t % 64 & 1) != 0) return wrong("shows and is not drawn");
      if (after > 0 && (visible >> t % 64 & 1) == 0) return wrong("does not show and is drawn late");
    }
  }
  return "";
}

}  // namespace eye::test
