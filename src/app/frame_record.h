// What one frame was, for the statistics, the overlay and the summary.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/viewpoint_tracker.h"
#include "control/selector_input.h"
#include "geo/pose.h"
#include "link/state_source.h"
#include "paging/lod_select.h"
#include "paging/pager.h"
#include "render/renderer.h"

namespace eye {

struct FrameRecord {
  uint64_t frame = 0;
  double timeS = 0;    // the frame's clock
  Pose pose;           // as the host gave it
  DisplayedEye eye;    // as it was drawn
  bool drawn = true;   // false: the last picture still held (--redraw changed)
  double frameMs = 0;  // start of the frame to its completion; no waiting for the pace
  double cpuMs = 0;    // of the whole process, every thread
  double gpuMs = 0;
  std::vector<PassTime> passes;
  uint64_t triangles = 0, vertices = 0, draws = 0;
  SelectionCounts selection;
  CullCounts clusters;                   // of the occlusion pass, where it ran
  std::optional<glm::ivec2> depthMapPx;  // its depth map; nothing: it did not run
  std::optional<Decision> decision;      // the selector's, where it was asked
  PagingCounts paging;
  PagingPace pace;
  double coarsening = 1;        // of the tolerance, by the pager
  PredictionRecord prediction;  // horizonS 0: none
  HostCounts host;
  std::optional<uint32_t> hostFrame;  // the host's number of the newest packet, where its protocol has one
  double hostAgeMs = -1;  // from the newest packet's arrival to the frame's completion; negative: no packet yet
};

}  // namespace eye
