// The Vulkan side of one frame: pools of meshes and textures, passes, window or off-screen targets, read-back.
// Owner thread: render. Knows nothing of files, hosts or levels of detail: it draws the list that it is given.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "geo/view.h"
#include "gpu/device_description.h"
#include "paging/terrain_cache.h"

namespace eye {

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
};

struct ChunkDraw {
  GpuChunk gpu;                        // firstIndex and indexCount: the surface's
  std::array<SkirtRange, 4> skirts{};  // by Side, offsets from gpu.firstIndex
  uint8_t skirtMask = 0;
  float skirtDepthM = 0;
  LatticePoint originLattice{};
  double stepM = 1;
  glm::vec3 upEcef{};                      // at the chunk's centre
  std::array<glm::vec3, 4> outwardEcef{};  // by Side: horizontal, away from the chunk, for the skirts' flare
  uint32_t textureLayer = 0;
  glm::vec2 textureScale{1.0f}, textureOffset{0.0f};
};

struct Lighting {
  Vec3d sunDirectionEcef{0, 0, 1};  // unit, towards the sun
  double visibilityM = 50000;  // meteorological: contrast falls to 5 % (Koschmieder: extinction = 2.996 / visibility)
};

struct FrameInput {
  View view;
  std::span<const ChunkDraw> draws;  // front to back
  Lighting lighting;
  std::optional<glm::vec3> background;  // instead of the sky, without haze: for tests that look for holes
  bool readColour = false, readDepth = false;
  std::function<void()> overlay;  // Dear ImGui calls; empty: none
};

struct PassTime {
  const char* name;
  double ms;
};

// Valid until the next drawFrame.
struct FrameOutput {
  double gpuMs = 0;
  std::vector<PassTime> passes;
  uint64_t triangles = 0, vertices = 0, draws = 0;  // submitted
  std::span<const uint8_t> rgba;                    // width * height * 4, row 0 on top; empty unless asked for
  std::span<const float> depth;                     // reversed-Z: near / z, 0 where nothing is
  int widthPx = 0, heightPx = 0;                    // of this frame: a window may have been resized
};

class Renderer final : public GpuStore {
 public:
  // No driver, no usable device, no display: an error that says which and what to install or set.
  static Result<std::unique_ptr<Renderer>> create(const RendererOptions& options);
  static Result<std::vector<DeviceDescription>> listDevices();
  ~Renderer() override;

  std::optional<GpuChunk> upload(const LoadedChunk& chunk) override;
  void release(const GpuChunk& chunk) override;
  uint64_t bytesResident() const override;

  // Draws, waits until the frame is complete, presents in a window. An error where the device is lost.
  Result<FrameOutput> drawFrame(const FrameInput& input);
  // Shows the last frame again without drawing it (a window that was covered); nothing off-screen.
  void presentAgain();

  // The window: false when the user closed it. Handles F1 (overlay), F11 (fullscreen), Escape.
  bool pollWindow();
  bool overlayWanted() const;
  int widthPx() const;
  int heightPx() const;
  const DeviceDescription& device() const;
  uint64_t validationMessages() const;

 private:
  struct Impl;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace eye
