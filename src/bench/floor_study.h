// The floor: what a picture would cost if only the triangles that show in it were drawn, and where the rest of the real
// frame's time goes. Owner thread: render.
#pragma once

#include <string>
#include <vector>

#include "bench/bench_views.h"
#include "bench/drawn_triangles.h"
#include "bench/report.h"
#include "bench/steered_generator.h"
#include "bench/suites.h"

namespace eye {

// CPU time of the process, milliseconds: medians of frames drawn in turn. Each of the replays draws more than the last.
struct FloorTimes {
  double bareTerrain = 0;  // the visible triangles before a flat background
  double visible = 0;      // and the sky: the floor
  double covering = 0;     // and what is hidden
  double facing = 0;       // and what covers no pixel's centre
  double onScreen = 0;     // and what faces away
  double submitted = 0;    // and what is off the screen
  double drawn = 0;        // the frame's own draws with its culling passes
  double frame = 0;        // and the selection: the whole frame
};

struct FloorView {
  std::string name;
  uint64_t submitted = 0, onScreen = 0, facing = 0, covering = 0,
           visible = 0;  // triangles, each a part of the one before
  uint64_t chunks = 0, terrainPx = 0, picturePx = 0;
  uint64_t differingPx = 0;  // between the replay of the visible triangles and the frame
  bool isCulled = false;     // with a depth map
  FloorTimes cpuMs{}, wallMs{};
  double pxPerVisible() const;
};

// Milliseconds of CPU time by the model of lavapipe's costs, measured on two cores of an EPYC (Zen 5) with Mesa 22.3
// and bilinear textures of the nearest mip level: 42 ns to bin a triangle and 26 ns to set it up, 6.2 ns a pixel (5.7
// and a tenth for light and haze) times what 4x4 blocks shade beside it; 0.38 ns a pixel to clear. Without the sky.
double floorModelMs(uint64_t triangles, uint64_t terrainPx, uint64_t picturePx);

// Frames of each picture, and before them of the view: chunks arrive in the first, visibility settles in the next two,
// and the selector makes its first comparison after some 20.
struct FloorEffort {
  int frames = 24, settle = 100;
};
Result<FloorView> measureFloor(SteeredGenerator& generator, const BenchView& view, ChunkShelf& shelf,
                               const FloorEffort& effort);

// The real frames' CPU time over the floors', of all views together; NaN without any.
double floorRatio(const std::vector<FloorView>& views);

// The benchmark views of a database, as the product draws them by default.
Result<std::vector<FloorView>> measureFloors(const SuiteOptions& options, std::string& device);
void addFloor(const std::vector<FloorView>& floors, SuiteReport& report);  // summary, target, tables, notes
ReportTable floorTable(const std::vector<FloorView>& views);               // triangles, floor, frame, ratio
ReportTable floorRestTable(const std::vector<FloorView>& views);           // where the rest goes
nlohmann::ordered_json floorJson(const FloorView& view);

}  // namespace eye
