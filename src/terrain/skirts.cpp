// The boundary loop's sides and the skirts that hang from them, see chunk.h.
#include "terrain/chunk.h"

namespace eye {

std::array<SkirtRange, 4> appendSkirts(ChunkMesh& mesh) {
  const size_t surfaceVertices = mesh.vertices.size();
  size_t loopVertices = 0;
  for (const uint16_t count : mesh.boundary) loopVertices += count;
  EYE_CHECK(loopVertices >= 3 && loopVertices <= surfaceVertices);
  EYE_CHECK(surfaceVertices + loopVertices <= 65535);  // what 16-bit indices reach

  // One rim vertex for each of the loop's; a corner's hangs from both its sides, so that flared skirts meet there.
  for (size_t i = 0; i < loopVertices; ++i) mesh.vertices.push_back(mesh.vertices[i]);
  std::array<SkirtRange, 4> ranges{};
  size_t sideBegin = 0;
  for (size_t side = 0; side < kSides.size(); ++side) {
    const size_t edges = mesh.boundary[side];
    const uint16_t bit = static_cast<uint16_t>(1u << side);
    SkirtRange& range = ranges[side];
    range.firstIndex = static_cast<uint32_t>(mesh.indices.size());
    for (size_t i = sideBegin; i < sideBegin + edges; ++i) {
      const size_t next = (i + 1) % loopVertices;
      const uint16_t upper = static_cast<uint16_t>(i), upperNext = static_cast<uint16_t>(next);
      const uint16_t rim = static_cast<uint16_t>(surfaceVertices + i);
      const uint16_t rimNext = static_cast<uint16_t>(surfaceVertices + next);
      mesh.vertices[rim].skirtSides |= bit;
      mesh.vertices[rimNext].skirtSides |= bit;
      // The loop runs counterclockwise, so from outside the chunk it runs to the right.
      mesh.indices.insert(mesh.indices.end(), {upper, rim, rimNext, upper, rimNext, upperNext});
    }
    range.indexCount = static_cast<uint32_t>(6 * edges);
    sideBegin += edges;
  }
  return ranges;
}

}  // namespace eye
