// The settings whose time and error are compared: axes about the default, and all tolerances with each way of culling.
#pragma once

#include <string>
#include <vector>

#include "app/options.h"

namespace eye {

struct ParetoSetting {
  double ssePx = 1;
  CullingMode culling = CullingMode::dynamic;
  std::optional<glm::ivec2> depthMapPx{};  // nothing: the selector's
  TextureFilter sampler = TextureFilter::device;
  int samples = 1;
  glm::ivec2 sizePx{800, 600};
  bool operator==(const ParetoSetting&) const = default;

  std::string depthMapName() const;  // "auto", "off" without dynamic culling, "320x240"
  std::string sizeName() const;
  std::string name() const;  // what differs from the default, in words; "default"
  Options options() const;
};

// Settings that are drawn in turn, frame by frame; the first is the default of the size, to which the others' times are
// put in relation.
using ParetoBlock = std::vector<ParetoSetting>;

// Tolerances of 16 to 0.25 px with each way of culling; at 1 px each depth map, each sampler, 1 and 4 samples; at
// 1280x720 the tolerances with dynamic culling and 4 samples. `quick`: the tolerances with dynamic culling, the rest of
// the axes with fewer steps.
std::vector<ParetoBlock> paretoBlocks(bool quick);

}  // namespace eye
