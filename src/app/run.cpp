#include "app/run.h"

#include <cmath>
#include <csignal>
#include <cstdio>
#include <limits>
#include <thread>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/image_generator.h"
#include "app/outputs.h"
#include "app/recorder.h"
#include "app/statistics.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr double kOfflineRateHz = 60;
constexpr double kDisplayRateHz = 60;  // a window's, unless told otherwise: it never spins

// With --rate host: while the host is silent terrain still comes in, and the window wants to be answered.
constexpr int kSilentHostMs = 50;

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

Result<std::unique_ptr<Recorder>> startRecorder(const Options& options, ImageGenerator& generator, double rateHz) {
  if (options.record.empty() && options.framesFolder.empty()) return std::unique_ptr<Recorder>();
  return Recorder::create(
      RecorderOptions{.film = options.record,
                      .folder = options.framesFolder,
                      .widthPx = generator.renderer().widthPx(),
                      .heightPx = generator.renderer().heightPx(),
                      .rateHz = std::isfinite(rateHz) && !options.offline ? rateHz : kOfflineRateHz});
}

struct Flight {
  RunSummary summary;
  double startupMs = 0;    // from the start of the program to the first frame's end
  bool lastFrame = false;  // the last frame was drawn, and what the outputs want of it is read back
};

// Frames until a limit, the source or the user ends it. An output that fails ends it too.
Flight fly(const Options& options, ImageGenerator& generator, std::optional<StatisticsFile>& stats, Recorder* recorder,
           double rateHz, int64_t startedNs, FirstError& failure) {
  Renderer& renderer = generator.renderer();
  const bool displayPaces = !options.headless && options.vsync && renderer.device().type != "CPU";
  Pace pace(displayPaces ? std::numeric_limits<double>::infinity() : rateHz), unseenPace(kDisplayRateHz);
  const Limits limits = limitsOf(options);
  const bool wantsPicture = !options.screenshot.empty(), wantsDepth = !options.distanceMap.empty();
  Flight flight;
  double timeS = 0;
  bool isRead = false;  // what the outputs want of the last frame
  const int64_t beganNs = monotonicNs();
  for (uint64_t number = 0;; ++number) {
    const Result<bool> shown = renderer.awaitDisplay();
    if (!shown) {
      failure.keep(tl::unexpected(shown.error()));
      return flight;
    }
    const double nowS = options.offline ? static_cast<double>(number) / kOfflineRateHz
                                        : static_cast<double>(monotonicNs() - beganNs) * 1e-9;
    if (nowS >= limits.durationS && number > 0) break;
    timeS = nowS;
    const bool last = number + 1 >= limits.frames;
    const Result<FrameRecord> record =
        generator.frame(timeS, recorder != nullptr || (wantsPicture && last), wantsDepth && last);
    if (!record) {
      failure.keep(tl::unexpected(record.error()));
      return flight;
    }
    isRead = (last || !wantsPicture || recorder != nullptr) && (last || !wantsDepth);
    if (number == 0) flight.startupMs = static_cast<double>(monotonicNs() - startedNs) * 1e-6;
    flight.summary.add(*record);
    if (stats && !failure.keep(stats->write(*record))) break;
    if (recorder && !failure.keep(recorder->add(generator.picture(), generator.widthPx(), generator.heightPx(), timeS)))
      break;
    if (last || stopRequested != 0 || (limits.endWithSource && generator.sourceFinished())) break;
    if (!options.headless && !renderer.pollWindow()) break;
    if (options.rateOfHost)
      generator.awaitHost(kSilentHostMs);
    else if (!options.headless && !*shown)
      unseenPace.wait();
    else
      pace.wait();
  }
  // That it was the last is not always known beforehand: then it is drawn again to be read.
  if (!isRead) {
    const Result<FrameRecord> again = generator.frame(timeS, wantsPicture, wantsDepth);
    if (!failure.keep(again ? Result<void>() : tl::unexpected(again.error()))) return flight;
  }
  flight.lastFrame = true;
  return flight;
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
  spdlog::warn("{} of {} frames drawn are coarser than --sse {} asks, with up to {} chunks missing: {}",
               summary.missingChunkFrames(), summary.frameTimesMs().size(), options.ssePx, summary.mostMissing(), cure);
}

}  // namespace

Result<void> printDevices() {
  const Result<std::vector<DeviceDescription>> devices = Renderer::listDevices();
  if (!devices) return tl::unexpected(devices.error());
  for (const DeviceDescription& device : *devices)
    fmt::print("{}\n  type {}, driver {}, Vulkan {}\n  {}\n", device.name, device.type, device.driver,
               device.apiVersion, device.usable ? device.choices : "cannot be used: lacks " + device.lacks);
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

  if (const Result<void> writable = checkOutputs(options); !writable) return writable;
  std::optional<StatisticsFile> stats;
  if (!options.stats.empty()) {
    Result<StatisticsFile> file = StatisticsFile::create(options.stats);
    if (!file) return tl::unexpected(file.error());
    stats = std::move(*file);
  }
  Result<std::unique_ptr<ImageGenerator>> created = ImageGenerator::create(options);
  if (!created) return tl::unexpected(created.error());
  ImageGenerator& generator = **created;

  if (options.rateOfHost && (options.offline || generator.liveHosts() != 1))
    return fail(
        ErrorKind::usage,
        fmt::format("--rate host needs one live host, such as --host cigi://:8000, {}",
                    options.offline ? "and no --offline" : fmt::format("and there are {}", generator.liveHosts())));

  const double defaultRateHz =
      generator.sourceIsFixed() || options.offline ? std::numeric_limits<double>::infinity() : kDisplayRateHz;
  const double rateHz = options.rateHz.value_or(options.headless ? defaultRateHz : kDisplayRateHz);
  Result<std::unique_ptr<Recorder>> recorder = startRecorder(options, generator, rateHz);
  if (!recorder) return tl::unexpected(recorder.error());

  FirstError failure;
  const Flight flight = fly(options, generator, stats, recorder->get(), rateHz, startedNs, failure);
  reportRun(flight.summary, flight.startupMs, options);

  if (flight.lastFrame) {
    failure.keep(writeScreenshot(options, generator));
    failure.keep(writeDistances(options, generator));
  }
  if (*recorder) failure.keep((*recorder)->finish());
  if (stats) failure.keep(stats->close());
  if (!options.summary.empty())
    failure.keep(flight.summary.write(options.summary, generator.renderer().device().name, flight.startupMs,
                                      options.settingsLine()));
  const uint64_t messages = generator.renderer().validationMessages();
  created->reset();  // the paging thread ends before the trace is written
  if (!options.trace.empty()) failure.keep(writeTrace(options.trace));
  if (messages > 0)
    failure.keep(
        fail(ErrorKind::device, fmt::format("{} Vulkan validation messages; they are in the log above", messages)));
  return failure.result();
}

}  // namespace eye
