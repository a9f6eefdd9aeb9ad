#include "bench/live_show.h"

#include <chrono>
#include <thread>

#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr int64_t kPeriodNs = 1'000'000'000 / 60;  // a display's

}  // namespace

Result<LiveShow> LiveShow::create(HostProtocol protocol, Options options) {
  LiveShow made;
  {
    const auto free = UdpSocket::listenOn({kLoopbackAddress, 0});
    if (!free) return tl::unexpected(free.error());
    made.port_ = free->port();
  }
  options.headless = true;
  options.redrawAlways = true;
  options.hosts = {urlOf(protocol, made.port_)};
  auto generator = ImageGenerator::create(options);
  if (!generator) return tl::unexpected(generator.error());
  made.generator_ = std::move(*generator);
  return made;
}

Result<std::vector<ShownFrame>> LiveShow::show(double durationS) {
  std::vector<ShownFrame> frames;
  const int64_t startNs = monotonicNs(), endNs = startNs + static_cast<int64_t>(durationS * 1e9);
  for (int64_t dueNs = startNs; dueNs < endNs;) {
    const int64_t beganNs = monotonicNs();
    const Result<FrameRecord> record = generator_->frame(static_cast<double>(beganNs - startNs) * 1e-9, false, false);
    if (!record) return tl::unexpected(record.error());
    frames.push_back({.beganNs = beganNs,
                      .endedNs = beganNs + static_cast<int64_t>(record->frameMs * 1e6),
                      .frameMs = record->frameMs,
                      .told = record->pose,
                      .eye = record->eye.pose,
                      .counts = record->host});
    const int64_t nowNs = monotonicNs();
    dueNs = std::max(dueNs + kPeriodNs, nowNs);
    std::this_thread::sleep_for(std::chrono::nanoseconds(dueNs - nowNs));
  }
  return frames;
}

}  // namespace eye
