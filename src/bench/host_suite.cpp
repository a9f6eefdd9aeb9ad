// Suite `host`: what a host on the loopback sees of the image generator, and what a bad one can do to it.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/statistics.h"
#include "app/terrain_probe.h"
#include "bench/host_cases.h"
#include "bench/places.h"
#include "bench/suites.h"
#include "link/flight_plan.h"

namespace eye {
namespace {

constexpr double kShowS = 20, kQuickShowS = 2;
constexpr double kFloodS = 60, kQuickFloodS = 2;
// Parts of these seconds: each kind in turn, so that a busy minute slows all of them. A quick run has no such minutes.
constexpr int kFloodRounds = 3;
constexpr double kTrackS = 30, kQuickTrackS = 3;
constexpr double kAboveGroundM = 600;
constexpr double kMostWaitMs = 1000 / kHostRateHz, kMostFloodCost = 1.10, kMostAnswersMs = 1;
// A packet leaves, is received and taken by threads that wake up: this much is not the protocol's.
constexpr double kWakingMs = 1;
constexpr BadLinkOptions kBadLink{.jitterMs = 30, .loss = 0.2, .duplicate = 0.1, .reorder = 0.1, .seed = 1};
constexpr std::array kFloods{FloodKind::none,           FloodKind::elsewhere,    FloodKind::garbage,
                             FloodKind::strangersState, FloodKind::hostsGarbage, FloodKind::hostsState};
constexpr const char* kFloodNames[] = {"no flood",
                                       "flood of a socket that nobody reads",
                                       "flood of garbage from a stranger",
                                       "flood of valid state from a stranger",
                                       "flood of garbage from the host",
                                       "flood of valid state from the host"};
constexpr size_t kFirstReceived = 2;  // of these
constexpr std::array kSightLengthsM{1000.0, 10'000.0, 50'000.0};

int roundsOf(const SuiteOptions& options) {
  return options.quick ? 1 : kFloodRounds;
}

class HostSuite {
 public:
  HostSuite(const SuiteOptions& options, const Place& mountains) : options_(options), place_(mountains.spots[0]) {
    report_.name = "host";
    report_.title = "A host on the loopback: transport delay, floods, bad links, questions";
    report_.introduction =
        "Frames of 800x600 at 60 a second, every one drawn, of a host that sends 60 states a second to the same "
        "machine. "
        "What sending costs is measured too: a flood comes from the same cores.";
    report_.tables.push_back({.caption = "Figures", .columns = {"case", "protocol", "value", "unit"}});
    const int floods = static_cast<int>(kFloods.size()) * roundsOf(options);
    steps_ = options.quick ? 3 + floods + 2 + 2 : 3 + 2 * floods + 4 + 2;
  }

  Result<SuiteReport> run() {
    std::vector<double> allDelays;
    for (const HostProtocol protocol : {HostProtocol::nativeFdm, HostProtocol::cigi33, HostProtocol::cigi40})
      if (const auto done = transport(protocol, allDelays); !done) return tl::unexpected(done.error());
    const TimeSummary delays = summarize(allDelays);
    report_.summary["transport_delay_ms"] = delays.median;
    report_.summary["transport_delay_p99_ms"] = delays.p99;
    const std::vector<HostProtocol> hostile = options_.quick
                                                  ? std::vector{HostProtocol::nativeFdm}
                                                  : std::vector{HostProtocol::nativeFdm, HostProtocol::cigi33};
    for (const HostProtocol protocol : hostile)
      if (const auto done = floods(protocol); !done) return tl::unexpected(done.error());
    for (const HostProtocol protocol : hostile)
      if (const auto done = badLink(protocol); !done) return tl::unexpected(done.error());
    if (const auto done = questions(); !done) return tl::unexpected(done.error());
    return std::move(report_);
  }

 private:
  void begin(const std::string& what) {
    if (options_.progress) options_.progress(what, static_cast<double>(done_) / steps_);
    ++done_;
  }

  void add(const std::string& protocol, const std::string& what, double value, const std::string& unit) {
    report_.rows.push_back({{"protocol", protocol}, {"case", what}, {"value", value}, {"unit", unit}});
    report_.tables[0].rows.push_back({what, protocol, fmt::format("{:.3g}", value), unit});
  }

  Result<LiveShow> showOf(HostProtocol protocol, HostDelayMode delay = HostDelayMode::automatic) {
    Options options;
    options.terrain = options_.terrain;
    options.device = options_.device;
    options.hostDelay = delay;
    auto show = LiveShow::create(protocol, options);
    if (show) report_.device = show->device();
    return show;
  }

  Geodetic start() const { return {place_.at.latDeg, place_.at.lonDeg, place_.groundM + kAboveGroundM}; }

  Result<void> transport(HostProtocol protocol, std::vector<double>& allDelays) {
    const std::string name = nameOf(protocol);
    begin(name + ": transport delay");
    auto show = showOf(protocol);
    if (!show) return tl::unexpected(show.error());
    const NumberedPoses poses(start());
    const SteadyHost host(protocol, show->port(), poses);
    if (const auto settled = show->show(1); !settled) return tl::unexpected(settled.error());
    const auto frames = show->show(options_.quick ? kQuickShowS : kShowS);
    if (!frames) return tl::unexpected(frames.error());
    std::vector<double> delayMs, waitMs, frameMs;
    for (const TransportDelay& delay : transportDelays(*frames, poses, host)) {
      delayMs.push_back(delay.delayMs);
      waitMs.push_back(delay.waitMs);
    }
    if (delayMs.empty()) return fail(ErrorKind::io, name + ": no packet reached a frame; is the loopback up?");
    allDelays.insert(allDelays.end(), delayMs.begin(), delayMs.end());
    for (const ShownFrame& frame : *frames) frameMs.push_back(frame.frameMs);
    const TimeSummary delay = summarize(delayMs), wait = summarize(waitMs), frame = summarize(frameMs);
    add(name, "transport delay, median", delay.median, "ms");
    add(name, "transport delay, p99", delay.p99, "ms");
    add(name, "of it before the frame, median", wait.median, "ms");
    add(name, "of it before the frame, p99", wait.p99, "ms");
    add(name, "frame, median", frame.median, "ms");
    add(name, "frame, p99", frame.p99, "ms");
    report_.targets.push_back(
        {fmt::format("{}: transport delay beyond the frame's own time, p99 (one frame of 60 a second: {:.1f} ms)", name,
                     kMostWaitMs),
         fmt::format("{:.1f} ms; median delay {:.1f}, frame {:.1f}", wait.p99, delay.median, frame.median),
         wait.p99 <= kMostWaitMs + kWakingMs});
    return {};
  }

  Result<void> floods(HostProtocol protocol) {
    const std::string name = nameOf(protocol);
    auto show = showOf(protocol);
    if (!show) return tl::unexpected(show.error());
    const NumberedPoses poses(start());
    std::array<FloodFigures, kFloods.size()> all{};
    std::optional<SteadyHost> host;
    const int rounds = roundsOf(options_);
    for (int round = 0; round < rounds; ++round) {
      for (size_t i = 0; i < kFloods.size(); ++i) {
        begin(fmt::format("{}: {}", name, kFloodNames[i]));
        const auto figures = showUnderFlood(*show, protocol, kFloods[i], poses,
                                            (options_.quick ? kQuickFloodS : kFloodS) / rounds, host);
        if (!figures) return tl::unexpected(figures.error());
        FloodFigures& sum = all[i];
        sum.frameMs.insert(sum.frameMs.end(), figures->frameMs.begin(), figures->frameMs.end());
        sum.sentHz += figures->sentHz / rounds;
        sum.receivedHz += figures->receivedHz / rounds;
        sum.unreadHz += figures->unreadHz / rounds;
        sum.followedShare += figures->followedShare / rounds;
        sum.grownMiB = std::max(sum.grownMiB, figures->grownMiB);
        sum.linkShare += figures->linkShare / rounds;
      }
    }
    std::array<TimeSummary, kFloods.size()> frame;
    for (size_t i = 0; i < kFloods.size(); ++i) {
      frame[i] = summarize(all[i].frameMs);
      const std::string what = kFloodNames[i];
      add(name, what + ": frame, median", frame[i].median, "ms");
      add(name, what + ": frame, p99", frame[i].p99, "ms");
      add(name, what + ": sent", all[i].sentHz, "1/s");
      add(name, what + ": received", all[i].receivedHz, "1/s");
      add(name, what + ": dropped unread", all[i].unreadHz, "1/s");
      add(name, what + ": frames that follow within 0.1 s", all[i].followedShare, "share");
      add(name, what + ": memory grown", all[i].grownMiB, "MiB");
      add(name, what + ": receiving thread", all[i].linkShare, "of a core");
    }
    for (size_t i = kFirstReceived; i < kFloods.size(); ++i) {
      const double cost = frame[i].p99 / frame[0].p99, own = frame[i].p99 / frame[1].p99;
      add(name, fmt::format("{}: p99 against none", kFloodNames[i]), cost, "ratio");
      add(name, fmt::format("{}: p99 against one that nobody reads", kFloodNames[i]), own, "ratio");
      report_.targets.push_back(
          {fmt::format("{}: p99 of frames under a {} of {:.0f} a second, against none (below {:.2f})", name,
                       kFloodNames[i], kFloodHz, kMostFloodCost),
           fmt::format(
               "{:.2f}; against the same flood unread {:.2f}; {:.1f} % of the frames follow, memory {:+.1f} MiB, the "
               "receiving thread {:.2f} of a core",
               cost, own, 100 * all[i].followedShare, all[i].grownMiB, all[i].linkShare),
           cost < kMostFloodCost && all[i].followedShare > 0.99});
    }
    return {};
  }

  Result<void> badLink(HostProtocol protocol) {
    const std::string name = nameOf(protocol);
    FlightPlan plan;
    plan.start = start();
    plan.start.altM += 1000;
    plan.startSpeedMS = 150;
    plan.legs = {{5, 150, 0, 0}, {15, 150, 3, 5}, {10, 170, 0, 0}, {30, 150, -4, -5}};
    const FlightPath path(plan);
    const auto poseAt = [&path](double timeS) { return path.poseAt(timeS); };
    std::array<double, 2> errorM{};
    for (const bool treated : {false, true}) {
      begin(fmt::format("{}: a bad link{}", name, treated ? "" : ", untreated"));
      auto show = showOf(protocol, treated ? HostDelayMode::automatic : HostDelayMode::off);
      if (!show) return tl::unexpected(show.error());
      const auto error = trackErrorM(*show, protocol, poseAt, options_.quick ? kQuickTrackS : kTrackS, kBadLink);
      if (!error) return tl::unexpected(error.error());
      errorM[treated] = *error;
      add(name, treated ? "bad link: displayed track, RMS error" : "bad link: newest packet, RMS error", *error, "m");
    }
    report_.targets.push_back(
        {name +
             ": RMS error of the track at 150 m/s, 20 % lost, up to 30 ms late, some twice or out of order (less than "
             "that of the newest packet)",
         fmt::format("{:.2f} m; newest packet {:.2f} m", errorM[1], errorM[0]), errorM[1] < errorM[0]});
    return {};
  }

  Result<void> questions() {
    begin("CIGI: a thousand heights and lines of sight");
    const Geodetic place = start();
    const std::string name = "CIGI";
    const std::string terrain = options_.terrain.empty() ? defaultTerrainPath() : options_.terrain;
    const auto time = [&](const std::string& what, const std::vector<cigi::GroundQuestion>& asked) -> Result<void> {
      const auto times = timeAnswers(asked, [&terrain] { return openTerrainProbe(terrain); });
      if (!times) return tl::unexpected(times.error());
      add(name, fmt::format("a thousand {}, warm, thread's time", what), times->warmMs, "ms");
      add(name, fmt::format("a thousand {}, cold, thread's time", what), times->coldMs, "ms");
      report_.targets.push_back(
          {fmt::format("A thousand {}, warm, thread's time (at most {:g} ms)", what, kMostAnswersMs),
           fmt::format("{:.2f} ms; cold, with reading and decoding, {:.1f} ms", times->warmMs, times->coldMs),
           times->warmMs <= kMostAnswersMs});
      return {};
    };
    if (const auto done = time("heights", heightsRound(place)); !done) return done;
    for (const double lengthM : kSightLengthsM)
      if (const auto done = time(fmt::format("lines of sight of {:g} km", lengthM / 1000), sightsRound(place, lengthM));
          !done)
        return done;

    begin("CIGI: a thousand heights with each frame");
    auto show = showOf(HostProtocol::cigi33);
    if (!show) return tl::unexpected(show.error());
    const auto result = askHeights(*show, NumberedPoses(place), place, options_.quick ? kQuickShowS : kShowS);
    if (!result) return tl::unexpected(result.error());
    const double share =
        static_cast<double>(result->answered) / static_cast<double>(std::max<uint64_t>(result->asked, 1));
    const TimeSummary frame = summarize(result->frameMs);
    add("CIGI 3.3", "a thousand heights a frame: answered", share, "share");
    add("CIGI 3.3", "a thousand heights a frame: asked", static_cast<double>(result->asked), "questions");
    add("CIGI 3.3", "a thousand heights a frame: frame, p99", frame.p99, "ms");
    report_.targets.push_back({"CIGI 3.3: a thousand heights with each frame are answered (99 %)",
                               fmt::format("{:.1f} % of {}", 100 * share, result->asked), share > 0.99});
    return {};
  }

  const SuiteOptions& options_;
  const Spot place_;
  SuiteReport report_;
  int done_ = 0, steps_ = 1;
};

}  // namespace

Result<SuiteReport> runHostSuite(const SuiteOptions& options) {
  const Result<DatabaseReader> reader =
      DatabaseReader::open(options.terrain.empty() ? defaultTerrainPath() : options.terrain);
  if (!reader) return tl::unexpected(reader.error());
  const auto places = findPlaces(*reader);
  if (!places) return tl::unexpected(places.error());
  return HostSuite(options, (*places)[1]).run();
}

}  // namespace eye
