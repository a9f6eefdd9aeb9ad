#include "bench/floor_study.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "app/statistics.h"
#include "bench/triangle_replay.h"
#include "telemetry/cpu_time.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr double kTriangleNs = 42 + 26, kPixelNs = 6.2, kClearNs = 0.38;
const glm::vec3 kFlat{0.5f, 0.6f, 0.7f};

// One of the pictures drawn in turn.
struct Step {
  double FloorTimes::*of;
  std::span<const ChunkDraw> draws;
  bool isFlat = false, isCulled = false;
  std::vector<double> cpuMs{}, wallMs{};
};

Result<void> draw(Renderer& renderer, FrameInput input, Step& step) {
  if (!step.isCulled) {
    input.draws = step.draws;
    input.depthMapPx.reset();
  }
  if (step.isFlat) input.background = kFlat;
  const double cpuMs = processCpuMs();
  const int64_t beganNs = monotonicNs();
  const Result<FrameOutput> output = renderer.drawFrame(input);
  if (!output) return tl::unexpected(output.error());
  step.wallMs.push_back(static_cast<double>(output->completedNs - beganNs) * 1e-6);
  step.cpuMs.push_back(processCpuMs() - cpuMs);
  return {};
}

// Pixels of the frame that another list of draws shows in another colour.
Result<uint64_t> differing(Renderer& renderer, FrameInput input, std::span<const ChunkDraw> draws) {
  input.readColour = true;
  Result<FrameOutput> output = renderer.drawFrame(input);
  if (!output) return tl::unexpected(output.error());
  const std::vector<uint8_t> frame(output->rgba.begin(), output->rgba.end());
  input.draws = draws;
  input.depthMapPx.reset();
  output = renderer.drawFrame(input);
  if (!output) return tl::unexpected(output.error());
  uint64_t count = 0;
  for (size_t i = 0; i < frame.size(); i += 4) count += !std::equal(&frame[i], &frame[i] + 3, &output->rgba[i]);
  return count;
}

std::string ms(double value) {
  return fmt::format("{:.2f}", value);
}

}  // namespace

double FloorView::pxPerVisible() const {
  return visible > 0 ? static_cast<double>(terrainPx) / static_cast<double>(visible) : 0;
}

double floorModelMs(uint64_t triangles, uint64_t terrainPx, uint64_t picturePx) {
  const auto count = static_cast<double>(triangles), px = static_cast<double>(terrainPx);
  const double area = count > 0 ? px / count : 1;
  const double overshade = 1 + 8.2 / std::sqrt(area) + 5.5 / area;
  return 1e-6 * (kTriangleNs * count + kPixelNs * overshade * px + kClearNs * static_cast<double>(picturePx));
}

Result<FloorView> measureFloor(SteeredGenerator& generator, const BenchView& view, ChunkShelf& shelf,
                               const FloorEffort& effort) {
  for (int i = 0; i < effort.settle; ++i)
    if (const auto record = generator.frame(view.pose); !record) return tl::unexpected(record.error());
  Renderer& renderer = generator.generator().renderer();
  const Result<DrawnTriangles> drawn = drawnTriangles(generator.generator(), shelf);
  if (!drawn) return tl::unexpected(drawn.error());
  const FrameInput settled = generator.generator().lastInput();

  FloorView floor{.name = view.name};
  floor.visible = drawn->count(TriangleFate::visible);
  floor.covering = floor.visible + drawn->count(TriangleFate::hidden);
  floor.facing = floor.covering + drawn->count(TriangleFate::betweenPixels);
  floor.onScreen = floor.facing + drawn->count(TriangleFate::facingAway);
  floor.submitted = drawn->submitted();
  floor.chunks = settled.draws.size();
  floor.terrainPx = drawn->terrainPx;
  floor.picturePx = static_cast<uint64_t>(settled.view.widthPx) * static_cast<uint64_t>(settled.view.heightPx);
  floor.isCulled = settled.depthMapPx.has_value();

  std::vector<TriangleReplay> replays;
  replays.reserve(5);
  for (const TriangleFate least : {TriangleFate::visible, TriangleFate::hidden, TriangleFate::betweenPixels,
                                   TriangleFate::facingAway, TriangleFate::offScreen}) {
    Result<TriangleReplay> replay = TriangleReplay::create(renderer, settled, *drawn, least);
    if (!replay) return tl::unexpected(replay.error());
    replays.push_back(std::move(*replay));
  }
  const Result<uint64_t> differs = differing(renderer, settled, replays[0].draws());
  if (!differs) return tl::unexpected(differs.error());
  floor.differingPx = *differs;

  std::vector<Step> steps{{.of = &FloorTimes::bareTerrain, .draws = replays[0].draws(), .isFlat = true},
                          {.of = &FloorTimes::visible, .draws = replays[0].draws()},
                          {.of = &FloorTimes::covering, .draws = replays[1].draws()},
                          {.of = &FloorTimes::facing, .draws = replays[2].draws()},
                          {.of = &FloorTimes::onScreen, .draws = replays[3].draws()},
                          {.of = &FloorTimes::submitted, .draws = replays[4].draws()},
                          {.of = &FloorTimes::drawn, .draws = {}, .isCulled = true},
                          {.of = &FloorTimes::frame, .draws = {}}};
  const size_t whole = steps.size() - 1;
  for (int i = 0; i < effort.frames; ++i) {
    for (size_t k = 0; k < steps.size(); ++k) {
      Step& step = steps[(k + static_cast<size_t>(i)) % steps.size()];
      if (&step != &steps[whole]) {
        const Result<void> done = draw(renderer, generator.generator().lastInput(), step);
        if (!done) return tl::unexpected(done.error());
        continue;
      }
      const Result<FrameRecord> record = generator.frame(view.pose);
      if (!record) return tl::unexpected(record.error());
      step.cpuMs.push_back(record->cpuMs);
      step.wallMs.push_back(record->frameMs);
    }
  }
  for (Step& step : steps) {
    floor.cpuMs.*step.of = summarize(step.cpuMs).median;
    floor.wallMs.*step.of = summarize(step.wallMs).median;
  }
  return floor;
}

double floorRatio(const std::vector<FloorView>& views) {
  double floorMs = 0, frameMs = 0;
  for (const FloorView& view : views) {
    floorMs += view.cpuMs.visible;
    frameMs += view.cpuMs.frame;
  }
  return floorMs > 0 ? frameMs / floorMs : std::numeric_limits<double>::quiet_NaN();
}

ReportTable floorTable(const std::vector<FloorView>& views) {
  ReportTable table{.caption = "The floor: the visible triangles alone, CPU ms, against the frame",
                    .groups = {{"", 1}, {"triangles", 5}, {"", 2}, {"terrain alone", 2}, {"with the sky", 4}},
                    .columns = {"view", "submitted", "on screen", "facing", "covering", "visible", "px each", "off px",
                                "model", "replay", "floor", "frame", "ratio", "wall ratio"},
                    .isPrinted = true};
  for (const FloorView& v : views)
    table.rows.push_back({v.name, fmt::format("{}", v.submitted), fmt::format("{}", v.onScreen),
                          fmt::format("{}", v.facing), fmt::format("{}", v.covering), fmt::format("{}", v.visible),
                          fmt::format("{:.1f}", v.pxPerVisible()), fmt::format("{}", v.differingPx),
                          ms(floorModelMs(v.visible, v.terrainPx, v.picturePx)), ms(v.cpuMs.bareTerrain),
                          ms(v.cpuMs.visible), ms(v.cpuMs.frame), ms(v.cpuMs.frame / v.cpuMs.visible),
                          ms(v.wallMs.frame / v.wallMs.visible)});
  return table;
}

ReportTable floorRestTable(const std::vector<FloorView>& views) {
  ReportTable table{.caption = "Where the frame's CPU ms go",
                    .columns = {"view", "visible", "sky", "hidden", "between pixels", "facing away", "off screen",
                                "culling and its draws", "selection", "frame", "chunks", "culled"},
                    .isPrinted = true};
  for (const FloorView& v : views) {
    const FloorTimes& t = v.cpuMs;
    table.rows.push_back({v.name, ms(t.bareTerrain), ms(t.visible - t.bareTerrain), ms(t.covering - t.visible),
                          ms(t.facing - t.covering), ms(t.onScreen - t.facing), ms(t.submitted - t.onScreen),
                          ms(t.drawn - t.submitted), ms(t.frame - t.drawn), ms(t.frame), fmt::format("{}", v.chunks),
                          v.isCulled ? "yes" : "no"});
  }
  return table;
}

nlohmann::ordered_json floorJson(const FloorView& view) {
  const auto times = [](const FloorTimes& t) {
    return nlohmann::ordered_json{{"bare_terrain", t.bareTerrain},
                                  {"floor", t.visible},
                                  {"and_hidden", t.covering},
                                  {"and_between_pixels", t.facing},
                                  {"and_facing_away", t.onScreen},
                                  {"and_off_screen", t.submitted},
                                  {"drawn", t.drawn},
                                  {"frame", t.frame}};
  };
  return {{"view", view.name},
          {"submitted", view.submitted},
          {"on_screen", view.onScreen},
          {"facing", view.facing},
          {"covering", view.covering},
          {"visible", view.visible},
          {"px_per_visible", view.pxPerVisible()},
          {"chunks", view.chunks},
          {"terrain_px", view.terrainPx},
          {"differing_px", view.differingPx},
          {"depth_map", view.isCulled},
          {"model_bare_terrain_ms", floorModelMs(view.visible, view.terrainPx, view.picturePx)},
          {"cpu_ms", times(view.cpuMs)},
          {"wall_ms", times(view.wallMs)},
          {"ratio", view.cpuMs.frame / view.cpuMs.visible}};
}

}  // namespace eye
