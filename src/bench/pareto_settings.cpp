#include "bench/pareto_settings.h"

#include <fmt/format.h>

#include "app/option_values.h"

namespace eye {
namespace {

constexpr std::array kTolerancesPx{16.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.25};
constexpr std::array kDepthMapsPx{glm::ivec2(320, 240), glm::ivec2(400, 300), glm::ivec2(640, 480),
                                  glm::ivec2(800, 600)};
constexpr glm::ivec2 kWidePx{1280, 720};
// At 0.25 px a view of mountains needs some 400 MiB; nothing is to be missing.
constexpr uint64_t kCacheGpuMiB = 768, kCacheRamMiB = 256;

ParetoBlock tolerances(ParetoSetting base) {
  ParetoBlock block;
  for (const double ssePx : kTolerancesPx) {
    base.ssePx = ssePx;
    block.push_back(base);
  }
  return block;
}

// The block's default, then what of `settings` is not it.
ParetoBlock against(const ParetoSetting& first, const ParetoBlock& settings) {
  ParetoBlock block{first};
  for (const ParetoSetting& setting : settings)
    if (setting != first) block.push_back(setting);
  return block;
}

}  // namespace

std::string ParetoSetting::depthMapName() const {
  if (culling != CullingMode::dynamic) return "off";
  return depthMapPx ? fmt::format("{}x{}", depthMapPx->x, depthMapPx->y) : "auto";
}

std::string ParetoSetting::sizeName() const {
  return fmt::format("{}x{}", sizePx.x, sizePx.y);
}

std::string ParetoSetting::name() const {
  const ParetoSetting byDefault;
  std::string words;
  const auto add = [&](bool differs, const std::string& what) {
    if (differs) words += (words.empty() ? "" : ", ") + what;
  };
  add(ssePx != byDefault.ssePx, fmt::format("{:g} px", ssePx));
  add(culling != byDefault.culling, "culling " + nameOf(culling));
  add(depthMapPx.has_value(), "depth map " + depthMapName());
  add(sampler != byDefault.sampler, nameOf(sampler));
  add(samples != byDefault.samples, fmt::format("{} samples", samples));
  add(sizePx != byDefault.sizePx, sizeName());
  return words.empty() ? "default" : words;
}

Options ParetoSetting::options() const {
  Options options;
  options.ssePx = ssePx;
  options.culling = culling;
  if (depthMapPx) {
    options.depthMap = DepthMapMode::fixed;
    options.depthMapPx = *depthMapPx;
  }
  options.sampler = sampler;
  options.samples = samples;
  options.widthPx = sizePx.x;
  options.heightPx = sizePx.y;
  options.cacheGpuMiB = kCacheGpuMiB;
  options.cacheRamMiB = kCacheRamMiB;
  return options;
}

std::vector<ParetoBlock> paretoBlocks(bool quick) {
  const ParetoSetting first, wide{.sizePx = kWidePx};
  const auto culledBy = [](CullingMode culling) { return ParetoSetting{.culling = culling}; };
  ParetoBlock quality{{.sampler = TextureFilter::nearest},
                      {.sampler = TextureFilter::trilinear},
                      {.samples = 4},
                      {.sampler = TextureFilter::trilinear, .samples = 4}};
  if (quick) {
    quality.pop_back();
    quality.insert(quality.end(),
                   {culledBy(CullingMode::none), culledBy(CullingMode::frustum), {.depthMapPx = kDepthMapsPx.front()}});
    return {against(first, tolerances(first)), against(first, quality), {wide, {.samples = 4, .sizePx = kWidePx}}};
  }
  ParetoBlock maps, wideOnes = tolerances(wide);
  for (const glm::ivec2& sizePx : kDepthMapsPx) maps.push_back({.depthMapPx = sizePx});
  wideOnes.push_back({.samples = 4, .sizePx = kWidePx});
  return {against(first, tolerances(first)),
          against(first, tolerances(culledBy(CullingMode::frustum))),
          against(first, tolerances(culledBy(CullingMode::none))),
          against(first, maps),
          against(first, quality),
          against(wide, wideOnes)};
}

}  // namespace eye
