// What clusters of each kind and size would save over a real database: docs/CULLING.md has the answer.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "terrain/tile_key.h"

namespace eye {

struct ClusterStudyOptions {
  std::string databasePath;
  // Around each the eye stands over the lowest and over the highest vertex of the finest tile and looks four ways.
  std::vector<LatLon> places;
  std::vector<double> heightsM{30, 300, 610};  // above that vertex
  double ssePx = 1;
  int widthPx = 800, heightPx = 600;  // of the view, 90 degrees wide, and of the depth map
};

// Means over all views at one height. Shares are of the triangles of all chunks that are drawn.
struct ClusterStudyRow {
  std::string method;
  uint32_t mostTriangles = 0;
  double heightM = 0;
  double chunks = 0, triangles = 0, clusters = 0;  // a view
  double facingAway = 0;                           // triangles, each judged by itself
  double coneCulled = 0;                           // in clusters whose cone faces away
  double frustumCulled = 0;                        // in clusters outside the view
  double occluded = 0;                             // in clusters inside it behind the finished picture's depth
  double anyCulled = 0;                            // by any of the three
  double keptClusters = 0;                         // a view, culled by none
  // Of every cluster of the chunks seen: box diagonal over the root of the triangles' area (1.41: a flat square),
  // height over diagonal, and the time to make a chunk's.
  double diagonalRatio = 0, flatness = 0, buildMs = 0;
};

Result<std::vector<ClusterStudyRow>> studyClusters(const ClusterStudyOptions& options);

}  // namespace eye
