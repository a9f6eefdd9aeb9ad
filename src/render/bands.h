// A picture in bands side by side, each drawn by a device of its own: where devices are a CPU, whose one thread for
// setting up triangles all others would wait for. The devices share meshes, textures and targets, and a pixel's bits do
// not depend on which of them draws it (sort-first rendering: Molnar et al. 1994). Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shared/cull.h"

namespace eye {

inline constexpr int kMostBands = 4;  // memory for binning, compiled shaders and seams come with each

struct BandPlan {
  int bands = 1;
  int rasterThreads = 0;  // of each band's device beside the one that takes commands; 0: that one rasterises
};
// `asked`: 0: as the machine has cores.
BandPlan planBands(int asked, int cores);

// Seams lie at multiples of this, so that nothing that a device works on as one lies in two bands: for the shader that
// finds farthest samples EYE_DEPTH_GROUP pixels, for lavapipe blocks of 4. With several samples a pixel lavapipe also
// takes up, and writes back as it was, the block before its first column, within a tile of 64.
int seamStepPx(int samples);

// First pixel of each band and, behind them, the picture's width; inner ones are multiples of `stepPx`. In a picture of
// few columns the last bands are empty.
std::vector<int> evenEdges(int widthPx, int bands, int stepPx);
// Moves the inner edges, part of the way, to where each band would have taken as long in the last frame. `ms`: what
// each took.
std::vector<int> balancedEdges(std::span<const int> edgesPx, std::span<const double> ms, int stepPx);

// In which bands a box may show, a bit for each, the first band's the lowest. Conservative: a pixel of margin.
class BandTest {
 public:
  // `clipX`, `clipW`: rows of clipFromEcef. `edgesPx` as above; with one band every box is in it.
  BandTest(std::span<const int> edgesPx, const glm::vec3& clipX, const glm::vec3& clipW);
  // `marginM`: how far what is drawn may stick out of the box.
  uint32_t bandsOf(const shader::CullBox& box, float marginM = 0) const;

 private:
  // A point right of the edge, less a pixel, is where the first is positive, left of it where the second is negative.
  struct Edge {
    glm::vec3 right, left;
  };
  std::vector<Edge> edges_;  // inner ones
};

}  // namespace eye
