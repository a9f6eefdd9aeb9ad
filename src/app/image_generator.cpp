#include "app/image_generator.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/draw_list.h"
#include "app/terrain_probe.h"
#include "geo/sun.h"
#include "link/air.h"
#include "telemetry/cpu_time.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr double kTimeOfDayH = 9;
constexpr double kFrameBudgetMs = 1000.0 / 60;

// Over the middle of the terrain's data, until a live host has spoken.
Pose waitingPose(const DatabaseInfo& info) {
  const TileBounds& b = info.dataBounds;
  return Pose{{(b.southDeg + b.northDeg) / 2, (b.westDeg + b.eastDeg) / 2, 4000.0}, 0, -5, 0};
}

// What --cloud-base means: within it one sees as far as in fog.
Air airWithCloud(double baseM, double coverage, double visibilityM) {
  constexpr double kThicknessM = 300, kTransitionM = 60, kVisibilityM = 150;
  Air air;
  air.visibilityM = visibilityM;
  if (coverage <= 0) return air;
  const double topM = baseM + kThicknessM;
  air.layers[1] = {kVisibilityM, baseM, topM, kTransitionM, kTransitionM};
  air.clouds[0] = {baseM, topM, kTransitionM, kTransitionM, coverage};
  return air;
}

bool operator==(const View& a, const View& b) {
  return a.eyeEcefM == b.eyeEcefM && a.eyeFromEcef == b.eyeFromEcef && a.widthPx == b.widthPx &&
         a.heightPx == b.heightPx && a.frustum == b.frustum;
}

}  // namespace

Result<Sources> Sources::open(const std::vector<std::string>& urls, const OpenProbe& openProbe) {
  Sources sources;
  for (const std::string& url : urls.empty() ? std::vector<std::string>{"demo://"} : urls) {
    Result<std::unique_ptr<StateSource>> source = openStateSource(url, openProbe);
    if (!source) return tl::unexpected(source.error());
    sources.sources_.push_back(std::move(*source));
    sources.description_ += (sources.description_.empty() ? "" : ", ") + url;
  }
  return sources;
}

Sources Sources::of(std::unique_ptr<StateSource> source) {
  Sources sources;
  sources.sources_.push_back(std::move(source));
  sources.description_ = "the program itself";
  return sources;
}

SourceSample Sources::sample(double timeS) {
  SourceSample newest, spoken;
  HostCounts counts;
  bool finished = true;
  for (const auto& source : sources_) {
    SourceSample sample = source->sample(timeS);
    counts.packets += sample.counts.packets;
    counts.rejected += sample.counts.rejected;
    counts.unread += sample.counts.unread;
    counts.lost += sample.counts.lost;
    finished = finished && sample.finished;
    if (sample.arrivedNs > spoken.arrivedNs) spoken = sample;
    if (sample.valid && (!newest.valid || sample.arrivedNs > newest.arrivedNs)) newest = std::move(sample);
  }
  if (spoken.arrivedNs > newest.arrivedNs) {  // without a place: its visibility is that of the last one
    newest.edges = spoken.edges;
    newest.julianDayUtc = spoken.julianDayUtc;
    newest.hostFrame = spoken.hostFrame;
    newest.arrivedNs = spoken.arrivedNs;
    newest.visibilityM = visibilityM_;
    newest.clouds = spoken.clouds;
  }
  visibilityM_ = newest.visibilityM;
  newest.counts = counts;
  newest.finished = finished;
  return newest;
}

void Sources::frameDone(const FrameReport& report) {
  for (const auto& source : sources_) source->frameDone(report);
}

bool Sources::await(int timeoutMs) {
  const auto live = std::ranges::find_if(sources_, [](const auto& source) { return source->isLive(); });
  return live != sources_.end() && (*live)->await(timeoutMs);
}

size_t Sources::liveCount() const {
  return static_cast<size_t>(std::ranges::count_if(sources_, [](const auto& source) { return source->isLive(); }));
}

bool Sources::allFixed() const {
  return std::all_of(sources_.begin(), sources_.end(), [](const auto& source) { return source->isFixed(); });
}

Result<std::unique_ptr<ImageGenerator>> ImageGenerator::create(const Options& options,
                                                               std::unique_ptr<StateSource> source) {
  auto made = std::unique_ptr<ImageGenerator>(new ImageGenerator(options));
  Result<DepthMapControl> depthMap = DepthMapControl::create(options);
  if (!depthMap) return tl::unexpected(depthMap.error());
  made->depthMap_ = std::move(*depthMap);

  const bool embedded = options.terrain.empty();
  const std::string terrain = embedded ? defaultTerrainPath() : options.terrain;
  std::error_code failed;
  if (embedded && !std::filesystem::exists(terrain, failed))
    return fail(ErrorKind::notFound,
                fmt::format("{}: the embedded terrain is not baked yet; run eyepoint-bake demo, which takes "
                            "about a minute, or give --terrain FILE",
                            terrain));
  const Result<DatabaseReader> database = DatabaseReader::open(terrain);
  if (!database) return tl::unexpected(database.error());
  const OpenProbe openProbe = [terrain] { return openTerrainProbe(terrain); };
  Result<Sources> sources =
      source != nullptr ? Sources::of(std::move(source)) : Sources::open(options.hosts, openProbe);
  if (!sources) return tl::unexpected(sources.error());
  made->sources_ = std::move(*sources);

  RendererOptions rendererOptions;
  rendererOptions.widthPx = options.widthPx;
  rendererOptions.heightPx = options.heightPx;
  rendererOptions.device = options.device;
  rendererOptions.validate = options.validate;
  rendererOptions.window = !options.headless;
  rendererOptions.fullscreen = options.fullscreen;
  rendererOptions.monitor = options.monitor;
  rendererOptions.vsync = options.vsync;
  rendererOptions.gpuBudgetBytes = options.cacheGpuMiB << 20;
  rendererOptions.debugViews = !options.headless || options.debugView.any();
  rendererOptions.filter = options.sampler;
  rendererOptions.samples = options.samples;
  rendererOptions.bands = options.bands;
  rendererOptions.textureSize = database->info().textureSize;
  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(rendererOptions);
  if (!renderer) return tl::unexpected(renderer.error());
  made->renderer_ = std::move(*renderer);

  PagerOptions pagerOptions;
  pagerOptions.ramBudgetBytes = options.cacheRamMiB << 20;
  pagerOptions.wait = options.offline;
  Result<std::unique_ptr<Pager>> pager = Pager::create(terrain, *made->renderer_, pagerOptions);
  if (!pager) return tl::unexpected(pager.error());
  made->pager_ = std::move(*pager);
  made->hostPose_ = waitingPose(made->pager_->info());
  spdlog::info("{} on {}, state from {}", terrain, made->renderer_->device().name, made->sources_.description());
  return made;
}

// What the user says of the frustum and of mirrors counts before what the host does.
View ImageGenerator::currentView(const Pose& pose, const ViewEdges& hosts) const {
  const int width = renderer_->widthPx(), height = renderer_->heightPx();
  const Frustum frustum = options_.frustumDeg
                              ? offAxisFrustum((*options_.frustumDeg)[0], (*options_.frustumDeg)[1],
                                               (*options_.frustumDeg)[2], (*options_.frustumDeg)[3], options_.nearM)
                              : frustumWith(symmetricFrustum(options_.fovDeg, width, height, options_.nearM), hosts);
  ViewEdges edges = hosts;
  if (options_.mirrors) edges.mirrorsAcross = (*options_.mirrors)[0], edges.mirrorsUpright = (*options_.mirrors)[1];
  return makeView(pose, mirrored(frustum, edges), width, height);
}

Lighting ImageGenerator::currentLighting(const SourceSample& host) const {
  Lighting lighting;
  const CalendarDate date = options_.date.value_or(kDefaultDate);
  const bool hostsClock = host.julianDayUtc && !options_.timeOfDayH && !options_.utcH && !options_.date;
  const double julianDay = hostsClock      ? *host.julianDayUtc
                           : options_.utcH ? eye::julianDay(date.year, date.month, date.day + *options_.utcH / 24)
                                           : julianDayFromLocalSolarTime(options_.timeOfDayH.value_or(kTimeOfDayH),
                                                                         pose_.position.lonDeg, date);
  lighting.sunDirectionEcef = sunDirectionEcef(julianDay);
  lighting.siderealRad = siderealRad(julianDay);
  lighting.visibilityM = options_.visibilityM.value_or(host.visibilityM.value_or(kClearVisibilityM));
  lighting.clouds = host.clouds;
  if (options_.cloudBaseM) {
    const Air air = airWithCloud(*options_.cloudBaseM, options_.cloudCover, lighting.visibilityM);
    lighting.clouds = air.clouds;
    lighting.visibilityM = visibilityAt(air, pose_.position.altM).value_or(lighting.visibilityM);
  }
  return lighting;
}

// Walks the forest and exchanges with the paging thread; offline again and again until nothing more comes.
void ImageGenerator::select(const LookAhead* ahead) {
  const bool culls = options_.culling != CullingMode::none;
  const LodOptions lod{.ssePx = options_.ssePx,
                       .coarsening = pager_->coarsening(),
                       .culling = culls ? CullingScheme::frustum : CullingScheme::none,
                       .horizon = options_.horizon};
  int arrived = 0;
  do {
    const TraceScope scope("select");
    pager_->cache().beginFrame();
    selectChunks(pager_->cache(), view_, lod, selection_);
    arrived = pager_->exchange(selection_, ahead);
  } while (options_.offline && arrived > 0);
}

DrawnKey ImageGenerator::keyOf(const DrawnChunk& drawn) const {
  const TerrainCache& cache = pager_->cache();
  return {cache.node(drawn.node).meta.key.code(), cache.node(drawn.textureNode).meta.key.code(), drawn.skirtMask,
          drawn.skirtDepthM};
}

// What is loaded ahead does not show: only what the selection draws counts.
bool ImageGenerator::sameAsLast(const Lighting& lighting) const {
  return drawn_ && drawn_->view == view_ && drawn_->lighting.sunDirectionEcef == lighting.sunDirectionEcef &&
         drawn_->lighting.visibilityM == lighting.visibilityM && drawn_->lighting.clouds == lighting.clouds &&
         std::equal(drawn_->chunks.begin(), drawn_->chunks.end(), selection_.draws.begin(), selection_.draws.end(),
                    [this](const DrawnKey& key, const DrawnChunk& drawn) { return key == keyOf(drawn); });
}

// Selection, visibility and depth map stay as they were drawn last. From the start of a run (--debug-view) only when
// the terrain is there and visibility has settled: a late pass, a frame that draws early what it found, and one that
// leaves out what that hides.
bool ImageGenerator::isFrozen(const DebugView& debug) const {
  constexpr int kSettling = 3;
  return debug.freeze && drawn_ && (!options_.debugView.freeze || settledFrames_ >= kSettling);
}

FrameInput ImageGenerator::lastInput() const {
  EYE_CHECK(drawn_.has_value());
  return {.view = view_,
          .draws = draws_,
          .lighting = drawn_->lighting,
          .hidesBelowHorizon = !drawn_->debug.freeze && selection_.hidesBelowHorizon,
          .background = options_.background,
          .depthMapPx = drawn_->depthMapPx,
          .overlay = {}};
}

// One frame, in order.
Result<FrameRecord> ImageGenerator::frame(double timeS, bool readColour, bool readDepth) {
  const TraceScope scope("frame");
  const int64_t beganNs = monotonicNs();
  const double cpuBeganMs = processCpuMs();

  const SourceSample host = sources_.sample(timeS);
  if (host.valid) hostPose_ = host.pose;
  finished_ = host.finished;
  const double nowS = sources_.anyLive() ? static_cast<double>(beganNs) * 1e-9 : timeS;
  // Until a host has said a place the eye waits over the terrain's middle, and without one where it was told last.
  const bool heard = host.valid || !sources_.anyLive();
  if (heard) tracker_.observe(host, hostPose_, nowS);
  eye_ = heard ? tracker_.eye() : DisplayedEye{.pose = hostPose_, .silent = host.isSilent(nowS)};
  const DisplayedEye& eye = eye_;
  pose_ = channelPose(eye.pose, options_);
  view_ = currentView(pose_, host.edges);
  const Lighting lighting = currentLighting(host);
  // The keys switch what the options say.
  const WindowKeys keys = renderer_->keys();
  const bool overlay = (keys.overlay % 2 != 0) != options_.overlay;
  const DebugView debug = switched(options_.debugView, keys);
  const bool frozen = isFrozen(debug);
  if (!frozen) {
    const LookAhead ahead = tracker_.lookAhead(view_);
    select(heard ? &ahead : nullptr);
  }

  const bool seen = !renderer_->minimised() || readColour || readDepth;
  const bool draw =
      seen && (options_.redrawAlways || overlay || debug.any() || !sameAsLast(lighting) || overlay != drawn_->overlay ||
               debug != drawn_->debug || readColour > drawn_->readColour || readDepth > drawn_->readDepth);
  FrameRecord record;
  int64_t endedNs = 0;
  if (draw) {
    if (frozen) {
      record.depthMapPx = drawn_->depthMapPx;
    } else {
      record.depthMapPx = depthMap_.choose(pose_, pager_->cache(), selection_);
      record.decision = depthMap_.decision();
      makeDrawList(pager_->cache(), selection_, draws_);
      settledFrames_ = selection_.counts.missing == 0 ? settledFrames_ + 1 : 0;
    }
    FrameInput input{.view = view_,
                     .draws = draws_,
                     .lighting = lighting,
                     .hidesBelowHorizon = !frozen && selection_.hidesBelowHorizon,
                     .background = options_.background,
                     .depthMapPx = record.depthMapPx,
                     .freezeCulling = frozen,
                     .tint = debug.tint,
                     .showDepthMap = debug.depthMap,
                     .readColour = readColour,
                     .readDepth = readDepth,
                     .overlay = {}};
    if (overlay || debug.any()) {
      input.overlay = [&] {
        if (overlay) overlay_.draw(renderer_->device().name, sources_.description());
        if (debug.any()) drawDebugLegend(debug, frozen, record.depthMapPx, view_.widthPx);
      };
    }
    const double pagingBeganMs = pager_->threadCpuMs();
    const Result<FrameOutput> output = renderer_->drawFrame(input);
    const double pagingMs = pager_->threadCpuMs() - pagingBeganMs;
    if (!output) return tl::unexpected(output.error());
    output_ = *output;
    record.clusters = output_.clusters;
    record.depthMapPx = output_.depthMapPx;
    if (!frozen) depthMap_.learn(output_, pagingMs);
    endedNs = output_.completedNs;
    drawn_ = Drawn{.view = view_,
                   .lighting = lighting,
                   .chunks = {},
                   .readColour = readColour,
                   .readDepth = readDepth,
                   .overlay = overlay,
                   .depthMapPx = record.depthMapPx,
                   .debug = debug};
    for (const DrawnChunk& drawn : selection_.draws) drawn_->chunks.push_back(keyOf(drawn));
  } else {
    endedNs = monotonicNs();
    renderer_->presentAgain();
  }

  record.frame = number_++;
  record.timeS = timeS;
  record.pose = hostPose_;
  record.eye = eye;
  record.drawn = draw;
  record.frameMs = static_cast<double>(endedNs - beganNs) * 1e-6;
  record.cpuMs = processCpuMs() - cpuBeganMs;
  record.gpuMs = draw ? output_.gpuMs : 0;
  if (draw) record.passes = output_.passes;
  record.triangles = output_.triangles;
  record.vertices = output_.vertices;
  record.draws = output_.draws;
  record.selection = selection_.counts;
  record.paging = pager_->counts();
  record.pace = pager_->pace();
  record.coarsening = pager_->coarsening();
  record.prediction = tracker_.record(record.pace.memoryS);
  record.host = host.counts;
  record.hostFrame = host.hostFrame;
  if (host.arrivedNs != 0) record.hostAgeMs = static_cast<double>(endedNs - host.arrivedNs) * 1e-6;
  sources_.frameDone({record.frameMs > kFrameBudgetMs, record.selection.missing > 0});
  overlay_.add(record);
  return record;
}

}  // namespace eye
