#include "app/viewpoint_tracker.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "geo/frames.h"
#include "link/flight_plan.h"
#include "link/host_clock.h"

namespace eye {
namespace {

// Turns and climbs at 150 m/s.
FlightPath flightPath() {
  FlightPlan plan;
  plan.start = {49.2, 20.0, 3000};
  plan.startHeadingDeg = 40;
  plan.startSpeedMS = 150;
  plan.legs = {{10, 150, 0, 0}, {20, 150, 3, 5}, {10, 170, 0, 0}, {20, 150, -4, -5}};
  return FlightPath(plan);
}

struct Link {
  double jitterS = 0, loss = 0;
  double burstS = 0;    // packets wait for each other, up to this long
  bool stamps = false;  // with the host's time stamps
};

struct Shown {
  double rmsM = 0;      // from where the aircraft truly is at the frame's time
  double stutterM = 0;  // root mean square of second differences, in excess of the true path's
  double delayMs = 0;
};

constexpr double kEpochS = 1000;  // of the clock of arrivals and frames

int64_t onClock(double s) {
  return static_cast<int64_t>((kEpochS + s) * 1e9);
}

// A 60 Hz host whose frames are not ours, packets with delays of up to `jitterS`, so that they overtake one another.
// What is shown, against the truth `behindS` earlier.
Shown fly(const Link& link, const Options& options, double behindS = 0) {
  const FlightPath path = flightPath();
  std::mt19937 random(2);
  std::uniform_real_distribution<> uniform(0, 1);
  std::vector<std::pair<double, double>> packets;  // arrival, time it is true for
  for (double t = 0; t < path.durationS(); t += 1 / 60.0)
    if (uniform(random) >= link.loss) packets.emplace_back(t + uniform(random) * link.jitterS, t);
  double burstAtS = 0;
  for (auto& [arrivalS, trueS] : packets) {
    if (link.burstS == 0) break;
    while (burstAtS < trueS) burstAtS += uniform(random) * link.burstS;
    arrivalS = burstAtS;
  }
  std::ranges::sort(packets);

  ViewpointTracker tracker(options);
  size_t next = 0;
  SourceSample host;
  host.live = true;
  host.carryOnNs = 200'000'000;
  HostClock clock(3'600'000'000'000);
  std::vector<Vec3d> shown, truth;
  Shown result;
  for (int frame = 0; frame < 60 * path.durationS(); ++frame) {
    const double nowS = 0.007 + frame / 59.94;
    host.heard.clear();
    for (; next < packets.size() && packets[next].first <= nowS; ++next) {
      const auto& [arrivalS, trueS] = packets[next];
      const int64_t arrivedNs = onClock(arrivalS);
      const Moment moment = link.stamps ? clock.take(static_cast<int64_t>(trueS * 1e9), arrivedNs) : Moment{arrivedNs};
      if (moment.overtaken) continue;
      host.valid = true;
      host.pose = path.poseAt(trueS);
      host.arrivedNs = arrivedNs;
      host.atNs = moment.atNs;
      host.stampedByHost = moment.byHost;
      host.heard.push_back({host.pose, host.atNs, host.arrivedNs});
    }
    if (!host.valid) continue;
    tracker.observe(host, host.pose, kEpochS + nowS);
    const DisplayedEye eye = tracker.eye();
    result.delayMs = eye.delayMs;
    if (frame < 300) continue;  // what is learnt: velocity, clock
    shown.push_back(ecefFromGeodetic(eye.pose.position));
    truth.push_back(ecefFromGeodetic(path.positionAt(nowS - behindS)));
  }
  for (size_t i = 2; i < shown.size(); ++i) {
    const Vec3d off = shown[i] - truth[i];
    result.rmsM += glm::dot(off, off);
    const Vec3d bend = (shown[i] - 2.0 * shown[i - 1] + shown[i - 2]) - (truth[i] - 2.0 * truth[i - 1] + truth[i - 2]);
    result.stutterM += glm::dot(bend, bend);
  }
  result.rmsM = std::sqrt(result.rmsM / static_cast<double>(shown.size()));
  result.stutterM = std::sqrt(result.stutterM / static_cast<double>(shown.size()));
  return result;
}

Options withDelay(HostDelayMode mode) {
  Options options;
  options.hostDelay = mode;
  return options;
}

// A live host, and the tracker that follows it.
struct Followed {
  const Options options = withDelay(HostDelayMode::automatic);
  ViewpointTracker tracker{options};
  SourceSample host;
  Followed() {
    host.live = host.valid = true;
    host.carryOnNs = 200'000'000;
  }
  void hear(const Pose& pose, double arrivedS) {
    host.pose = pose;
    const auto arrivedNs = static_cast<int64_t>(arrivedS * 1e9);
    if (arrivedNs == host.arrivedNs) return;
    host.arrivedNs = host.atNs = arrivedNs;
    host.heard.push_back({pose, arrivedNs, arrivedNs});
  }
  void frame(double nowS) {
    tracker.observe(host, host.pose, nowS);
    host.heard.clear();
  }
};

}  // namespace

TEST_CASE("a live host's aircraft is drawn where it is at the frame's time, without stutter") {
  const Options newest = withDelay(HostDelayMode::off), automatic = withDelay(HostDelayMode::automatic);
  for (const Link& link : {Link{0, 0}, Link{0.005, 0}, Link{0.03, 0.2}}) {
    const Shown untreated = fly(link, newest), treated = fly(link, automatic);
    WARN("jitter " << link.jitterS * 1e3 << " ms, loss " << link.loss << ": newest packet " << untreated.rmsM
                   << " m off, stutter " << untreated.stutterM << " m; smoothed " << treated.rmsM << " m, "
                   << treated.stutterM << " m, " << treated.delayMs << " ms behind");
    CHECK(untreated.delayMs == 0);
    CHECK(treated.delayMs == 0);
    CHECK(treated.rmsM * 1.5 < untreated.rmsM);
    CHECK(treated.stutterM * 4 < untreated.stutterM);
  }
}

TEST_CASE(
    "a host's time stamps show the aircraft where it is under jitter, loss and reordering; arrivals where it was") {
  const Options automatic = withDelay(HostDelayMode::automatic);
  const Shown byArrival = fly({0.03, 0.2, 0, false}, automatic), byHost = fly({0.03, 0.2, 0, true}, automatic);
  WARN("jitter 30 ms, loss 0.2: by arrival " << byArrival.rmsM << " m off, stutter " << byArrival.stutterM
                                             << " m; by the host's stamps " << byHost.rmsM << " m, " << byHost.stutterM
                                             << " m");
  CHECK(byHost.rmsM * 5 < byArrival.rmsM);
  CHECK(byHost.rmsM < 0.3);
  CHECK(byHost.stutterM < byArrival.stutterM);
  Options none = automatic;
  none.predictor = PredictorMode::none;  // is the pager's
  CHECK(fly({0.03, 0.2, 0, true}, none).rmsM == byHost.rmsM);
}

TEST_CASE("the delay: as asked for, and by default what jitter goes beyond 50 ms") {
  Options fixed = withDelay(HostDelayMode::fixed);
  fixed.hostDelayMs = 40;
  const Shown asked = fly({0, 0}, fixed);
  CHECK(asked.delayMs == Approx(40));
  CHECK(asked.rmsM == Approx(0.04 * 157).epsilon(0.05));  // 150 to 170 m/s
  // Between the host's poses, whatever the pager's predictor is.
  for (const PredictorMode predictor : {PredictorMode::kalman, PredictorMode::none}) {
    fixed.predictor = predictor;
    const Shown between = fly({0, 0, 0, true}, fixed, 0.04);
    CHECK(between.delayMs == 40);
    CHECK(between.rmsM < 0.003);
    CHECK(between.stutterM < 0.003);
  }
  // Late and lost packets: as much of them as the delay has room for, and the rest is carried on.
  for (const bool stamps : {false, true}) {
    fixed.hostDelayMs = 100;
    const Shown bad = fly({0.03, 0.2, 0, stamps}, fixed, 0.1);
    WARN("delay 100 ms, jitter 30 ms, loss 0.2, " << (stamps ? "host's stamps: " : "arrivals: ") << bad.rmsM
                                                  << " m off, stutter " << bad.stutterM << " m");
    CHECK(bad.rmsM < (stamps ? 0.05 : 3));
    CHECK(bad.stutterM < (stamps ? 0.05 : 0.6));
  }
  const double delayMs = fly({0, 0, 0.25}, withDelay(HostDelayMode::automatic)).delayMs;
  CHECK(delayMs > 5);
  CHECK(delayMs <= 100);
}

TEST_CASE("a channel looks from the aircraft's nose by its offset, in the aircraft's frame") {
  Options options;
  const Pose level{{49, 20, 3000}, 90, 0, 0}, banked{{49, 20, 3000}, 90, 0, 90};
  CHECK(channelPose(level, options) == level);
  const auto turned = [&](const Pose& aircraft, std::array<double, 3> offsetDeg) {
    options.viewOffsetDeg = offsetDeg;
    return channelPose(aircraft, options);
  };
  const auto isPose = [](const Pose& pose, double headingDeg, double pitchDeg, double rollDeg) {
    CAPTURE(pose.headingDeg, pose.pitchDeg, pose.rollDeg);
    CHECK(pose.headingDeg == Approx(headingDeg).margin(1e-9));
    CHECK(pose.pitchDeg == Approx(pitchDeg).margin(1e-9));
    CHECK(pose.rollDeg == Approx(rollDeg).margin(1e-9));
  };
  isPose(turned(level, {-60, 0, 0}), 30, 0, 0);
  isPose(turned(level, {-60, 20, 5}), 30, 20, 5);
  isPose(turned(banked, {30, 0, 0}), 90, -30, 90);  // the right wing points down
  isPose(turned(banked, {0, 30, 0}), 120, 0, 90);   // and the top of the head to the right
}

TEST_CASE("an aircraft that stands is drawn where it stands, and so is one just heard of") {
  Followed followed;
  ViewpointTracker& tracker = followed.tracker;
  const FlightPath path = flightPath();
  for (int i = 0; i < 300; ++i) {
    followed.hear(path.poseAt(i < 200 ? i / 60.0 : 200 / 60.0), 500 + i / 60.0);
    followed.frame(500 + i / 60.0 + 0.004);
    if (i < 5 || i > 217) CHECK(tracker.eye().pose == followed.host.pose);
    if (i > 20 && i < 200) CHECK_FALSE(tracker.eye().pose == followed.host.pose);
  }
}

TEST_CASE("a host that says each pose twice is drawn as evenly as one that does not") {
  Followed followed;
  ViewpointTracker& tracker = followed.tracker;
  const FlightPath path = flightPath();
  Vec3d before{};
  for (int i = 0; i < 300; ++i) {
    followed.hear(path.poseAt(i / 2 / 30.0), 500 + i / 60.0);  // a simulation of 30 Hz in packets of 60
    followed.frame(500 + i / 60.0 + 0.004);
    const Vec3d shown = ecefFromGeodetic(tracker.eye().pose.position);
    if (i > 40) CHECK(glm::distance(shown, before) == Approx(150 / 60.0).epsilon(0.1));
    before = shown;
  }
}

TEST_CASE("frames much faster than packets: no jump, and the speed is the aircraft's") {
  Followed followed;
  ViewpointTracker& tracker = followed.tracker;
  const FlightPath path = flightPath();
  const View view = makeView({}, symmetricFrustum(60, 800, 600, 1), 800, 600);
  int jumps = 0;
  for (int frame = 0; frame < 5000; ++frame) {  // 1,000 a second, packets 10 a second
    followed.hear(path.poseAt(frame / 100 / 10.0), 500 + frame / 100 / 10.0);
    followed.frame(500 + frame / 1000.0);
    jumps += tracker.lookAhead(view).jumped;
  }
  CHECK(jumps == 1);  // the first packet
  CHECK(tracker.lookAhead(view).speedMS == Approx(150).epsilon(0.02));
  CHECK_FALSE(tracker.eye().pose == followed.host.pose);
}

TEST_CASE("a host that falls silent: the eye goes on a fifth of a second, then waits, and says so") {
  Followed followed;
  ViewpointTracker& tracker = followed.tracker;
  const FlightPath path = flightPath();
  double nowS = 800;
  for (int i = 0; i < 180; ++i, nowS += 1 / 60.0) {
    followed.hear(path.poseAt(i / 60.0), nowS);
    followed.frame(nowS);
    CHECK_FALSE(tracker.eye().silent);
  }
  const Vec3d last = ecefFromGeodetic(followed.host.pose.position);
  for (int i = 0; i < 120; ++i, nowS += 1 / 60.0) {
    followed.frame(nowS);
    const double goneM = glm::distance(ecefFromGeodetic(tracker.eye().pose.position), last);
    CHECK(goneM < 0.2 * 150 + 3);
    if (i > 14) {
      CHECK(tracker.eye().silent);
      CHECK(goneM == Approx(0.2 * 150).margin(3));
      // The pager waits with it.
      const LookAhead look =
          tracker.lookAhead(makeView(followed.host.pose, symmetricFrustum(60, 800, 600, 1), 800, 600));
      CHECK(glm::distance(look.at(0).ecefM, last) == Approx(0.2 * 150).margin(3));
      CHECK(look.at(5).ecefM == look.at(0).ecefM);
      CHECK(tracker.record(2).horizonS == 0);
    }
  }
}

TEST_CASE("a host that stops its aircraft and falls silent: the eye settles where it was told last") {
  Followed followed;
  ViewpointTracker& tracker = followed.tracker;
  const FlightPath path = flightPath();
  double nowS = 800;
  for (int i = 0; i < 185; ++i, nowS += 1 / 60.0) {  // the last pose five times more, less than standing still takes
    followed.hear(path.poseAt(std::min(i, 179) / 60.0), nowS);
    followed.frame(nowS);
  }
  for (int i = 0; i < 60; ++i, nowS += 1 / 60.0) followed.frame(nowS);
  CHECK(tracker.eye().silent);
  CHECK(tracker.eye().pose == followed.host.pose);
}

TEST_CASE("an aircraft that its host's rates carry on goes a fifth of a second without a message, and no farther") {
  for (const HostDelayMode mode : {HostDelayMode::automatic, HostDelayMode::off, HostDelayMode::fixed}) {
    Options options = withDelay(mode);
    options.hostDelayMs = 30;
    ViewpointTracker tracker(options);
    SourceSample host;
    host.live = host.valid = true;
    host.carryOnNs = 200'000'000;
    double newestS = 0, nowS = 0;
    const auto northAt = [](double s) { return Pose{{47 + s * 1e-3, 8, 3000}, 0, 0, 0}; };  // 111 m/s
    const auto frame = [&](double frameS) {
      host.motion = [&](int64_t ns) { return northAt(static_cast<double>(ns) * 1e-9); };
      host.pose = northAt(std::min(frameS, newestS + 0.2));
      tracker.observe(host, host.pose, frameS);
      host.heard.clear();
    };
    for (; nowS < 3; nowS += 1 / 60.0) {
      newestS = nowS;
      host.arrivedNs = host.atNs = static_cast<int64_t>(nowS * 1e9);
      host.heard.push_back({northAt(nowS), host.atNs, host.arrivedNs});
      frame(nowS + 0.004);
    }
    for (; nowS < 5; nowS += 1 / 60.0) frame(nowS);
    const double goneS = (tracker.eye().pose.position.latDeg - 47) / 1e-3 - newestS;
    CHECK(goneS == Approx(0.2).margin(0.003));
    CHECK(tracker.eye().silent);
    CHECK(glm::distance(tracker.lookAhead(makeView({}, symmetricFrustum(60, 800, 600, 1), 800, 600)).at(3).ecefM,
                        ecefFromGeodetic(northAt(newestS + 0.2).position)) < 0.5);
  }
}

TEST_CASE("what is not live is drawn as it is, and the pager gets the flight ahead") {
  const Options options = withDelay(HostDelayMode::automatic);
  ViewpointTracker tracker(options);
  const FlightPath path = flightPath();
  SourceSample scenario;
  scenario.valid = true;
  Pose pose;
  double nowS = 0;
  for (; nowS < 5; nowS += 1 / 60.0) {
    pose = path.poseAt(nowS);
    tracker.observe(scenario, pose, nowS);
    CHECK(tracker.eye().pose == pose);
  }
  const LookAhead look = tracker.lookAhead(makeView(pose, symmetricFrustum(60, 800, 600, 1), 800, 600));
  CHECK(look.speedMS == Approx(150).epsilon(0.05));
  CHECK_FALSE(look.jumped);
  const Vec3d then = look.at(2).ecefM;
  CHECK(glm::distance(then, ecefFromGeodetic(path.positionAt(nowS - 1 / 60.0 + 2))) < 5);
  CHECK(look.at(2).inS == 2);
  CHECK(tracker.record(2).horizonS == 2);
  // A jump is told once.
  pose.position.latDeg = -30;
  tracker.observe(scenario, pose, nowS);
  CHECK(tracker.lookAhead(makeView(pose, symmetricFrustum(60, 800, 600, 1), 800, 600)).jumped);

  Options none = options;
  none.predictor = PredictorMode::none;
  ViewpointTracker held(none);
  for (double t = 0; t < 1; t += 1 / 60.0) held.observe(scenario, path.poseAt(t), t);
  const LookAhead still = held.lookAhead(makeView(pose, symmetricFrustum(60, 800, 600, 1), 800, 600));
  CHECK(still.at(5).ecefM == still.at(0).ecefM);
  CHECK(held.record(2).horizonS == 0);
}

}  // namespace eye
