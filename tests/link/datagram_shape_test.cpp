// The least that a protocol's datagrams look like: nothing that is believed is without it, and the system's filter sees
// it as we do.
#include "link/datagram_shape.h"

#include <catch2/catch.hpp>

#include <numbers>

#include "cigi_random.h"
#include "link/cigi_host.h"
#include "link/cigi_receiver.h"
#include "link/native_fdm.h"
#include "link/pcap.h"
#include "link/track_file.h"
#include "link/udp_socket.h"
#include "link/xplane.h"
#include "packets.h"
#include "support/places.h"

namespace eye {
namespace {

using namespace eye::test;

struct Protocol {
  std::string name;
  std::span<const DatagramShape> shapes;
  std::function<bool(std::span<const std::byte>)> believes;
};

Protocol fdm() {
  return {"native-fdm", nativeFdmShapes(), [](auto bytes) { return parseNativeFdm(bytes).has_value(); }};
}
Protocol cigiHost() {
  return {"CIGI", cigi::hostShapes(),
          [receiver = std::make_shared<cigi::Receiver>("test", cigi::ReceiverOptions{}, OpenProbe{})](auto bytes) {
            return receiver->parse(bytes).has_value();
          }};
}
Protocol xplane() {
  return {"X-Plane", rposShapes(), [](auto bytes) { return parseRpos(bytes).has_value(); }};
}

// Of a capture, every `nth`; nothing, with a warning, where there is none.
void addCaptured(std::vector<Bytes>& all, const std::string& name, size_t nth) {
  const auto file = readTrackFile(eye::test::kTestData + "/" + name);
  if (!file) {
    WARN("not tested: " << file.error().message);
    return;
  }
  const auto capture = parsePcap(*file);
  REQUIRE(capture);
  for (size_t i = 0; i < capture->datagrams.size(); i += nth) {
    const auto& payload = capture->datagrams[i].payload;
    all.emplace_back(payload.begin(), payload.end());
  }
}

std::vector<Bytes> captured(size_t nth) {
  std::vector<Bytes> all;
  for (const char* name : {"captures/jsbsim_c1723_takeoff.pcap", "captures/jsbsim_737_cruise.pcap",
                           "captures/cigi33_ccl_c1723.pcap", "captures/cigi40_ccl_c1723.pcap", "cigi/cigi2.pcap"})
    addCaptured(all, name, nth);
  return all;
}

// What lies at the edges of what is believed, and messages of every format.
std::vector<Bytes> made() {
  constexpr double kPi = std::numbers::pi;
  std::vector<Bytes> all;
  for (const double sign : {-1.0, 1.0}) {
    const auto s = static_cast<float>(sign);
    all.push_back(fdmPacket(sign * kPi / 2, sign * 2 * kPi, sign > 0 ? 1e8 : -1000, s * 1000, s * 1000, s * 1000, 0));
    all.push_back(fdmPacket(sign * std::nextafter(kPi / 2, 2), sign * std::nextafter(2 * kPi, 7), 0, 0, 0, 0, 0));
    all.push_back(fdmPacket(sign * 1.6, 0, 0, 0, 0, 0, 0));
    all.push_back(fdmPacket(0, 0, 0, s * 1001, 0, 0, 0));
  }
  all.push_back(fdmPacket(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0, 0, 0, 0));
  Bytes v25 = fdmPacket(0.5, -1, 3000, 0.1f, 0.2f, 3, 0);
  putU(v25, 0, 25, 4);
  v25.resize(kNativeFdmBytesV25);
  all.push_back(v25);
  RposState rpos;
  rpos.pose = {{47, 8, 3000}, 30, 10, -20};
  all.push_back(buildRpos(rpos));
  for (const cigi::Format& format : cigiFormats()) {
    RandomCigi random(7, format.version);
    for (int i = 0; i < 50; ++i) {
      cigi::Builder host(format, random.igControl());
      (void)host.add(random.packet(1 + static_cast<size_t>(i) % 11));
      all.push_back(host.take());
    }
    all.push_back(cigi::Builder(format, random.startOfFrame()).take());
  }
  for (size_t bytes = 0; bytes < 64; ++bytes) all.emplace_back(bytes);
  return all;
}

// How many were believed; all of them must have a shape.
size_t checkBelieved(const Protocol& protocol, const std::vector<Bytes>& all) {
  size_t believed = 0;
  for (const Bytes& datagram : all)
    if (protocol.believes(datagram)) {
      ++believed;
      REQUIRE(looksLikeAny(protocol.shapes, datagram));
    }
  return believed;
}

TEST_CASE("shapes: every datagram that is believed has one") {
  const std::vector<Bytes> recorded = captured(1), own = made();
  std::vector<Bytes> damaged;
  std::mt19937_64 random(3);
  for (int i = 0; i < 200'000; ++i) {
    damaged.push_back(own[random() % own.size()]);
    damage(damaged.back(), random);
  }
  for (const Protocol& protocol : {fdm(), cigiHost(), xplane()}) {
    INFO(protocol.name);
    CHECK(checkBelieved(protocol, recorded) >= (recorded.size() > 20'000 && protocol.name != "X-Plane" ? 7200 : 0));
    CHECK(checkBelieved(protocol, own) > 0);
    CHECK(checkBelieved(protocol, damaged) > 100);
  }
}

TEST_CASE("shapes: most garbage has none, also garbage behind a true beginning") {
  std::mt19937_64 random(5);
  const auto passed = [&](const Protocol& protocol, const Bytes& begin, size_t kept) {
    int count = 0;
    for (int i = 0; i < 10'000; ++i) {
      Bytes bytes = begin;
      for (size_t k = kept; k < bytes.size(); ++k) bytes[k] = static_cast<std::byte>(random() & 0xff);
      count += looksLikeAny(protocol.shapes, bytes);
    }
    return count;
  };
  const Bytes state = fdmPacket(0.8, 0.1, 3000, 0, 0, 0, 0), message = cigi::hostMessage({3, 3}, {1, 0, 0, Pose{}});
  CHECK(passed(fdm(), state, 0) == 0);
  CHECK(passed(fdm(), state, 4) < 300);
  CHECK(passed(cigiHost(), message, 0) < 5);
  CHECK(passed(cigiHost(), message, 5) < 5);
}

TEST_CASE("UDP: the system's filter admits what has a shape, of the sender if one is given, and nothing else") {
  std::vector<Bytes> all = captured(50);
  for (const Bytes& datagram : made()) all.push_back(datagram);
  std::mt19937_64 random(4);
  for (size_t i = 0, count = all.size(); i < count; ++i) {
    all.push_back(all[i]);
    damage(all.back(), random);
  }
  const auto listener = UdpSocket::listenOn({kLoopbackAddress, 0});
  const Endpoint place{kLoopbackAddress, listener->port()};
  const auto host = UdpSocket::connectTo(place), stranger = UdpSocket::connectTo(place);
  Bytes buffer(kMaxDatagramBytes);
  const auto arrives = [&](const UdpSocket& from, const Bytes& datagram) {
    (void)from.send(datagram);
    return listener->receive(buffer).has_value();
  };
  const Peer hostPeer{0x7f000001, host->port()};
  for (const Protocol& protocol : {fdm(), cigiHost(), xplane()}) {
    INFO(protocol.name);
    size_t admitted = 0;
    REQUIRE(listener->admitOnly(std::nullopt, protocol.shapes));
    for (const Bytes& datagram : all) {
      const bool isShaped = looksLikeAny(protocol.shapes, datagram);
      REQUIRE(arrives(*stranger, datagram) == isShaped);
      admitted += isShaped;
    }
    CHECK(admitted > 0);
    CHECK(admitted < all.size());
    REQUIRE(listener->admitOnly(hostPeer, protocol.shapes));
    for (const Bytes& datagram : all) {
      REQUIRE(arrives(*host, datagram) == looksLikeAny(protocol.shapes, datagram));
      REQUIRE_FALSE(arrives(*stranger, datagram));
    }
  }
}

}  // namespace
}  // namespace eye
