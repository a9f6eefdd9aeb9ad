// CIGI over real sockets on the loopback: what comes back, and what strangers cannot do.
#include <fmt/format.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "dissection.h"
#include "link/cigi_host.h"
#include "link/cigi_replies.h"
#include "link/host_lock.h"
#include "link/sender.h"
#include "link/state_source.h"
#include "loopback.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

using namespace eye::test;
using namespace eye::cigi;
using std::chrono::milliseconds;

Pose poseNumber(uint32_t i) {
  return {{46 + 1e-4 * i, 8, 1000.0 + i}, 10, 2, -3};
}

TEST_CASE("CIGI over UDP: every message arrives, is counted, and Starts of Frame come back in the host's version") {
  for (const Version version : {Version{3, 3}, Version{4, 0}}) {
    const uint16_t port = freePort();
    const auto source = openStateSource(fmt::format("cigi://:{}", port));
    REQUIRE(source);
    CHECK((*source)->isLive());
    (*source)->frameDone({});  // nobody to tell
    const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
    ReplyListener replies(*socket);
    const auto poseAt = [](double t) { return poseNumber(static_cast<uint32_t>(std::lround(t * 200))); };
    const SendReport report =
        sendPackets(cigiPacketsFromPoses(poseAt, 0.5, 200, version, [&] { return replies.igFrame(); }), *socket, {},
                    kNeverStop, [](const SendReport&) {});
    CHECK(report.packets == 101);
    REQUIRE(report.pose);
    CHECK(report.pose->position == poseNumber(100).position);
    const SourceSample sample = waitFor(**source, 101);
    CHECK((sample.counts.packets == 101 && sample.counts.rejected == 0 && sample.counts.lost == 0));
    REQUIRE(sample.valid);
    CHECK(sample.pose.position == poseNumber(100).position);

    for (int i = 0; i < 5; ++i) {
      (*source)->frameDone({i == 4, i == 3});
      CHECK(replies.awaitStart(2000));
    }
    const HeardReplies heard = replies.heard();
    CHECK(heard.starts == 5);
    CHECK(heard.notUnderstood == 0);
    CHECK(heard.newest.igFrame == 5);  // the sixth: the first had no receiver
    CHECK(heard.newest.hostFrame == 100u);
    CHECK(heard.newest.mode == IgMode::operate);
    CHECK(heard.newest.ticks);
    CHECK(heard.overframings == (version.major == 4 ? 1u : 0u));
    CHECK(heard.pagings == (version.major == 4 ? 1u : 0u));
  }
}

TEST_CASE("CIGI replies: Wireshark reads the Start of Frame that was meant, in either byte order") {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    Replies replies(std::nullopt, std::nullopt);
    IgControl control;
    control.mode = IgMode::operate;
    control.hostFrame = 4711;
    control.databaseNumber = 3;
    replies.heard({0x7f000001, 9000}, {{3, 3}, order}, control, 5'000'000'000);
    REQUIRE(replies.answer(HeightResponse{12, true, 7, 345.5}));
    const auto loading = replies.frame({true, true}, 4711, 5'000'120'000);
    const auto loaded = replies.frame({false, false}, 4711, 5'016'000'000);
    REQUIRE((loading && loaded));
    CHECK(loading->receiver == Peer{0x7f000001, 9000});
    const auto text =
        tsharkVerbose(captureOf({loading->message, loaded->message}, 8005), "udp.port==8005,cigi", "cigi");
    if (!text) {
      WARN("not tested: no tshark");
      return;
    }
    const auto packets = dissectedPackets(*text);
    REQUIRE(packets.size() == 3);
    CHECK(packets[0].name == "Start of Frame");
    auto fields = packets[0].fields;
    CHECK(fields["Database Number"] == -3);
    CHECK(fields["IG Mode"] == 1);
    CHECK(fields["IG Frame Number"] == 0);
    CHECK(fields["Last Host Frame Number"] == 4711);
    CHECK(fields["Timestamp Valid"] == 1);
    CHECK(fields["Timestamp (microseconds)"] == 500012);  // of 10 microseconds, whatever its label says
    CHECK(packets[1].fields.at("Height") == 345.5);
    fields = packets[2].fields;
    CHECK(fields["Database Number"] == 3);
    CHECK(fields["IG Frame Number"] == 1);
  }
}

TEST_CASE("CIGI replies: the handshake of databases, the end of a silent host, and bounded answers") {
  Replies replies(std::nullopt, int8_t{5});
  const Peer host{1, 2};
  const auto number = [&](const FrameReport& report, int64_t nowNs) {
    const auto reply = replies.frame(report, {}, nowNs);
    return reply ? std::get<StartOfFrame>(parse(reply->message)->packets.at(0)).databaseNumber : int8_t{99};
  };
  IgControl control;
  control.mode = IgMode::standby;
  control.databaseNumber = 5;
  replies.heard(host, {}, control, 1);
  CHECK(number({false, true}, 1) == 5);  // standby: not asked for
  control.mode = IgMode::operate;
  replies.heard(host, {}, control, 1);
  CHECK(number({false, true}, 1) == -5);
  CHECK(number({false, false}, 1) == 5);
  CHECK(number({false, true}, 1) == 5);  // loaded once
  control.databaseNumber = 0;
  replies.heard(host, {}, control, 1);
  CHECK(number({false, true}, 1) == 5);
  control.databaseNumber = 6;
  replies.heard(host, {}, control, 1);
  CHECK(number({}, 1) == -128);
  CHECK(number({}, 5'000'000'002) == 99);  // silent
  // Another host has asked for nothing yet.
  control.databaseNumber = 0;
  replies.heard(Peer{5, 6}, {}, control, 5'000'000'003);
  CHECK(number({}, 5'000'000'003) == 5);
  replies.heard(host, {}, control, 1);
  Replies fixed(Peer{3, 4}, std::nullopt);
  CHECK(fixed.frame({}, {}, 0)->receiver == Peer{3, 4});  // before any host

  control.databaseNumber = 0;
  size_t taken = 0;
  for (int i = 0; i < 5000; ++i) taken += replies.answer(HeightExtendedResponse{});
  CHECK(taken == kMaxAnswers);
  replies.heard(host, {}, control, 1);
  size_t sent = 0, messages = 0;
  while (sent < kMaxAnswers && messages < 100) {
    const auto message = replies.frame({}, {}, 1)->message;
    CHECK(message.size() <= kMaxLongMessageBytes);
    sent += parse(message)->packets.size() - 1;
    ++messages;
  }
  CHECK(sent == kMaxAnswers);
  CHECK(messages <= 4);  // more than a thousand in each
  replies.answer(HeightExtendedResponse{});
  replies.heard({9, 9}, {}, control, 1);  // another host: not its questions
  CHECK(parse(replies.frame({}, {}, 1)->message)->packets.size() == 1);
}

TEST_CASE("a host holds the lock while it speaks, and no longer") {
  HostLock lock;
  const Peer first{1, 1}, second{1, 2};
  CHECK((lock.mayPass(first, 0) && lock.heard(first, 0)));
  CHECK_FALSE(lock.heard(first, kHostSilenceNs));
  CHECK_FALSE(lock.mayPass(second, 2 * kHostSilenceNs));
  CHECK(lock.mayPass(second, 2 * kHostSilenceNs + 1));
  CHECK(lock.heard(second, 2 * kHostSilenceNs + 1));
  CHECK_FALSE(lock.mayPass(first, 2 * kHostSilenceNs + 2));
}

TEST_CASE("CIGI over UDP: garbage between, a second host and addresses that are not allowed change nothing") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("cigi://:{}?allow=127.0.0.1", port));
  REQUIRE(source);
  const auto host = UdpSocket::connectTo({kLoopbackAddress, port});
  const auto stranger = UdpSocket::connectTo({kLoopbackAddress, port});
  std::mt19937_64 random(1);
  // Garbage of a stranger takes no lock.
  CHECK(stranger->send(Bytes(100)) == SendOutcome::sent);
  (void)waitFor(**source, 1);
  uint64_t sent = 1;
  for (uint32_t i = 0; i < 100; ++i) {
    CHECK(host->send(hostMessage({3, 3}, {i, 0, 0, poseNumber(i)})) == SendOutcome::sent);
    for (int k = 0; k < 5; ++k) {
      Bytes bytes = hostMessage({4, 0}, {i, 0, 0, poseNumber(7)});
      if (k < 3) damage(bytes, random);
      CHECK(stranger->send(bytes) == SendOutcome::sent);
    }
    sent += 6;
    if (i % 10 == 9) (void)waitFor(**source, sent);  // the socket's buffer is finite
  }
  CHECK(host->send(Bytes(kMaxDatagramBytes)) == SendOutcome::sent);
  const SourceSample sample = waitFor(**source, sent + 1);
  CHECK(sample.counts.packets == sent + 1);
  CHECK(sample.counts.rejected == sent + 1 - 100);
  CHECK(sample.counts.lost == 0);
  CHECK(sample.pose.position == poseNumber(99).position);

  const uint16_t other = freePort();
  const auto closed = openStateSource(fmt::format("cigi://:{}?allow=192.0.2.1,192.0.2.2", other));
  REQUIRE(closed);
  CHECK(UdpSocket::connectTo({kLoopbackAddress, other})->send(hostMessage({3, 3}, {})) == SendOutcome::sent);
  CHECK(waitFor(**closed, 1).counts.rejected == 1);
  CHECK_FALSE((*closed)->sample(0).valid);
}

TEST_CASE("CIGI over UDP: questions come back as not valid where nobody knows the ground") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("cigi://:{}", port));
  const auto host = UdpSocket::connectTo({kLoopbackAddress, port});
  ReplyListener replies(*host);
  IgControl control;
  control.mode = IgMode::operate;
  Builder builder(Format{}, control);
  REQUIRE(builder.add(HeightRequest{1, HeightKind::both, 0, 0, Geodetic{1, 2, 3}}));
  REQUIRE(builder.add(SightVectorRequest{}));
  CHECK(host->send(builder.take()) == SendOutcome::sent);
  (void)waitFor(**source, 1);
  std::this_thread::sleep_for(milliseconds(50));
  (*source)->frameDone({});
  CHECK(replies.awaitStart(2000));
  CHECK(replies.heard().heights == 1);
  CHECK(replies.heard().sights == 1);
}

TEST_CASE("CIGI over UDP: a cloud layer of a Weather packet reaches the sample, and goes when it is switched off") {
  for (const Version version : {Version{3, 3}, Version{4, 0}}) {
    const uint16_t port = freePort();
    const auto source = openStateSource(fmt::format("cigi://:{}", port));
    const auto host = UdpSocket::connectTo({kLoopbackAddress, port});
    uint32_t number = 0;
    const auto says = [&](const Weather& weather) {
      IgControl control;
      control.mode = IgMode::operate;
      control.hostFrame = number++;
      Builder builder(Format{version, std::endian::big}, control);
      REQUIRE(builder.add(weather));
      CHECK(host->send(builder.take()) == SendOutcome::sent);
      return waitFor(**source, number).clouds;
    };
    Weather cloud;
    cloud.enabled = true;
    cloud.layer = 2;
    cloud.baseM = 1500, cloud.thicknessM = 400, cloud.transitionM = 60, cloud.coveragePercent = 75;
    const CloudLayer told{1500, 1900, 60, 60, 0.75};
    CHECK(says(cloud) == CloudLayers{CloudLayer{}, told, CloudLayer{}});
    Weather fog = cloud;
    fog.layer = 0;  // no cloud: nothing to be seen from outside
    CHECK(says(fog)[1] == told);
    Weather ofRegion = cloud;
    ofRegion.scope = Scope::region, ofRegion.layer = 1;
    CHECK(says(ofRegion)[0] == CloudLayer{});
    cloud.enabled = false;
    CHECK(says(cloud) == CloudLayers{});
  }
}

TEST_CASE("CIGI over UDP: a synchronous host sends a frame for each Start of Frame, and begins by itself") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("cigi://:{}", port));
  std::atomic<bool> stop = false;
  std::jthread frames([&] {
    while (!stop) {
      (void)(*source)->sample(0);
      (*source)->frameDone({});
      std::this_thread::sleep_for(milliseconds(20));
    }
  });
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
  ReplyListener replies(*socket);
  uint32_t number = 0;
  const auto packetAt = [&](double timeS, bool) -> std::optional<Bytes> {
    return hostMessage({3, 3}, {number++, replies.igFrame(), timeS, poseNumber(number)});
  };
  SendOptions options;
  options.durationS = 1;
  const SendReport report = sendOnDemand({packetAt, [&](int ms) { return replies.awaitStart(ms); }}, *socket, options,
                                         kNeverStop, [](const SendReport&) {});
  const uint64_t starts = replies.heard().starts;
  stop = true;
  CHECK(starts >= 20);
  CHECK(report.packets >= starts - 2);
  CHECK(report.packets <= starts + 2);
}

TEST_CASE("CIGI over UDP: hosts, strangers, frames and questions at once, from four threads") {
  const uint16_t port = freePort();
  std::atomic<int> asked = 0;
  class Flat : public GroundProbe {
   public:
    explicit Flat(std::atomic<int>& count) : count_(count) {}
    std::optional<GroundPoint> under(double latDeg, double lonDeg) override {
      ++count_;
      return GroundPoint{{latDeg, lonDeg, 0}, upAt(latDeg, lonDeg)};
    }
    Result<std::optional<GroundPoint>> between(const Vec3d&, const Vec3d&) override { return std::nullopt; }

   private:
    std::atomic<int>& count_;
  };
  auto source = openStateSource(fmt::format("cigi://:{}", port), [&]() -> Result<std::unique_ptr<GroundProbe>> {
    return std::make_unique<Flat>(asked);
  });
  REQUIRE(source);
  std::atomic<bool> stop = false;
  const auto sender = [&](uint64_t seed, bool honest) {
    const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
    std::mt19937_64 random(seed);
    for (uint32_t i = 0; !stop; ++i) {
      IgControl control;
      control.mode = IgMode::operate;
      control.hostFrame = i;
      Builder builder(Format{{honest ? uint8_t{3} : uint8_t{4}, honest ? uint8_t{3} : uint8_t{0}}, std::endian::little},
                      control);
      builder.add(Entity{0, EntityTraits{}, EntityPlace{Clamp::none, 0, 0, 0, 0, poseNumber(i % 100).position}});
      builder.add(HeightRequest{1, HeightKind::ofTerrain, 0, 0, Geodetic{1, 2, 3}});
      Bytes bytes = builder.take();
      if (!honest) damage(bytes, random);
      (void)socket->send(bytes);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  };
  std::jthread first(sender, 1, true), second(sender, 2, false), third(sender, 3, false);
  uint64_t last = 0;
  for (int i = 0; i < 500; ++i) {
    const SourceSample sample = (*source)->sample(0);
    CHECK(sample.counts.packets >= last);
    last = sample.counts.packets;
    if (sample.valid) CHECK(std::abs(sample.pose.position.latDeg) <= 90);
    (*source)->frameDone({i % 2 == 0, i % 3 == 0});
    std::this_thread::sleep_for(milliseconds(1));
  }
  source->reset();  // in the middle of it
  stop = true;
  CHECK(last > 500);
  CHECK(asked > 10);
}

}  // namespace
}  // namespace eye
