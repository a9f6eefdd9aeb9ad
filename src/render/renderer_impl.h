// What the renderer is made of, for the files that implement it: renderer.cpp, renderer_start.cpp and culled_frame.cpp.
#pragma once

#include "gpu/swapchain.h"
#include "render/band.h"
#include "render/cull_pass.h"
#include "render/debug_views.h"
#include "render/overlay.h"
#include "render/renderer.h"

namespace eye {

// In order of construction; destroyed the other way round, after the devices have come to rest.
struct Renderer::Impl {
  RendererOptions options;
  std::unique_ptr<Window> window;                // null off-screen, as is the swapchain
  std::vector<std::unique_ptr<GpuDevice>> gpus;  // one for each band
  std::unique_ptr<Swapchain> swapchain;
  std::unique_ptr<ChunkPools> pools;
  std::unique_ptr<DrawLists> lists;
  std::unique_ptr<CullLists> cullLists;
  std::vector<std::unique_ptr<Band>> bands;
  // Of the first band's device, which also has the window.
  std::unique_ptr<CullPass> cull;     // null where the CPU culls
  std::unique_ptr<DebugViews> debug;  // null unless the options ask for it
  std::unique_ptr<Overlay> overlay;

  std::vector<int> edgesPx;      // of the bands, see bands.h
  std::vector<ChunkDraw> draws;  // of the frame, in two parts by haze
  std::vector<PassTime> passTimes;
  std::vector<uint8_t> rgba;  // the picture read back, where the window's pixels are in another order
  // Of the frame: what the CPU does of it, where that is its part.
  double hostUploadMs = 0, hostEarlyMs = 0, hostLateMs = 0;
  bool drawn = false;  // the colour target holds a whole picture, with a window in usageCopySource

  GpuDevice& gpu() const { return *gpus.front(); }
  Band& first() const { return *bands.front(); }
  Targets& targets() const { return first().targets; }
  bool isInBands() const { return bands.size() > 1; }
  vk::Format colourFormat() const;

  void resizeTargets(int widthPx, int heightPx);
  void bindDepth();
  size_t placeBands(const FrameInput& input, const shader::FrameData& data);
  bool prepareCulling(const FrameInput& input, const shader::FrameData& data, size_t byVertex);
  void upload();
  IndirectDraws drawsOf(size_t band) const;
  IndirectDraws clustersOf(size_t band, const GpuBuffer& commands) const;
  void drawScene(const FrameInput& input, const DrawCounts& counts, size_t used);
  void cullEarly(const BandTest& bandTest);
  void cullLate(const FrameInput& input, const BandTest& bandTest, size_t used);
  void drawCulledScene(const FrameInput& input, const DrawCounts& counts, const BandTest& bandTest, size_t used);
  void joinBands(size_t used);
  void finish(const FrameInput& input, std::optional<uint32_t> shown);
  std::span<const uint8_t> pictureRgba();
  void readTimes(size_t used, FrameOutput& output);
  void addPassTime(const char* name, double ms);
  std::optional<double> hostMs(std::string_view pass) const;
};

}  // namespace eye
