// Several channels and one host: multicast groups and broadcast on the loopback, and frames that wait for the host.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <memory>

#include "link/cigi_host.h"
#include "link/sender.h"
#include "loopback.h"
#include "packets.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

using namespace eye::test;

constexpr const char* kGroup = "239.255.69.90";

std::vector<std::unique_ptr<StateSource>> channels(const std::string& url, size_t count) {
  std::vector<std::unique_ptr<StateSource>> opened;
  while (opened.size() < count) {
    auto source = openStateSource(url);
    INFO((source ? "" : source.error().message));
    REQUIRE(source);
    opened.push_back(std::move(*source));
  }
  return opened;
}

TEST_CASE("channels: any number hear one group or broadcast address, and each counts every packet") {
  const std::pair<std::string, std::string> places[] = {{kGroup, "?interface=127.0.0.1"}, {"127.255.255.255", ""}};
  for (const auto& [address, option] : places) {
    INFO(address);
    const uint16_t port = freePort();
    const auto heard = channels(fmt::format("native-fdm://{}:{}{}", address, port, option), 3);
    const auto socket = UdpSocket::connectTo({address, port}, option.empty() ? "" : "127.0.0.1");
    REQUIRE(socket);
    const auto poseAt = [](double t) { return Pose{{46.5, 7.9, 1000 + 10 * t}, 12, 3, -4}; };
    const SendReport report =
        sendPackets(packetsFromPoses(poseAt, 0.25, 200), *socket, {}, kNeverStop, [](const SendReport&) {});
    CHECK(report.failed == 0);
    for (const auto& channel : heard) {
      const SourceSample sample = waitFor(*channel, report.datagrams);
      CHECK(sample.counts.packets == 51);
      CHECK(sample.counts.rejected == 0);
      CHECK(sample.pose.position.altM == Approx(1002.5));
    }
  }
}

TEST_CASE("channels: a group is heard without naming a network, and one that is named is kept to") {
  const uint16_t port = freePort();
  const auto everywhere = openStateSource(fmt::format("native-fdm://{}:{}", kGroup, port));
  REQUIRE(everywhere);
  const auto other = openStateSource(fmt::format("native-fdm://239.255.69.91:{}", port));
  REQUIRE(other);
  const auto socket = UdpSocket::connectTo({kGroup, port}, "127.0.0.1");
  CHECK(socket->send(fdmPacket(0.8, 0.2, 500, 0, 0, 0, 0)) == SendOutcome::sent);
  CHECK(waitFor(**everywhere, 1).valid);
  CHECK((*other)->sample(0).counts.packets == 0);
}

TEST_CASE("channels: a network that is not there, or not of a group, is said so") {
  const std::pair<const char*, const char*> bad[] = {
      {"native-fdm://239.255.69.90:5550?interface=192.0.2.77", "no network interface has the address 192.0.2.77"},
      {"native-fdm://127.0.0.1:5550?interface=127.0.0.1", "for a multicast group"},
      {"cigi://239.255.69.90:5550?interface=nobody.invalid", "nobody.invalid"}};
  for (const auto& [url, part] : bad) {
    const auto source = openStateSource(url);
    REQUIRE_FALSE(source);
    INFO(source.error().message);
    CHECK(exitStatus(source.error()) == 2);
    CHECK(source.error().message.find(part) != std::string::npos);
  }
}

TEST_CASE("channels: one answers a group's host, the others are silent, and all know the host's frame") {
  const uint16_t port = freePort();
  const std::string url = fmt::format("cigi://{}:{}?interface=127.0.0.1", kGroup, port);
  auto all = channels(url + "&reply=none", 2);
  all.push_back(std::move(channels(url, 1)[0]));
  const auto socket = UdpSocket::connectTo({kGroup, port}, "127.0.0.1");
  cigi::ReplyListener replies(*socket);
  for (uint32_t number = 1; number <= 5; ++number) {
    CHECK(socket->send(cigi::hostMessage({3, 3}, {number, 0, 0, Pose{{46, 8, 1000}, 0, 0, 0}})) == SendOutcome::sent);
    for (const auto& channel : all) {
      CHECK(waitFor(*channel, number).hostFrame == number);
      channel->frameDone({});
    }
    CHECK(replies.awaitStart(2000));
  }
  CHECK_FALSE(replies.awaitStart(50));
  CHECK(replies.heard().starts == 5);
  CHECK(replies.heard().newest.hostFrame == 5u);
}

TEST_CASE("a frame can wait for the host's next message, and does not wait for one that it has not had") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(source);
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
  const Bytes packet = fdmPacket(0.8, 0.2, 500, 0, 0, 0, 0);
  CHECK_FALSE((*source)->await(10));
  for (int i = 0; i < 3; ++i) {
    CHECK(socket->send(packet) == SendOutcome::sent);  // the same pose again is news too
    CHECK((*source)->await(2000));
    CHECK((*source)->await(0));
    CHECK((*source)->sample(0).valid);
    CHECK_FALSE((*source)->await(0));
  }
  CHECK(socket->send(Bytes(5)) == SendOutcome::sent);
  CHECK_FALSE((*source)->await(50));
}

TEST_CASE("a synchronous host sends at most as often as it is told to") {
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, freePort()});
  SendOptions options;
  options.durationS = 0.5;
  const auto packets = [&](double leastS, bool isDemanded) {
    const auto packetAt = [](double, bool) { return std::optional(Bytes(16)); };
    const auto awaitDemand = [=](int timeoutMs) {
      if (!isDemanded) std::this_thread::sleep_for(std::chrono::milliseconds(timeoutMs));
      return isDemanded;
    };
    return sendOnDemand({packetAt, awaitDemand, leastS}, *socket, options, kNeverStop, [](const SendReport&) {})
        .packets;
  };
  const uint64_t limited = packets(0.02, true);
  CHECK((limited >= 20 && limited <= 26));
  CHECK(packets(0, true) > 200);
  CHECK(packets(0.02, false) == 1);
}

}  // namespace
}  // namespace eye
