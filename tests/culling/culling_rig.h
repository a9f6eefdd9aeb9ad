// A renderer over a database whose every frame can be drawn in each way of culling, from one and the same resident
// terrain: what differs then is culling's doing. Thread: one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "paging/pager.h"
#include "render/renderer.h"

namespace eye::test {

struct Picture {
  std::vector<uint8_t> rgba;
  std::vector<float> depth;  // reversed-Z, from which a distance map is made pixel by pixel
  CullCounts clusters;
};

// Empty where both are the same byte by byte, else where and how much they differ.
std::string difference(const Picture& expected, const Picture& found, int widthPx);

class CullingRig {
 public:
  // Null, with a warning, where this machine has no Vulkan device.
  static std::unique_ptr<CullingRig> open(const std::string& database, int widthPx, int heightPx, CullBy cullBy);

  // Walks the forest; `settle`: and loads what it wants until nothing is missing.
  enum class Load { nothing, once, settle };
  void select(const View& view, const LodOptions& options, Load load);
  // Of the newest selection. `mapPx`: with occlusion culling. `wholeSky`: also where terrain is known to hide it.
  Picture draw(const View& view, std::optional<glm::ivec2> mapPx, bool wholeSky = false);

  const Selection& selection() const { return selection_; }
  const TerrainCache& terrain() const { return pager_->cache(); }
  const DatabaseInfo& info() const { return pager_->info(); }
  const FrameOutput& output() const { return output_; }  // of the last draw
  Renderer& renderer() { return *renderer_; }

 private:
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<Pager> pager_;  // gives its chunks back to the renderer: destroyed first
  Selection selection_;
  std::vector<ChunkDraw> draws_;
  FrameOutput output_;
};

}  // namespace eye::test
