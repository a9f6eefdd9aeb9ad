// Suite `culling`: paper 001's Table 5 in shape. No culling, frustum and dynamic draw the same views in turn.
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "app/statistics.h"
#include "bench/culling_rows.h"
#include "bench/places.h"
#include "bench/steered_generator.h"
#include "bench/suites.h"
#include "bench/visible_triangles.h"

namespace eye {
namespace {

constexpr double kMetresPerFoot = 0.3048;
// 30 and 300 m, and the paper's altitudes; all above the ground.
constexpr std::array kAltitudesFt{98, 984, 2000, 4000, 6000, 8000};
constexpr std::array kQuickAltitudesFt{98, 2000};
constexpr std::array kSizesPx{glm::ivec2(800, 600), glm::ivec2(1280, 720)};
constexpr std::array<CullingMode, kSchemes.size()> kModes{CullingMode::none, CullingMode::frustum, CullingMode::dynamic,
                                                          CullingMode::dynamic};
constexpr size_t kDynamic = 2, kFixedMap = 3;  // of kSchemes
// Without culling the whole horizon is resident: no scheme is to be short of memory.
constexpr uint64_t kCacheMiB = 512;
// Frames before those that count: chunks arrive in the first, visibility settles in the next two. The selector makes
// its first comparison after some 20 frames and holds a size for 30, so where the ground or the height changes it is
// given more.
constexpr int kSettleFrames = 3, kSelectorFrames = 100;
// Multiples of the schemes: each comes first, second and so on equally often.
constexpr int kFrames = 12, kQuickFrames = 4;

using Generators = std::array<std::optional<SteeredGenerator>, kSchemes.size()>;

Result<Generators> makeGenerators(const SuiteOptions& suite, glm::ivec2 sizePx) {
  Generators generators;
  for (size_t i = 0; i < generators.size(); ++i) {
    Options options;
    options.terrain = suite.terrain;
    options.device = suite.device;
    options.widthPx = sizePx.x;
    options.heightPx = sizePx.y;
    options.culling = kModes[i];
    options.cacheGpuMiB = kCacheMiB;
    if (i == kFixedMap) {
      options.depthMap = DepthMapMode::fixed;
      options.depthMapPx = {320, 240};
    }
    Result<SteeredGenerator> made = SteeredGenerator::create(options);
    if (!made) return tl::unexpected(made.error());
    generators[i] = std::move(*made);
  }
  return generators;
}

struct ViewSamples {
  std::vector<double> frameMs, cpuMs, triangles, vertices;
  std::map<std::string, std::vector<double>> passMs;
  FrameRecord last;
};

void add(const FrameRecord& record, ViewSamples& samples) {
  samples.frameMs.push_back(record.frameMs);
  samples.cpuMs.push_back(record.cpuMs);
  samples.triangles.push_back(static_cast<double>(record.triangles));
  samples.vertices.push_back(static_cast<double>(record.vertices));
  for (const PassTime& pass : record.passes) samples.passMs[pass.name].push_back(pass.ms);
  samples.last = record;
}

SchemeFigures medians(const ViewSamples& samples) {
  SchemeFigures figures;
  figures.frameMs = summarize(samples.frameMs).median;
  figures.cpuMs = summarize(samples.cpuMs).median;
  figures.triangles = summarize(samples.triangles).median;
  figures.vertices = summarize(samples.vertices).median;
  for (const auto& [pass, ms] : samples.passMs) figures.passMs[pass] = summarize(ms).median;
  const auto& map = samples.last.depthMapPx;
  figures.depthMaps[map ? fmt::format("{}x{}", map->x, map->y) : "off"] = 1;
  return figures;
}

// One view by all schemes, a frame of each in turn.
Result<std::array<SchemeFigures, kSchemes.size()>> measureView(Generators& generators, const Pose& pose, int frames,
                                                               int selectorFrames, VisibleTriangles& visible) {
  std::array<ViewSamples, kSchemes.size()> samples;
  for (size_t s = 0; s < generators.size(); ++s) {
    const int settle = s == kDynamic ? std::max(kSettleFrames, selectorFrames) : kSettleFrames;
    for (int i = 0; i < settle; ++i)
      if (const auto record = generators[s]->frame(pose); !record) return tl::unexpected(record.error());
  }
  for (int i = 0; i < frames; ++i) {
    for (size_t k = 0; k < generators.size(); ++k) {
      const size_t s = (k + static_cast<size_t>(i)) % generators.size();  // begins with another one each time
      const Result<FrameRecord> record = generators[s]->frame(pose);
      if (!record) return tl::unexpected(record.error());
      add(*record, samples[s]);
    }
  }
  // The picture is the same by all schemes, so what shows is too; with a depth map there are the fewest triangles to
  // try.
  const Result<size_t> shown = visible.count(generators[kFixedMap]->generator(), true);
  if (!shown) return tl::unexpected(shown.error());
  std::array<SchemeFigures, kSchemes.size()> figures;
  for (size_t s = 0; s < figures.size(); ++s) {
    figures[s] = medians(samples[s]);
    figures[s].visibleTriangles = static_cast<double>(*shown);
  }
  return figures;
}

// All round, from both spots: along the ridge, at it and away from it.
std::vector<Pose> viewsOf(const Place& place, double heightM, bool quick) {
  std::vector<Pose> views;
  for (const int turnDeg : {0, 90, 180, 270}) {
    const Spot& spot = place.spots[turnDeg % 180 == 0 ? 0 : 1];
    views.push_back(
        {{spot.at.latDeg, spot.at.lonDeg, spot.groundM + heightM}, std::fmod(spot.headingDeg + turnDeg, 360.0), 0, 0});
    if (quick) break;
  }
  return views;
}

}  // namespace

Result<SuiteReport> runCullingSuite(const SuiteOptions& options) {
  const std::string path = options.terrain.empty() ? defaultTerrainPath() : options.terrain;
  const Result<DatabaseReader> reader = DatabaseReader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  const auto places = findPlaces(*reader);
  if (!places) return tl::unexpected(places.error());
  VisibleTriangles visible(*reader);

  const std::vector<int> altitudesFt = options.quick
                                           ? std::vector<int>(kQuickAltitudesFt.begin(), kQuickAltitudesFt.end())
                                           : std::vector<int>(kAltitudesFt.begin(), kAltitudesFt.end());
  const size_t sizes = options.quick ? 1 : kSizesPx.size();
  const double steps = static_cast<double>(sizes * places->size() * altitudesFt.size());
  std::vector<CullingCell> cells;
  std::string device;
  for (size_t i = 0; i < sizes; ++i) {
    Result<Generators> generators = makeGenerators(options, kSizesPx[i]);
    if (!generators) return tl::unexpected(generators.error());
    device = generators->front()->generator().renderer().device().name;
    for (const Place& place : *places) {
      for (const int altitudeFt : altitudesFt) {
        CullingCell cell{.place = place.name, .sizePx = kSizesPx[i], .altitudeFt = altitudeFt, .schemes = {}};
        if (options.progress) {
          options.progress(fmt::format("{} at {} ft, {}x{}", place.name, altitudeFt, cell.sizePx.x, cell.sizePx.y),
                           static_cast<double>(cells.size()) / steps);
        }
        const std::vector<Pose> views = viewsOf(place, altitudeFt * kMetresPerFoot, options.quick);
        for (const Pose& pose : views) {
          const bool first = &pose == &views.front();
          const auto figures = measureView(*generators, pose, options.quick ? kQuickFrames : kFrames,
                                           first && !options.quick ? kSelectorFrames : 0, visible);
          if (!figures) return tl::unexpected(figures.error());
          for (size_t s = 0; s < kSchemes.size(); ++s) addView((*figures)[s], views.size(), cell.schemes[s]);
        }
        cells.push_back(std::move(cell));
      }
    }
  }
  SuiteReport report = cullingReport(cells);
  report.device = device;
  report.notes.push_back(fmt::format(
      "{}: mountains of {:.0f} m relief at {:.3f} N {:.3f} E, plain of {:.0f} m at {:.3f} N {:.3f} E, found by the "
      "relief of the database's tiles. {} views each, level, 60 degrees wide, all round from a valley's floor and from "
      "half way up.",
      path, (*places)[1].reliefM, (*places)[1].spots[0].at.latDeg, (*places)[1].spots[0].at.lonDeg,
      (*places)[0].reliefM, (*places)[0].spots[0].at.latDeg, (*places)[0].spots[0].at.lonDeg, options.quick ? 1 : 4));
  return report;
}

}  // namespace eye
