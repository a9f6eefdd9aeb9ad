#include "culling/culling_rig.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "app/draw_list.h"
#include "geo/sun.h"

namespace eye::test {
namespace {

// All that a view without culling draws, in every direction.
constexpr uint64_t kBudgetBytes = uint64_t{1} << 30;

}  // namespace

std::string difference(const Picture& expected, const Picture& found, int widthPx) {
  if (expected.rgba == found.rgba && expected.depth == found.depth) return {};
  size_t pixels = 0, first = expected.depth.size();
  for (size_t i = 0; i < expected.depth.size(); ++i) {
    const bool same = expected.depth[i] == found.depth[i] &&
                      std::equal(&expected.rgba[4 * i], &expected.rgba[4 * i] + 4, &found.rgba[4 * i]);
    pixels += !same;
    if (!same) first = std::min(first, i);
  }
  const auto colour = [&](const Picture& p) {
    return fmt::format("{},{},{}", p.rgba[4 * first], p.rgba[4 * first + 1], p.rgba[4 * first + 2]);
  };
  const auto width = static_cast<size_t>(widthPx);
  return fmt::format("{} pixels differ; at column {} row {} depth {:.9g} instead of {:.9g}, colour {} instead of {}",
                     pixels, first % width, first / width, found.depth[first], expected.depth[first], colour(found),
                     colour(expected));
}

std::unique_ptr<CullingRig> CullingRig::open(const std::string& database, int widthPx, int heightPx, CullBy cullBy) {
  const Result<DatabaseReader> reader = DatabaseReader::open(database);
  if (!reader) FAIL(reader.error().message);
  auto rig = std::make_unique<CullingRig>();
  auto renderer = Renderer::create({.widthPx = widthPx,
                                    .heightPx = heightPx,
                                    .device = {},
                                    .gpuBudgetBytes = kBudgetBytes,
                                    .textureSize = reader->info().textureSize,
                                    .cullBy = cullBy});
  if (!renderer && renderer.error().kind == ErrorKind::notFound) {
    WARN("no Vulkan device here: " << renderer.error().message);
    return nullptr;
  }
  if (!renderer) FAIL(renderer.error().message);
  rig->renderer_ = std::move(*renderer);
  auto pager = Pager::create(database, *rig->renderer_, {.ramBudgetBytes = kBudgetBytes, .wait = true});
  if (!pager) FAIL(pager.error().message);
  rig->pager_ = std::move(*pager);
  return rig;
}

void CullingRig::select(const View& view, const LodOptions& options, Load load) {
  int arrived = 0;
  do {
    pager_->cache().beginFrame();
    selectChunks(pager_->cache(), view, options, selection_);
    arrived = load == Load::nothing ? 0 : pager_->exchange(selection_);
    if (load == Load::once && arrived > 0) {
      load = Load::nothing;  // what came may have taken the place of what was selected
      continue;
    }
  } while (arrived > 0);
  makeDrawList(pager_->cache(), selection_, draws_);
}

Picture CullingRig::draw(const View& view, std::optional<glm::ivec2> mapPx, bool wholeSky) {
  FrameInput input;
  input.view = view;
  input.draws = draws_;
  input.lighting.sunDirectionEcef = sunDirectionEcef(2461120.0);  // an equinox, noon at Greenwich
  input.depthMapPx = mapPx;
  input.hidesBelowHorizon = selection_.hidesBelowHorizon && !wholeSky;
  input.readColour = input.readDepth = true;
  const Result<FrameOutput> output = renderer_->drawFrame(input);
  if (!output) FAIL(output.error().message);
  output_ = *output;
  return {{output->rgba.begin(), output->rgba.end()}, {output->depth.begin(), output->depth.end()}, output->clusters};
}

}  // namespace eye::test
