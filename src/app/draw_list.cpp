#include "app/draw_list.h"

#include <algorithm>

namespace eye {

void makeDrawList(const TerrainCache& cache, const Selection& selection, std::vector<ChunkDraw>& draws) {
  draws.clear();
  draws.reserve(selection.draws.size());
  for (const DrawnChunk& drawn : selection.draws) {
    const CacheNode& node = cache.node(drawn.node);
    const CacheNode& texture = cache.node(drawn.textureNode);
    // The box's axes are east, north and up at its centre.
    const glm::vec3 east(glm::normalize(node.meta.box.halfAxesEcefM[0]));
    const glm::vec3 north(glm::normalize(node.meta.box.halfAxesEcefM[1]));
    ChunkDraw& draw = draws.emplace_back();
    draw.gpu = node.gpu;
    draw.gpu.indexCount = node.surfaceIndexCount;
    draw.skirts = node.skirts;
    draw.skirtMask = drawn.skirtMask;
    std::ranges::transform(drawn.skirtDepthM, draw.skirtDepthM.begin(),
                           [](double depthM) { return static_cast<float>(depthM); });
    draw.originLattice = node.meta.originLattice;
    draw.stepM = node.meta.stepM();
    draw.box = node.meta.box;
    draw.longestEdgeM = node.longestEdgeM;
    draw.upEcef = glm::cross(east, north);
    draw.outwardEcef = {-north, east, north, -east};
    draw.level = node.meta.key.level();
    draw.textureLayer = static_cast<uint32_t>(texture.gpu.textureLayer);
    draw.textureScale = drawn.textureScale;
    draw.textureOffset = drawn.textureOffset;
  }
}

}  // namespace eye
