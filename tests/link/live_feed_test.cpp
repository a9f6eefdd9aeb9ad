// The feed that all live protocols run in: who is heard, what restarts and overtaken packets do, what frames get.
#include "link/live_feed.h"

#include <catch2/catch.hpp>

#include "link/cigi_receiver.h"
#include "link/dis_receiver.h"
#include "link/native_fdm_receiver.h"
#include "link/xplane_receiver.h"

namespace eye {
namespace {

constexpr int64_t kMs = 1'000'000, kSecond = 1000 * kMs;
constexpr Peer kHost{0x7f000001, 1000}, kOther{0x7f000001, 1001};
using Bytes = std::vector<std::byte>;

Pose poseAt(double altM) {
  return {{47, 8, altM}, 30, 2, -3};
}

double altitudeOf(const SourceSample& sample) {
  return sample.pose.position.altM;
}

// A feed, and a clock for its datagrams.
template <class Receiver>
struct Fed {
  LiveFeed<Receiver> feed;
  HostCounts counts;
  int64_t nowNs = 1000 * kSecond;

  template <class... Args>
  explicit Fed(HostLock lock, Args&&... args) : feed("test", std::move(lock), std::forward<Args>(args)...) {}
  bool hear(const Bytes& datagram, const Peer& sender = kHost) {
    ++counts.packets;
    const bool good = feed.take(datagram, sender, nowNs).has_value();
    counts.rejected += good ? 0 : 1;
    feed.publish(counts, nowNs);
    return good;
  }
  SourceSample sample() { return feed.sample(nowNs); }
};

Bytes fdm(double altM, uint32_t ticks = 0) {
  return buildNativeFdm({poseAt(altM), std::nullopt, ticks});
}
Bytes rpos(double altM) {
  return buildRpos({.pose = poseAt(altM)});
}
DisEntityState entity(double altM, uint16_t number = 1, double stampS = 0) {
  DisEntityState state;
  state.site = 1, state.application = 2, state.entity = number;
  state.pose = poseAt(altM);
  state.timestamp = disTimestamp(stampS, false);
  return state;
}
Bytes dis(double altM, uint16_t number = 1, double stampS = 0) {
  return buildDisEntityState(entity(altM, number, stampS));
}
Bytes cigiMessage(uint32_t frame, const std::vector<cigi::Packet>& packets,
                  std::optional<uint32_t> ticks = std::nullopt) {
  cigi::IgControl control;
  control.mode = cigi::IgMode::operate;
  control.hostFrame = frame;
  control.ticks = ticks;
  cigi::Builder builder({{3, 3}, std::endian::big}, control);
  for (const cigi::Packet& packet : packets) REQUIRE(builder.add(packet));
  return builder.take();
}
cigi::Entity cigiEntity(double altM, cigi::EntityState state = cigi::EntityState::active) {
  cigi::EntityTraits traits;
  traits.state = state;
  return {0, traits, cigi::EntityPlace{cigi::Clamp::none, 0, -3, 2, 30, poseAt(altM).position}};
}

cigi::ReceiverOptions silent() {
  cigi::ReceiverOptions options;
  options.silent = true;
  return options;
}

// The first that speaks is heard, a second one when that has been silent.
template <class Receiver, class Packet>
void checkLock(Fed<Receiver>& fed, const Packet& packet, int64_t silenceNs) {
  CHECK(fed.hear(packet(100), kHost));
  CHECK_FALSE(fed.hear(packet(200), kOther));
  fed.nowNs += silenceNs;
  CHECK_FALSE(fed.hear(packet(200), kOther));
  CHECK(altitudeOf(fed.sample()) == Approx(100));
  ++fed.nowNs;
  CHECK(fed.hear(packet(300), kOther));  // the host that has begun anew from another port
  CHECK(altitudeOf(fed.sample()) == Approx(300));
  CHECK_FALSE(fed.hear(packet(400), kHost));
  CHECK_FALSE(fed.hear(Bytes(100), kOther));
  CHECK(altitudeOf(fed.sample()) == Approx(300));
  const SourceSample sample = fed.sample();
  CHECK((sample.counts.packets == 6 && sample.counts.rejected == 4));
}

TEST_CASE("live feed: every protocol is locked to the first host that speaks, until it has been silent") {
  Fed<NativeFdmReceiver> fdmFed{HostLock()};
  checkLock(
      fdmFed, [](double altM) { return fdm(altM); }, kHostSilenceNs);
  Fed<XplaneReceiver> xplaneFed(HostLock(AllowList::only(kHost)), kHost, 60);
  checkLock(xplaneFed, rpos, kHostSilenceNs);
  Fed<DisReceiver> disFed(HostLock({}, kDisTimeOutNs), "test", std::nullopt);
  checkLock(
      disFed, [](double altM) { return dis(altM); }, kDisTimeOutNs);
  Fed<cigi::Receiver> cigiFed(HostLock(), "test", silent(), OpenProbe{});
  uint32_t frame = 500;
  checkLock(
      cigiFed, [&](double altM) { return cigiMessage(--frame, {cigiEntity(altM)}); }, kHostSilenceNs);
}

TEST_CASE("live feed: only senders that are allowed are looked at") {
  Fed<NativeFdmReceiver> fed(HostLock(AllowList::only({0x0a000001, 0})));
  CHECK_FALSE(fed.hear(fdm(100), kHost));
  CHECK_FALSE(fed.sample().valid);
  CHECK(fed.hear(fdm(100), {0x0a000001, 77}));
  CHECK(fed.sample().valid);
}

TEST_CASE("live feed: DIS passes the other entities of an exercise over, whoever sends them") {
  Fed<DisReceiver> fed(HostLock({}, kDisTimeOutNs), "test", std::nullopt);
  CHECK(fed.hear(dis(100, 1)));
  CHECK(fed.hear(dis(200, 2), kOther));
  CHECK_FALSE(fed.hear(dis(300, 1), kOther));  // says that it is ours
  CHECK(altitudeOf(fed.sample()) == Approx(100));
  fed.nowNs += kDisTimeOutNs + 1;
  CHECK(fed.hear(dis(200, 2), kOther));
  CHECK(altitudeOf(fed.sample()) == Approx(200));
}

TEST_CASE("live feed: a DIS PDU that was overtaken does not steer back") {
  Fed<DisReceiver> fed(HostLock({}, kDisTimeOutNs), "test", std::nullopt);
  const auto hear = [&](double stampS, double altM) {
    fed.nowNs += 10 * kMs;
    return fed.hear(dis(altM, 1, stampS));
  };
  CHECK(hear(3599.98, 100));
  CHECK(hear(0.01, 102));  // the hour is over
  CHECK(hear(3599.99, 101));
  CHECK(altitudeOf(fed.sample()) == Approx(102));
  CHECK(hear(0.02, 103));
  CHECK(altitudeOf(fed.sample()) == Approx(103));
  // Another clock: the bit says so.
  fed.nowNs += 10 * kMs;
  DisEntityState utc = entity(104);
  utc.timestamp = disTimestamp(3599, true);
  CHECK(fed.hear(buildDisEntityState(utc)));
  CHECK(altitudeOf(fed.sample()) == Approx(104));
}

TEST_CASE("live feed: a CIGI message that was overtaken changes nothing at all") {
  Fed<cigi::Receiver> fed(HostLock(), "test", silent(), OpenProbe{});
  const auto hear = [&](uint32_t frame, const std::vector<cigi::Packet>& packets) {
    fed.nowNs += 10 * kMs;
    return fed.hear(cigiMessage(frame, packets));
  };
  cigi::ViewDefinition lens, oldLens;
  lens.leftDegOrM = -20, oldLens.leftDegOrM = -50, oldLens.rightDegOrM = 50;
  cigi::CelestialSphere sky, oldSky;
  sky.dateTime = cigi::DateTime{2024, 6, 21, 12, 30, 0}, oldSky.dateTime = cigi::DateTime{2024, 6, 21, 3, 30, 0};
  cigi::Atmosphere air, oldAir;
  air.visibilityM = 20000, oldAir.visibilityM = 300;
  cigi::Velocity oldRate;
  oldRate.xMS = 500;
  cigi::ViewControl oldView;
  oldView.xM = 70;
  CHECK(hear(10, {cigiEntity(100)}));
  CHECK(hear(12, {cigiEntity(102), lens, sky, air}));
  const SourceSample before = fed.sample();
  CHECK(hear(11, {oldLens, oldSky, oldAir, oldRate, oldView, cigiEntity(50),
                  cigi::Entity{9, cigi::EntityTraits{}, cigi::EntityPlace{}}}));
  CHECK(hear(11, {cigiEntity(50, cigi::EntityState::destroyed)}));
  SourceSample after = fed.sample();
  CHECK(after.hostFrame == 12u);
  CHECK(after.arrivedNs == before.arrivedNs);
  CHECK(after.heard.empty());
  CHECK(hear(13, {}));
  after = fed.sample();
  CHECK(after.valid);
  CHECK(after.pose == before.pose);
  CHECK_FALSE(after.motion);
  CHECK(after.edges == before.edges);
  CHECK(after.julianDayUtc == before.julianDayUtc);
  CHECK(after.visibilityM == before.visibilityM);
}

TEST_CASE("live feed: lens and clock are told while the eye's entity is gone") {
  Fed<cigi::Receiver> fed(HostLock(), "test", silent(), OpenProbe{});
  cigi::ViewDefinition lens;
  lens.leftDegOrM = -20;
  cigi::CelestialSphere sky;
  sky.dateTime = cigi::DateTime{2024, 6, 21, 12, 30, 0};
  CHECK(fed.hear(cigiMessage(1, {cigiEntity(100), lens, sky})));
  fed.nowNs += 10 * kMs;
  CHECK(fed.hear(cigiMessage(2, {cigiEntity(100, cigi::EntityState::destroyed)})));
  const SourceSample sample = fed.sample();
  CHECK_FALSE(sample.valid);
  CHECK(sample.edges.leftDeg == -20.0);
  CHECK(sample.julianDayUtc);
  CHECK(sample.hostFrame == 2u);
}

TEST_CASE("live feed: a host mirrors the view, and turns it back") {
  Fed<cigi::Receiver> fed(HostLock(), "test", silent(), OpenProbe{});
  uint32_t frame = 1;
  for (const cigi::Mirror mirror :
       {cigi::Mirror::horizontal, cigi::Mirror::vertical, cigi::Mirror::both, cigi::Mirror::none}) {
    cigi::ViewDefinition lens;
    lens.mirror = mirror;
    fed.nowNs += 10 * kMs;
    CHECK(fed.hear(cigiMessage(frame++, {cigiEntity(100), lens})));
    const ViewEdges edges = fed.sample().edges;
    CHECK(edges.mirrorsAcross == (mirror == cigi::Mirror::horizontal || mirror == cigi::Mirror::both));
    CHECK(edges.mirrorsUpright == (mirror == cigi::Mirror::vertical || mirror == cigi::Mirror::both));
  }
}

TEST_CASE("live feed: what came between two frames is told in order, at the host's moments, and bounded") {
  Fed<cigi::Receiver> fed(HostLock(), "test", silent(), OpenProbe{});
  const int64_t beganNs = fed.nowNs;
  uint32_t frame = 0;
  for (; frame < 300; ++frame) {  // held up for 0, 7 or 14 ms
    fed.nowNs = beganNs + frame * 20 * kMs + frame % 3 * 7 * kMs;
    CHECK(fed.hear(cigiMessage(frame, {cigiEntity(100 + frame)}, frame * 2000)));
  }
  const SourceSample sample = fed.sample();
  REQUIRE(sample.heard.size() == kMaxHeard);
  CHECK(sample.stampedByHost);
  CHECK(sample.atNs == beganNs + 299 * 20 * kMs);
  for (size_t i = 0; i < kMaxHeard; ++i) {
    const auto number = static_cast<int64_t>(frame - kMaxHeard + i);
    CHECK(sample.heard[i].pose.position.altM == 100.0 + static_cast<double>(number));
    CHECK(sample.heard[i].atNs == beganNs + number * 20 * kMs);
    CHECK(sample.heard[i].arrivedNs == beganNs + number * 20 * kMs + number % 3 * 7 * kMs);
  }
  CHECK(fed.sample().heard.empty());
}

TEST_CASE("live feed: by rates a pose goes on for a fifth of a second, DIS's until its time-out") {
  Fed<cigi::Receiver> fed(HostLock(), "test", silent(), OpenProbe{});
  cigi::Velocity climb;
  climb.zMS = -10;
  CHECK(fed.hear(cigiMessage(1, {cigiEntity(100), climb})));
  fed.nowNs += 10 * kMs;
  CHECK(fed.hear(cigiMessage(2, {})));
  const auto climbedM = [&](auto& feed, double inS) {
    return altitudeOf(feed.feed.sample(feed.nowNs + static_cast<int64_t>(inS * 1e9))) - 100;
  };
  CHECK(climbedM(fed, 0.1) == Approx(1.1).margin(1e-6));
  CHECK(climbedM(fed, 0.2) == Approx(2.1).margin(1e-6));
  CHECK(climbedM(fed, 5) == climbedM(fed, 0.2));

  Fed<DisReceiver> disFed(HostLock({}, kDisTimeOutNs), "test", std::nullopt);
  DisEntityState state = entity(100);
  state.deadReckoning = DeadReckoning::fpw;
  state.velocityMS = upAt(47, 8) * 10.0;
  CHECK(disFed.hear(buildDisEntityState(state)));
  CHECK(climbedM(disFed, 5) == Approx(50).margin(0.01));
  CHECK(climbedM(disFed, 60) == Approx(120).margin(0.01));
}

}  // namespace
}  // namespace eye
