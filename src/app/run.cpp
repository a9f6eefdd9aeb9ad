#include "app/run.h"

#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <thread>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/image_generator.h"
#include "app/recorder.h"
#include "app/statistics.h"
#include "raster/distance_map.h"
#include "raster/picture.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr double kOfflineRateHz = 60;
constexpr double kDisplayRateHz = 60;  // a window's, unless told otherwise: it never spins

volatile std::sig_atomic_t stopRequested = 0;
void requestStop(int) {
  stopRequested = 1;
}

// What ends the run, resolved from options and source.
struct Limits {
  uint64_t frames = std::numeric_limits<uint64_t>::max();
  double durationS = std::numeric_limits<double>::infinity();
  bool endWithSource = false;  // when a recording or scenario is over
};

Limits limitsOf(const Options& options) {
  Limits limits;
  if (options.frames) limits.frames = *options.frames;
  if (options.durationS) limits.durationS = *options.durationS;
  limits.endWithSource = options.headless && !options.frames && !options.durationS;
  return limits;
}

// Sleeps until the next frame is due; a frame that comes late does not hurry those behind it.
class Pace {
 public:
  explicit Pace(double rateHz) : periodNs_(std::isfinite(rateHz) ? static_cast<int64_t>(1e9 / rateHz) : 0) {}
  void wait() {
    if (periodNs_ == 0) return;
    const int64_t now = monotonicNs();
    dueNs_ = dueNs_ == 0 || now > dueNs_ + periodNs_ ? now + periodNs_ : dueNs_ + periodNs_;
    const TraceScope scope("wait for pace");
    if (dueNs_ > now) std::this_thread::sleep_for(std::chrono::nanoseconds(dueNs_ - now));
  }

 private:
  int64_t periodNs_, dueNs_ = 0;
};

// Slant range from reversed-Z depth: depth = near / z, and the ray through a pixel has z = 1.
std::vector<float> slantRange(std::span<const float> depth, const View& view) {
  std::vector<float> rangeM(depth.size(), std::numeric_limits<float>::quiet_NaN());
  size_t i = 0;
  for (int row = 0; row < view.heightPx; ++row) {
    for (int column = 0; column < view.widthPx; ++column, ++i) {
      if (depth[i] <= 0) continue;
      const Vec3d ray = rayThroughPixel(view.frustum, view.widthPx, view.heightPx, column, row);
      rangeM[i] = static_cast<float>(view.frustum.nearM / static_cast<double>(depth[i]) * glm::length(ray));
    }
  }
  return rangeM;
}

// That the folder of an output is there and may be written to.
Result<void> checkFolder(const std::string& path) {
  if (path.empty()) return {};
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return {};
  return fail(ErrorKind::io,
              fmt::format("{}: cannot write there: {}; make the folder or choose another", path, std::strerror(errno)));
}

Result<void> writeLastFrame(const Options& options, const ImageGenerator& generator) {
  if (!options.screenshot.empty()) {
    const Result<void> written =
        writePng(options.screenshot, generator.picture(), generator.widthPx(), generator.heightPx());
    if (!written) return written;
  }
  if (!options.distanceMap.empty()) {
    const std::vector<float> rangeM = slantRange(generator.depth(), generator.view());
    return writeDistanceMap(options.distanceMap, rangeM, generator.widthPx(), generator.heightPx());
  }
  return {};
}

Result<std::unique_ptr<Recorder>> startRecorder(const Options& options, ImageGenerator& generator, double rateHz) {
  if (options.record.empty() && options.framesFolder.empty()) return std::unique_ptr<Recorder>();
  return Recorder::create(
      RecorderOptions{.film = options.record,
                      .folder = options.framesFolder,
                      .widthPx = generator.renderer().widthPx(),
                      .heightPx = generator.renderer().heightPx(),
                      .rateHz = std::isfinite(rateHz) && !options.offline ? rateHz : kOfflineRateHz});
}

void reportRun(const RunSummary& summary, double startupMs, const Options& options) {
  const TimeSummary times = summarize(summary.frameTimesMs());
  spdlog::info("{} frames, {} drawn; frame ms median {:.2f}, p99 {:.2f}, max {:.2f}; first frame after {:.0f} ms",
               summary.frames(), summary.frameTimesMs().size(), times.median, times.p99, times.max, startupMs);
  if (!options.offline || summary.missingChunkFrames() == 0) return;
  const PagingCounts& paging = summary.paging();
  const std::string cure =
      paging.refused > 0 ? fmt::format(
                               "--cache-gpu {} is too small; give {}, and again twice as much until this line "
                               "is gone, or a greater --sse",
                               options.cacheGpuMiB, 2 * options.cacheGpuMiB)
      : paging.damaged > 0
          ? std::string("the database is damaged; eyepoint-bake verify tells where")
          : fmt::format("--cache-ram {} is too small; give {}", options.cacheRamMiB, 2 * options.cacheRamMiB);
  spdlog::warn("{} of {} frames are coarser than --sse {} asks, with up to {} chunks missing: {}",
               summary.missingChunkFrames(), summary.frames(), options.ssePx, summary.mostMissing(), cure);
}

}  // namespace

Result<void> printDevices() {
  const Result<std::vector<DeviceDescription>> devices = Renderer::listDevices();
  if (!devices) return tl::unexpected(devices.error());
  for (const DeviceDescription& device : *devices)
    fmt::print("{}\n  type {}, driver {}, Vulkan {}{}\n", device.name, device.type, device.driver, device.apiVersion,
               device.usable ? "" : ", cannot be used: lacks " + device.lacks);
  return {};
}

Result<void> run(const Options& given, int64_t startedNs) {
  Options options = given;
  // A fixed pose without a window or a limit: one finished picture.
  const bool fixedPose = options.hosts.size() == 1 && options.hosts[0].starts_with("pose://");
  if (options.headless && fixedPose && !options.frames && !options.durationS) {
    options.offline = true;
    options.frames = 1;
  }
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  if (!options.trace.empty()) startTrace();
  nameThread("render");

  // Outputs that cannot be written are found out before the flight.
  for (const std::string& path :
       {options.screenshot, options.distanceMap, options.summary, options.trace, options.record})
    if (const Result<void> writable = checkFolder(path); !writable) return writable;
  std::optional<StatisticsFile> stats;
  if (!options.stats.empty()) {
    Result<StatisticsFile> file = StatisticsFile::create(options.stats);
    if (!file) return tl::unexpected(file.error());
    stats = std::move(*file);
  }
  Result<std::unique_ptr<ImageGenerator>> created = ImageGenerator::create(options);
  if (!created) return tl::unexpected(created.error());
  ImageGenerator& generator = **created;

  const double defaultRateHz =
      generator.sourceIsFixed() || options.offline ? std::numeric_limits<double>::infinity() : kDisplayRateHz;
  const double rateHz = options.rateHz.value_or(options.headless ? defaultRateHz : kDisplayRateHz);
  Result<std::unique_ptr<Recorder>> recorder = startRecorder(options, generator, rateHz);
  if (!recorder) return tl::unexpected(recorder.error());
  const bool displayPaces = !options.headless && options.vsync && generator.renderer().device().type != "CPU";
  Pace pace(displayPaces ? std::numeric_limits<double>::infinity() : rateHz), unseenPace(kDisplayRateHz);

  const Limits limits = limitsOf(options);
  const bool wantsPicture = !options.screenshot.empty(), wantsDepth = !options.distanceMap.empty();
  RunSummary summary;
  double startupMs = 0;
  const int64_t beganNs = monotonicNs();
  for (uint64_t number = 0;; ++number) {
    const Result<bool> shown = generator.renderer().awaitDisplay();
    if (!shown) return tl::unexpected(shown.error());
    const double timeS = options.offline ? static_cast<double>(number) / kOfflineRateHz
                                         : static_cast<double>(monotonicNs() - beganNs) * 1e-9;
    if (timeS >= limits.durationS && number > 0) break;
    const bool last = number + 1 >= limits.frames;
    // Which frame is the last is not always known beforehand: then every frame is read back.
    const bool readPicture = *recorder || (wantsPicture && (last || !options.frames));
    const bool readDepth = wantsDepth && (last || !options.frames);
    const Result<FrameRecord> record = generator.frame(timeS, readPicture, readDepth);
    if (!record) return tl::unexpected(record.error());
    if (number == 0) startupMs = static_cast<double>(monotonicNs() - startedNs) * 1e-6;
    summary.add(*record);
    if (stats)
      if (const Result<void> written = stats->write(*record); !written) return written;
    if (*recorder)
      if (const Result<void> added =
              (*recorder)->add(generator.picture(), generator.widthPx(), generator.heightPx(), timeS);
          !added)
        return added;
    if (last || stopRequested != 0 || (limits.endWithSource && generator.sourceFinished())) break;
    if (!options.headless && !generator.renderer().pollWindow()) break;
    if (!options.headless && !*shown)
      unseenPace.wait();
    else
      pace.wait();
  }

  reportRun(summary, startupMs, options);
  if (const Result<void> written = writeLastFrame(options, generator); !written) return written;
  if (*recorder)
    if (const Result<void> finished = (*recorder)->finish(); !finished) return finished;
  if (stats)
    if (const Result<void> closed = stats->close(); !closed) return closed;
  if (!options.summary.empty()) {
    const Result<void> written =
        summary.write(options.summary, generator.renderer().device().name, startupMs, options.settingsLine());
    if (!written) return written;
  }
  const uint64_t messages = generator.renderer().validationMessages();
  created->reset();  // the paging thread ends before the trace is written
  if (!options.trace.empty())
    if (const Result<void> written = writeTrace(options.trace); !written) return written;
  if (messages > 0)
    return fail(ErrorKind::device, fmt::format("{} Vulkan validation messages; they are in the log above", messages));
  return {};
}

}  // namespace eye
