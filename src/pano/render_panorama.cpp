#include "pano/render_panorama.h"

#include <limits>

#include <fmt/format.h>

#include "app/draw_list.h"
#include "geo/sun.h"
#include "paging/pager.h"
#include "pano/views.h"
#include "render/renderer.h"

namespace eye {
namespace {

// Tolerated error of the terrain, pixels of a view: two thirds of one of the panorama's.
constexpr double kSsePx = 1;

Lighting lightingOf(const PanoramaOptions& options) {
  constexpr CalendarDate kSolstice{2026, 6, 21};
  const double julianDay = julianDayFromLocalSolarTime(options.timeOfDayH, options.eye.lonDeg, kSolstice);
  return {sunDirectionEcef(julianDay), options.visibilityM, siderealRad(julianDay)};
}

// Selects and loads until all that the view needs is there.
Selection selectAll(Pager& pager, const View& view) {
  // Refraction shows what lies beyond the straight horizon.
  const LodOptions lod{.ssePx = kSsePx, .horizon = HorizonTest::none};
  Selection selection;
  do {
    pager.cache().beginFrame();
    selectChunks(pager.cache(), view, lod, selection);
  } while (pager.exchange(selection) > 0);
  return selection;
}

}  // namespace

Result<RenderedPanorama> renderPanorama(const PanoramaOptions& options) {
  const Result<DatabaseReader> database = DatabaseReader::open(options.terrain);
  if (!database) return tl::unexpected(database.error());
  const SceneBend bend = sceneBend(options.eye.latDeg, options.refraction, options.earth);
  const View first = panoramaView(options.frame, options.eye, bend, 0);
  RendererOptions rendererOptions;
  rendererOptions.widthPx = first.widthPx;
  rendererOptions.heightPx = first.heightPx;
  rendererOptions.device = options.device;
  rendererOptions.gpuBudgetBytes = options.cacheGpuMiB << 20;
  rendererOptions.textureSize = database->info().textureSize;
  if (bend != SceneBend{}) rendererOptions.bend = bend;
  const Result<std::unique_ptr<Renderer>> renderer = Renderer::create(rendererOptions);
  if (!renderer) return tl::unexpected(renderer.error());
  const Result<std::unique_ptr<Pager>> pager = Pager::create(options.terrain, **renderer, {.wait = true});
  if (!pager) return tl::unexpected(pager.error());

  RenderedPanorama rendered;
  rendered.device = (*renderer)->device().name;
  Panorama& panorama = rendered.panorama;
  panorama.frame = options.frame;
  panorama.eye = options.eye;
  panorama.rgba.resize(options.frame.pixels() * 4);
  panorama.distanceM.assign(options.frame.pixels(), std::numeric_limits<float>::quiet_NaN());
  if (options.depth == DepthKind::paper) panorama.planarM = panorama.distanceM;
  std::vector<ChunkDraw> draws;
  for (int index = 0; index < kViews; ++index) {
    if (options.progress)
      options.progress(fmt::format("view {} of {}", index + 1, kViews), static_cast<double>(index) / kViews);
    const View view = panoramaView(options.frame, options.eye, bend, index);
    const Selection selection = selectAll(**pager, view);
    rendered.coarseChunks += static_cast<int>(selection.counts.missing);
    makeDrawList((*pager)->cache(), selection, draws);
    FrameInput input;
    input.view = view;
    input.draws = draws;
    input.lighting = lightingOf(options);
    input.readColour = input.readDepth = true;
    const Result<FrameOutput> output = (*renderer)->drawFrame(input);
    if (!output) return tl::unexpected(output.error());
    resample(view, index, output->rgba, output->depth, bend, panorama);
  }
  return rendered;
}

}  // namespace eye
