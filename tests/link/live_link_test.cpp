// Over real sockets on the loopback: sender to state source, and what a bad link does.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <thread>

#include "geo/frames.h"
#include "link/native_fdm.h"
#include "link/sender.h"
#include "link/state_source.h"
#include "loopback.h"
#include "packets.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

using namespace eye::test;

TEST_CASE("every packet that is sent arrives, is counted, and the newest position is the packet's") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(source);
  CHECK((*source)->isLive());
  CHECK_FALSE((*source)->sample(0).valid);

  const auto poseAt = [](double t) { return Pose{{46.5 + 1e-3 * t, 7.9, 1000 + 10 * t}, 12, 3, -4}; };
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
  REQUIRE(socket);
  const int64_t beforeNs = monotonicNs();
  const SendReport report =
      sendPackets(packetsFromPoses(poseAt, 1.0, 200), *socket, {}, kNeverStop, [](const SendReport&) {});
  CHECK(report.packets == 201);
  CHECK(report.datagrams == 201);
  CHECK(report.failed == 0);
  CHECK(report.elapsedS >= 1.0);
  CHECK(report.elapsedS < 1.5);

  const SourceSample sample = waitFor(**source, 201);
  CHECK(sample.counts.packets == 201);
  CHECK(sample.counts.rejected == 0);
  REQUIRE(sample.valid);
  CHECK(sample.live);
  CHECK_FALSE(sample.finished);
  CHECK(glm::length(ecefFromGeodetic(sample.pose.position) - ecefFromGeodetic(poseAt(1).position)) < 1e-3);
  CHECK(sample.pose.rollDeg == Approx(-4).margin(1e-5));
  CHECK(sample.arrivedNs > beforeNs);
  CHECK(sample.arrivedNs <= monotonicNs());
}

TEST_CASE("bad packets are counted and leave the newest good state alone") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("native-fdm://127.0.0.1:{}", port));
  REQUIRE(source);
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
  const Bytes good = fdmPacket(0.8, 0.2, 500, 0, 0, 0, 15000.f);
  Bytes nan = good;
  putU(nan, 16, 0x7ff8000000000000, 8);
  CHECK(socket->send(good) == SendOutcome::sent);
  CHECK(socket->send(nan) == SendOutcome::sent);
  CHECK(socket->send({}) == SendOutcome::sent);
  CHECK(socket->send(Bytes(kMaxDatagramBytes)) == SendOutcome::sent);
  CHECK(socket->send(Bytes(kMaxDatagramBytes + 1)) == SendOutcome::failed);
  const SourceSample sample = waitFor(**source, 4);
  CHECK(sample.counts.packets == 4);
  CHECK(sample.counts.rejected == 3);
  CHECK(sample.pose.position.altM == 500);
  CHECK(sample.visibilityM == 15000.0);
}

TEST_CASE("a port that is taken is said so, with what to do") {
  const uint16_t port = freePort();
  const auto first = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(first);
  const auto second = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE_FALSE(second);
  CHECK(exitStatus(second.error()) == 1);
  CHECK(second.error().message.find(fmt::format("127.0.0.1:{} is taken", port)) != std::string::npos);
  CHECK(openStateSource("native-fdm://192.0.2.1:5550").error().message.find("no such address") != std::string::npos);
}

TEST_CASE("a link stops promptly, also under a flood") {
  const uint16_t port = freePort();
  auto source = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(source);
  std::jthread flood([port](const std::stop_token& stop) {
    const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
    const Bytes packet = fdmPacket(0.8, 0.2, 500, 0, 0, 0, 0);
    while (!stop.stop_requested()) {
      for (int i = 0; i < 200; ++i) (void)socket->send(packet);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  CHECK(waitFor(**source, 1000).counts.packets >= 1000);
  const int64_t beforeNs = monotonicNs();
  source->reset();
  CHECK(monotonicNs() - beforeNs < 500'000'000);
}

TEST_CASE("a sender without a listener goes on, and stops when asked") {
  std::atomic<bool> stop = false;
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, freePort()});
  const PacketSource source = packetsFromPoses([](double) { return Pose{}; }, 0, 100);
  SendOptions options;
  options.loop = true;
  int seconds = 0;
  const SendReport report = sendPackets(source, *socket, options, stop, [&](const SendReport& now) {
    ++seconds;
    CHECK(now.nobodyListens);
    stop = true;
  });
  CHECK(seconds == 1);
  CHECK(report.failed == 0);
  CHECK(report.packets >= 95);
  CHECK(report.packets <= 102);
}

TEST_CASE("a recording is sent with its own bytes and timing, again when looped") {
  std::vector<RecordedPacket> packets;
  for (int i = 0; i < 5; ++i) packets.push_back({i * i * 0.01, Bytes(static_cast<size_t>(10 + i))});
  const PacketSource source = packetsFromRecording(packets);
  CHECK(source.roundS == Approx(0.16 + 0.04));
  const auto listener = UdpSocket::listenOn({kLoopbackAddress, 0});
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, listener->port()});
  SendOptions options;
  options.loop = true;
  options.durationS = 0.39;
  const SendReport report = sendPackets(source, *socket, options, kNeverStop, [](const SendReport&) {});
  CHECK(report.packets == 10);
  Bytes buffer(kMaxDatagramBytes);
  for (size_t i = 0; i < 10; ++i) {
    REQUIRE(listener->wait(100));
    CHECK(listener->receive(buffer)->size() == 10 + i % 5);
  }
}

TEST_CASE("a bad link loses, doubles and delays its shares, the same for the same seed") {
  const auto fates = [](const BadLinkOptions& options) {
    BadLink link(options);
    std::vector<std::vector<int64_t>> all;
    for (int64_t i = 0; i < 20'000; ++i) all.push_back(link.departures(i * 1000, 1000));
    return all;
  };
  CHECK(fates({})[7] == std::vector<int64_t>{7000});
  const BadLinkOptions bad{0.0005, 0.1, 0.2, 0.3, 9};  // jitter of up to 500 ns
  const auto a = fates(bad);
  CHECK(a == fates(bad));
  BadLinkOptions otherSeed = bad;
  otherSeed.seed = 10;
  CHECK(a != fates(otherSeed));
  size_t lost = 0, twice = 0, late = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    lost += a[i].empty();
    twice += a[i].size() == 2;
    if (a[i].empty()) continue;
    const int64_t delayNs = a[i][0] - static_cast<int64_t>(i) * 1000;
    late += delayNs >= 1500;
    REQUIRE((delayNs < 500 || (delayNs >= 1500 && delayNs < 2000)));
  }
  CHECK(static_cast<double>(lost) == Approx(2000).epsilon(0.1));
  CHECK(static_cast<double>(twice) == Approx(0.2 * 18000).epsilon(0.1));
  CHECK(static_cast<double>(late) == Approx(0.3 * 18000).epsilon(0.1));
  CHECK_FALSE(checkBadLink({0, 1.5, 0, 0, 1}));
  CHECK_FALSE(checkBadLink({-1, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace eye
