// The Vulkan side of one frame: pools of meshes and textures, passes, window or off-screen targets, read-back.
// Owner thread: render. Knows nothing of files, hosts or levels of detail: it draws the list that it is given.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "geo/cloud_layer.h"
#include "geo/scene_bend.h"
#include "geo/view.h"
#include "gpu/device_description.h"
#include "gpu/window_keys.h"
#include "paging/terrain_cache.h"
#include "render/picture_quality.h"
#include "shared/cull_types.h"

namespace eye {

// Who reduces the depth map and tests the clusters against it: compute shaders; the CPU; or, by kind of device,
// whichever is faster there.
enum class CullBy { device, compute, host };

struct RendererOptions {
  int widthPx = 800, heightPx = 600;
  std::string device;     // part of a device's name; empty: discrete before integrated before CPU
  bool validate = false;  // validation and synchronization validation; any message is counted
  bool window = false;    // else off-screen
  bool fullscreen = false;
  int monitor = 0;
  bool vsync = true;
  uint64_t gpuBudgetBytes = uint64_t{256} << 20;  // pools of meshes and textures together, never exceeded
  int textureSize = 128;                          // of the terrain database
  CullBy cullBy = CullBy::device;
  int bands = 0;            // that devices which are a CPU draw side by side, see bands.h; 0: one a core, 4 at most
  bool airByPixel = false;  // all haze and sky: what both by vertex are judged by, see haze_width.h, sky_dome.h
  TextureFilter filter = TextureFilter::device;
  int samples = 1;                  // a pixel, 1 or 4; depth is read back at the pixels' centres with either
  bool debugViews = false;          // FrameInput's tint and showDepthMap work
  std::optional<SceneBend> bend{};  // terrain is bent by this about the eye; not the debug views'
};

// Colours over the terrain, for looking at culling: by level of detail, or by what became of each cluster in the last
// frame with a depth map; the latter draws all clusters of the list, hidden ones too.
enum class Tint { none, level, fate };

struct ChunkDraw {
  GpuChunk gpu;                        // firstIndex and indexCount: the surface's
  std::array<SkirtRange, 4> skirts{};  // by Side, offsets from gpu.firstIndex
  uint8_t skirtMask = 0;
  std::array<float, 4> skirtDepthM{};  // by Side
  LatticePoint originLattice{};
  double stepM = 1;
  OrientedBox box;                                              // of the surface, what its clusters' bounds refer to
  float longestEdgeM = std::numeric_limits<float>::infinity();  // of its triangles, see haze_width.h
  glm::vec3 upEcef{};                                           // at the chunk's centre
  std::array<glm::vec3, 4> outwardEcef{};  // by Side: horizontal, away from the chunk, for the skirts' flare
  int level = 0;                           // of detail, for its tint
  uint32_t textureLayer = 0;
  glm::vec2 textureScale{1.0f}, textureOffset{0.0f};
};

struct Lighting {
  Vec3d sunDirectionEcef{0, 0, 1};  // unit, towards the sun
  double visibilityM = 50000;  // meteorological: contrast falls to 5 % (Koschmieder: extinction = 2.996 / visibility)
  double siderealRad = 0;      // how far the Earth has turned under the stars
  CloudLayers clouds{};        // seen from outside; within one the visibility is the caller's to set
};

struct FrameInput {
  View view;
  std::span<const ChunkDraw> draws;  // front to back
  Lighting lighting;
  // The draws hide all that meets the ellipsoid lowered by kDeepestGroundM: no sky is drawn there. What shows through
  // all the same, to an eye under the ground or so close to it that the near plane cuts it, has the horizon's colour.
  bool hidesBelowHorizon = false;
  std::optional<glm::vec3> background;  // instead of the sky, without haze: for tests that look for holes
  // Occlusion culling with a depth map of this size, see CullPass; nothing: every draw as it is.
  std::optional<glm::ivec2> depthMapPx;
  bool freezeCulling = false;  // with depthMapPx: draws the clusters that the last frame not frozen found visible
  Tint tint = Tint::none;
  bool showDepthMap = false;  // and its pyramid, over the picture; with depthMapPx
  bool readColour = false, readDepth = false;
  std::function<void()> overlay;  // Dear ImGui calls; empty: none
};

// How many clusters each test of the culling pass turned away, and what was drawn.
struct CullCounts {
  uint32_t considered = 0, outside = 0, backFacing = 0, occluded = 0, drawn = 0;
  uint64_t trianglesDrawn = 0;
  uint64_t trianglesSpared = 0;  // of occluded clusters and, where the CPU culls, those told one by one
};

struct PassTime {
  const char* name;
  double ms;
};

// Valid until the next drawFrame.
struct FrameOutput {
  double gpuMs = 0;
  // Of the whole process while the frame was drawn, where the device is a CPU: what drawing costs, whatever else keeps
  // the cores busy. Else 0.
  double cpuMs = 0;
  std::vector<PassTime> passes;
  uint64_t triangles = 0, vertices = 0, draws = 0;  // submitted; vertices: of the chunks drawn
  CullCounts clusters;                              // all 0 without a depth map
  std::optional<glm::ivec2> depthMapPx;             // as it was used: at least a 128th of the picture each way
  std::span<const uint8_t> rgba;                    // width * height * 4, row 0 on top; empty unless asked for
  std::span<const float> depth;                     // reversed-Z: near / z, 0 where nothing is
  int widthPx = 0, heightPx = 0;                    // of this frame: a window may have been resized
  int64_t completedNs = 0;                          // telemetry's clock: picture complete, not yet with the display
};

// What the culling passes read and wrote in the last frame, copied from the GPU: for the CPU mirror that checks them.
// By candidate: commands and `fates`; by cluster of the pool: `clusters`.
struct CullReadBack {
  struct BandDraws {
    std::vector<shader::DrawCommand> early, late;
    std::vector<uint16_t> packed;  // where the CPU culls, what the commands draw; empty where they draw the chunks'
  };

  shader::CullParams params;
  std::vector<shader::CullChunk> chunks;
  std::vector<shader::CullCandidate> candidates;
  std::vector<shader::ClusterRecord> clusters;
  std::vector<BandDraws> bands;  // see bands.h; one where the picture is drawn as a whole
  std::vector<int> edgesPx;      // of the next frame's bands
  std::vector<uint32_t> fates;
  std::vector<float> depth, pyramid;  // of the early pass; all levels
  std::vector<uint16_t> indices;      // where the CPU culls, of the resident chunks
  // Where the CPU culls, by cluster of the pool, meant where it is visible: a bit for each triangle that shows, see
  // triangle_cull.h.
  std::vector<uint64_t> visibleTriangles;
};

class Renderer final : public GpuStore {
 public:
  // No driver, no usable device, no display: an error that says which and what to install or set.
  static Result<std::unique_ptr<Renderer>> create(const RendererOptions& options);
  static Result<std::vector<DeviceDescription>> listDevices();
  ~Renderer() override;

  bool hasRoomFor(std::span<const LoadedChunk> chunks) override;
  bool wouldHelp(const GpuChunk& chunk) const override;
  std::optional<GpuChunk> upload(const LoadedChunk& chunk) override;
  void release(const GpuChunk& chunk) override;
  uint64_t bytesResident() const override;

  // Waits until the window can take a picture (vsync): before a frame, so that it begins with fresh state and contains
  // no wait. False where the next frame will not be shown: off-screen, or the window is minimised or covered.
  Result<bool> awaitDisplay();
  // Draws, waits until the frame is complete, shows it if awaitDisplay() said so. An error where the device is lost.
  Result<FrameOutput> drawFrame(const FrameInput& input);
  // Of the last frame with a depth map. Slow.
  CullReadBack readCulling() const;
  // Shows the last frame again without drawing it (a window that was covered), as drawFrame does.
  void presentAgain();

  // The window: false when the user closed it. Handles F11 (fullscreen) and Escape, counts F1 to F4.
  bool pollWindow();
  WindowKeys keys() const;  // none without a window
  bool minimised() const;
  int widthPx() const;
  int heightPx() const;
  const DeviceDescription& device() const;
  TextureFilter textureFilter() const;  // never `device`: what that means here
  uint64_t validationMessages() const;

 private:
  struct Impl;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace eye
