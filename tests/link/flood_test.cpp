// Floods of datagrams: what is read of them, what the system drops for us, and that whoever may speak is heard.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "link/dis.h"
#include "link/flood_gauge.h"
#include "link/host_lock.h"
#include "link/native_fdm.h"
#include "loopback.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

using namespace eye::test;
using Bytes = std::vector<std::byte>;

constexpr int64_t kMs = 1'000'000;

Bytes fdm(double altM) {
  return buildNativeFdm({{{47, 8, altM}, 30, 2, -3}, std::nullopt});
}

// Sends one datagram over and over, `burst` of them each millisecond, from a socket and so a port of its own.
class Torrent {
 public:
  Torrent(uint16_t port, Bytes datagram, int burst)
      : thread_([=, datagram = std::move(datagram)](const std::stop_token& stop) {
          const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
          while (!stop.stop_requested()) {
            for (int i = 0; i < burst; ++i) (void)socket->send(datagram);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }) {}

 private:
  std::jthread thread_;
};

// Looks at the source until it is as wanted, for at most so long.
template <class Wanted>
SourceSample await(StateSource& source, int64_t mostMs, const Wanted& wanted) {
  const int64_t untilNs = monotonicNs() + mostMs * kMs;
  SourceSample sample = source.sample(0);
  while (!wanted(sample) && monotonicNs() < untilNs) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    sample = source.sample(0);
  }
  return sample;
}

TEST_CASE("flood gauge: on within a window of a flood, off after one without") {
  FloodGauge gauge;
  int64_t nowNs = 1000 * kMs;
  const auto pass = [&](int ms, int64_t each) {
    for (int i = 0; i < ms; ++i) gauge.count(each, nowNs += kMs);
  };
  pass(1000, 1);  // a thousand a second
  CHECK_FALSE(gauge.isOn());
  pass(3, 60);
  CHECK(gauge.isOn());
  pass(1000, 6);
  CHECK(gauge.isOn());
  pass(60, 1);
  CHECK_FALSE(gauge.isOn());
}

TEST_CASE("host lock: a host is the only one for half of the silence that frees its place") {
  constexpr Peer kHost{0x7f000001, 1000};
  HostLock lock;
  CHECK_FALSE(lock.speaker(0));
  lock.heard(kHost, 1000 * kMs);
  CHECK(lock.speaker(1000 * kMs) == kHost);
  CHECK(lock.speaker(1000 * kMs + kHostSilenceNs / 2) == kHost);
  CHECK_FALSE(lock.speaker(1000 * kMs + kHostSilenceNs / 2 + 1));
}

TEST_CASE("UDP: a socket that admits one sender drops and counts the others, until it admits everyone") {
  const auto listener = UdpSocket::listenOn({kLoopbackAddress, 0});
  const Endpoint place{kLoopbackAddress, listener->port()};
  const auto host = UdpSocket::connectTo(place), stranger = UdpSocket::connectTo(place);
  const auto heard = [&] {
    Bytes buffer(kMaxDatagramBytes), all;
    while (const auto datagram = listener->receive(buffer)) all.insert(all.end(), datagram->begin(), datagram->end());
    return all;
  };
  const auto bothSpeak = [&](int number) {
    (void)stranger->send(Bytes{static_cast<std::byte>(100 + number)});
    (void)host->send(Bytes{static_cast<std::byte>(number)});
    return heard();
  };
  constexpr uint32_t kLoopback = 0x7f000001;
  CHECK(bothSpeak(1).size() == 2);
  REQUIRE(listener->admitOnly(Peer{kLoopback, host->port()}));
  CHECK(bothSpeak(2) == Bytes{std::byte{2}});
  CHECK(listener->dropped() == 1);
  REQUIRE(listener->admitOnly(Peer{kLoopback, stranger->port()}));
  CHECK(bothSpeak(3) == Bytes{std::byte{103}});
  REQUIRE(listener->admitOnly(Peer{kLoopback + 1, host->port()}));  // the same port of another machine
  CHECK(bothSpeak(4).empty());
  listener->admitEveryone();
  CHECK(bothSpeak(5).size() == 2);
  CHECK(listener->dropped() == 4);
}

TEST_CASE("a stranger's flood is dropped unread while the host speaks, and heard when that has been silent") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(source);
  const auto altitudeIs = [](double altM) {
    return [altM](const SourceSample& sample) { return sample.valid && sample.pose.position.altM == altM; };
  };
  const auto host = UdpSocket::connectTo({kLoopbackAddress, port});
  (void)host->send(fdm(100));
  REQUIRE(await(**source, 2000, altitudeIs(100)).valid);

  const Torrent torrent(port, fdm(900), 20);
  int64_t lastNs = 0;
  SourceSample sample;
  for (int i = 1; i <= 100; ++i) {
    lastNs = monotonicNs();
    (void)host->send(fdm(100 + i));
    sample = await(**source, 2000, altitudeIs(100 + i));
    REQUIRE(sample.pose.position.altM == 100 + i);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  CHECK(sample.counts.rejected >= 1000);  // that it is a flood is told from those that were read
  CHECK(sample.counts.rejected < sample.counts.unread / 8);
  const SourceSample later =
      await(**source, 2000, [&](const SourceSample& s) { return s.counts.unread >= sample.counts.unread + 200; });
  CHECK(later.counts.unread >= sample.counts.unread + 200);

  sample = await(**source, 10'000, altitudeIs(900));
  CHECK(sample.pose.position.altM == 900);
  CHECK(sample.arrivedNs - lastNs > kHostSilenceNs);
  CHECK(sample.arrivedNs - lastNs < kHostSilenceNs + 200 * kMs);  // of 20 a millisecond one of the first
}

TEST_CASE("what the system drops of a flood is no longer dropped when the flood is over") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(source);
  const auto host = UdpSocket::connectTo({kLoopbackAddress, port});
  const auto stranger = UdpSocket::connectTo({kLoopbackAddress, port});
  (void)host->send(fdm(100));
  SourceSample sample = waitFor(**source, 1);
  REQUIRE(sample.valid);
  const auto speakUntil = [&](const auto& wanted) {
    for (int i = 0; i < 200; ++i) {
      (void)host->send(fdm(100));
      sample = await(**source, 10, wanted);
      if (wanted(sample)) return true;
    }
    return false;
  };
  {
    const Torrent torrent(port, fdm(900), 20);
    REQUIRE(speakUntil([](const SourceSample& s) { return s.counts.unread > 100; }));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const uint64_t rejected = (*source)->sample(0).counts.rejected;
  CHECK(speakUntil([&](const SourceSample& s) {
    (void)stranger->send(fdm(900));
    return s.counts.rejected > rejected;
  }));
}

TEST_CASE("DIS: many senders are no flood of strangers") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("dis://:{}", port));
  REQUIRE(source);
  DisEntityState first, second;
  first.site = 1, first.application = 2, first.entity = 3;
  first.pose = {{47, 8, 3000}, 30, 10, -20};
  second = first;
  second.entity = 4;
  const auto host = UdpSocket::connectTo({kLoopbackAddress, port});
  (void)host->send(buildDisEntityState(first));
  REQUIRE(waitFor(**source, 1).valid);
  const Torrent passedOver(port, buildDisEntityState(second), 10), refused(port, buildDisEntityState(first), 10);
  CHECK(waitFor(**source, 2000).counts.packets >= 2000);
  CHECK((*source)->sample(0).counts.unread == 0);
}

TEST_CASE("what a host sends is read and counted to the last datagram, up to 28,000 a second") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(source);
  const auto host = UdpSocket::connectTo({kLoopbackAddress, port});
  constexpr int kBursts = 400, kBurst = 28;
  for (int i = 0; i < kBursts; ++i) {
    for (int k = 0; k < kBurst; ++k) (void)host->send(k == 0 ? Bytes(3) : fdm(i));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const SourceSample sample = waitFor(**source, kBursts * kBurst);
  CHECK(sample.counts.packets + sample.counts.unread == kBursts * kBurst);
  CHECK(sample.counts.unread < kBursts * kBurst / 5);  // for want of room, on a busy machine
  CHECK(sample.counts.rejected <= kBursts);
  CHECK(sample.counts.rejected > kBursts / 2);
}

TEST_CASE("of a host's own flood no more than a batch in two milliseconds is read, and its state is young") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(source);
  const int64_t beganNs = monotonicNs();
  const auto ageMs = [&] { return static_cast<double>(monotonicNs() - beganNs) * 1e-6; };
  const std::jthread host([&](const std::stop_token& stop) {
    const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
    while (!stop.stop_requested()) {
      const Bytes datagram = fdm(ageMs());  // how high it is, is when it left
      for (int i = 0; i < 100; ++i) (void)socket->send(datagram);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  REQUIRE((*source)->await(2000));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const int64_t fromNs = monotonicNs();
  const HostCounts before = (*source)->sample(0).counts;
  int looked = 0, young = 0;
  for (; monotonicNs() < fromNs + 1000 * kMs; ++looked) {
    young += ageMs() - (*source)->sample(0).pose.position.altM < 100;
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  const HostCounts after = (*source)->sample(0).counts;
  const double spanS = static_cast<double>(monotonicNs() - fromNs) * 1e-9;
  // What one that was kept from running may make up for: 40 ms.
  CHECK(static_cast<double>(after.packets - before.packets) < 32'000 * (spanS + 0.04) + 64);
  CHECK(after.packets - before.packets > 5'000);
  CHECK(after.unread - before.unread > 5'000);
  CHECK(after.rejected == 0);
  CAPTURE(looked, young);
  CHECK(young > looked * 9 / 10);
}

TEST_CASE("garbage in floods is dropped unread, whoever sends it, and a host's states among its own are not") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(source);
  {
    const Torrent nobodyYet(port, Bytes(300), 30);
    const SourceSample flooded =
        await(**source, 2000, [](const SourceSample& s) { return s.counts.unread > s.counts.rejected; });
    CHECK(flooded.counts.rejected >= 1000);  // the first ones are refused with their reason
    CHECK(flooded.counts.unread > flooded.counts.rejected);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // over

  const auto host = UdpSocket::connectTo({kLoopbackAddress, port});
  const uint64_t rejected = (*source)->sample(0).counts.rejected;
  (void)host->send(Bytes(300));
  CHECK(await(**source, 1000, [&](const SourceSample& s) {
          return s.counts.rejected == rejected + 1;
        }).counts.rejected == rejected + 1);

  constexpr int kStates = 100, kLearning = 20;
  int shown = 0;
  for (int i = 0; i < kStates; ++i) {
    (void)host->send(fdm(100 + i));
    const int64_t untilNs = monotonicNs() + 10 * kMs;
    bool isShown = false;
    for (int k = 0; monotonicNs() < untilNs; ++k) {
      for (int n = 0; n < 100; ++n) (void)host->send(Bytes(300));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      isShown = isShown || (*source)->sample(0).pose.position.altM == 100 + i;
    }
    shown += isShown && i >= kLearning;
  }
  CHECK(shown >= (kStates - kLearning) * 8 / 10);
  const HostCounts counts = (*source)->sample(0).counts;
  CHECK(counts.unread > 10 * (counts.rejected - rejected));
}

}  // namespace
}  // namespace eye
