// What one device draws of a frame: all of it, or a band of it (bands.h). Records and submits what the renderer has
// decided to draw. Owner thread: render.
#pragma once

#include "gpu/submission.h"
#include "gpu/timestamps.h"
#include "render/farthest_sample.h"
#include "render/raster_overlap.h"
#include "render/scene_pass.h"

namespace eye {

struct Band {
  // Throws vk::SystemError. `isAll`: there are no others.
  Band(const GpuDevice& device, const SceneOptions& options, bool isAll);

  const GpuDevice& gpu;
  std::string cachePath;
  vk::raii::PipelineCache cache;
  ScenePass scene;
  std::unique_ptr<FarthestSample> farthest;  // null with one sample a pixel
  Timestamps timestamps;
  std::unique_ptr<RasterOverlap> overlap;  // null beside other bands: its device bins and rasterises by one thread
  Submission frame;                        // the last, or only, commands of a frame
  Submission sky;                          // where the CPU culls: drawn by the device meanwhile
  bool skyIsDrawn = false;                 // of the frame at hand, by commands of its own
  Targets targets;

  // What all passes of a frame need to know: the band's columns and, for them, sky and clouds.
  void place(const FrameInput& input, const shader::FrameData& data, const vk::Rect2D& area, bool airByPixel);
  void begin();
  void wait();

  // Everything in one pass.
  void drawScene(const FrameInput& input, const IndirectDraws& indirect, const DrawCounts& counts,
                 std::span<const uint32_t> handOvers);
  // The culled scene in two passes, and in between the depth of the first for the depth map.
  void drawEarly(const IndirectDraws& clusters, uint32_t byVertex, uint32_t count, std::span<const uint32_t> handOvers);
  void copyDepth(const GpuBuffer& to);
  void drawLate(const FrameInput& input, const IndirectDraws& clusters, uint32_t byVertex, uint32_t count,
                const IndirectDraws& skirts, const DrawCounts& counts);
  // Where nothing is yet: what the late pass adds is drawn over it.
  void submitSky();
  // Of a picture with several samples a pixel, see ScenePass.
  void drawDepthAtCentres(const IndirectDraws& indirect, uint32_t count);

  // Of the frame that has been waited for; busyMs: that the device drew its own part, none of it waiting for others.
  const std::vector<Timestamps::Span>& readTimes();
  double busyMs() const { return busyMs_; }

 private:
  void drawTerrain(HazeBy haze, const IndirectDraws& indirect, uint32_t first, uint32_t count,
                   std::span<const uint32_t> handOvers = {});
  void drawAir(const FrameInput& input);

  double busyMs_ = 0;
};

}  // namespace eye
