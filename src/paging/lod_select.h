// Which chunks to draw and which to want: a walk over the resident forest from the roots, in double precision.
// Pure: the same cache and view give the same selection. Owner thread: render.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geo/view.h"
#include "paging/horizon.h"
#include "paging/terrain_cache.h"

namespace eye {

enum class CullingScheme { none, frustum };

struct LodOptions {
  double ssePx = 1;                                // tolerated screen-space error of geometry
  double texelPx = 4;                              // greatest size of an imagery texel on screen while finer exists
  double coarsening = 1;                           // both tolerances are taken times this, 1 or more
  CullingScheme culling = CullingScheme::frustum;  // frustum: view planes and horizon
  HorizonTest horizon = HorizonTest::ellipsoid;
};

struct DrawnChunk {
  uint32_t node = 0;                    // TerrainCache node
  double distanceM = 0;                 // eye to the chunk's box
  uint8_t skirtMask = 0;                // bit (1 << Side): the neighbour there is not drawn at this level
  std::array<double, 4> skirtDepthM{};  // by Side: own error and the largest neighbour's there
  uint32_t textureNode = 0;             // the chunk whose imagery it shows, and the affine map into its TileParam
  glm::vec2 textureScale{1.0f}, textureOffset{0.0f};
};

struct WantedChunk {
  TileKey key;
  float priority =
      0;  // greater is more urgent: screen-space error in units of the tolerance, nearer first among equals
};

struct SelectionCounts {
  uint32_t considered = 0, frustumCulled = 0, horizonCulled = 0, drawn = 0;
  // Drawn coarser than the tolerance allows because a child was not resident. Coarsening counts: it is no excuse.
  uint32_t missing = 0;
};

struct Selection {
  std::vector<DrawnChunk> draws;    // front to back
  std::vector<WantedChunk> wanted;  // most urgent first; the children of one parent behind one another
  SelectionCounts counts;
  // What is drawn hides all that meets the ellipsoid lowered by kDeepestGroundM, for an eye over the ground. Not while
  // coarse terrain sags below that, and not without a horizon. The same whatever is culled.
  bool hidesBelowHorizon = false;

  // The walk's own, kept from frame to frame so that it does not allocate.
  struct Coarse {  // drawn with an error above the tolerance
    uint32_t node;
    float priority, distanceM;
    bool childrenMissing;
  };
  std::vector<DrawnChunk> walked;
  std::vector<Coarse> coarse;
  std::vector<uint64_t> order;
};

// A node is refined when its error is too large on screen and all of its children are resident (Ulrich 2002).
// Call after cache.beginFrame(). Nodes that are visited are marked used in the cache, for eviction.
void selectChunks(TerrainCache& cache, const View& view, const LodOptions& options, Selection& out);

}  // namespace eye
