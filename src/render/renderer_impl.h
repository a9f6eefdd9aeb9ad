// What the renderer is made of, for the files that implement it: renderer.cpp and culled_frame.cpp.
#pragma once

#include "gpu/submission.h"
#include "gpu/swapchain.h"
#include "gpu/timestamps.h"
#include "render/cull_pass.h"
#include "render/debug_views.h"
#include "render/farthest_sample.h"
#include "render/overlay.h"
#include "render/raster_overlap.h"
#include "render/renderer.h"
#include "render/scene_pass.h"

namespace eye {

// In order of construction; destroyed the other way round, after the device has come to rest.
struct Renderer::Impl {
  RendererOptions options;
  std::unique_ptr<Window> window;  // null off-screen, as is the swapchain
  std::unique_ptr<GpuDevice> gpu;
  std::unique_ptr<Swapchain> swapchain;
  vk::raii::PipelineCache cache{nullptr};
  std::unique_ptr<ChunkPools> pools;
  std::unique_ptr<DrawLists> lists;
  std::unique_ptr<CullLists> cullLists;
  std::unique_ptr<CullPass> cull;            // null where the CPU culls
  std::unique_ptr<FarthestSample> farthest;  // null with one sample a pixel
  std::unique_ptr<ScenePass> scene;
  std::unique_ptr<RasterOverlap> overlap;
  std::unique_ptr<DebugViews> debug;  // null unless the options ask for it
  std::unique_ptr<Overlay> overlay;
  std::unique_ptr<Timestamps> timestamps;
  Targets targets;
  Submission frame;              // the last, or only, commands of a frame
  Submission sky;                // where the CPU culls: drawn by the device meanwhile
  std::vector<ChunkDraw> draws;  // of the frame, in two parts by haze
  std::vector<PassTime> passTimes;
  std::vector<uint8_t> rgba;               // the picture read back, where the window's pixels are in another order
  double hostEarlyMs = 0, hostLateMs = 0;  // of the frame's culling, where the CPU does it
  bool skyIsDrawn = false;                 // of the frame at hand, by commands of its own
  bool drawn = false;                      // the colour target holds a whole picture, in usageCopySource

  vk::Format colourFormat() const;
  void resizeTargets(int widthPx, int heightPx);
  bool prepareCulling(const FrameInput& input, size_t byVertex);
  void record(const FrameInput& input, const DrawCounts& counts, bool culls, std::optional<uint32_t> shown);
  void drawAir(const FrameInput& input);
  void drawInBatches(HazeBy haze, const IndirectDraws& indirect, uint32_t first, uint32_t count,
                     std::span<const uint32_t> handOvers);
  void recordScene(const FrameInput& input, const DrawCounts& counts);
  void cullEarly();
  void submitSky();
  void cullLate(const FrameInput& input);
  void recordCulledScene(const FrameInput& input, const DrawCounts& counts);
  std::span<const uint8_t> pictureRgba();
  void readTimes(FrameOutput& output);
};

}  // namespace eye
