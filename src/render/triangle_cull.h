// Which triangles of a cluster show: what one test of its box leaves, triangle by triangle. Where hills overlap, half
// of a visible cluster's triangles face away or lie behind others, and lavapipe takes several times longer to find that
// out. For devices that are a CPU; conservative like shaders/shared/cull.h: what is called hidden has no pixel on the
// screen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shared/cull_types.h"
#include "terrain/chunk.h"

namespace eye {

// A cluster's triangles, a bit each. All bits: every one, as is said of clusters that have more triangles than bits.
using TriangleBits = uint64_t;
inline constexpr TriangleBits kAllTriangles = ~TriangleBits{0};

// Where a chunk's vertices lie from the eye: origin + step * vertex, ecef.
struct VertexFrame {
  glm::dvec3 originM{};
  double stepM = 1;
  uint32_t count = 0;
};

// What became of a cluster's triangles.
struct TriangleFates {
  TriangleBits visible = 0;
  uint32_t occluded = 0;  // how many lie behind the depth; the others face away, miss every pixel or are off the screen
};

class TriangleCull {
 public:
  // `depth`: the picture's, reversed-Z, row 0 on top. `atCentres`: with one sample a pixel; else a triangle may show
  // anywhere in a pixel.
  TriangleCull(const shader::CullParams& params, std::span<const float> depth, bool atCentres);

  // Projects the vertices of the chunk whose clusters come next.
  void place(const VertexFrame& frame, std::span<const ChunkVertex> vertices);
  // `indices`: three a triangle, into the vertices placed, counterclockwise seen from outside.
  TriangleFates fatesOf(std::span<const uint16_t> indices) const;

 private:
  enum class Fate { visible, occluded, elsewhere };

  struct Corner {
    float xPx, yPx;  // from the picture's upper left corner
    float depth;     // reversed-Z; above 1 behind the near plane
  };

  Fate fateOf(const Corner& a, const Corner& b, const Corner& c) const;
  // Whether everything in the rectangle, both ends within, is nearer.
  bool isBehindAll(float depth, glm::ivec2 low, glm::ivec2 high) const;

  const shader::CullParams params_;
  std::span<const float> depth_;
  float widePx_, highPx_;  // the picture
  float centrePx_;         // 0.5, or 0 where a triangle may show anywhere in a pixel
  float handed_;           // -1 in a mirrored view, where triangles go round the other way
  std::vector<Corner> corners_;
};

}  // namespace eye
