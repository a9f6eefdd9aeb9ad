// Floods of datagrams: how they are told from a busy host, and that they are counted.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "link/flood_gauge.h"
#include "link/native_fdm.h"
#include "loopback.h"

namespace eye {
namespace {

using namespace eye::test;
using Bytes = std::vector<std::byte>;

constexpr int64_t kMs = 1'000'000;

Bytes fdm(double altM) {
  return buildNativeFdm({{{47, 8, altM}, 30, 2, -3}, std::nullopt});
}

TEST_CASE("flood gauge: on within a window of a flood, off after one without") {
  FloodGauge gauge;
  int64_t nowNs = 1000 * kMs;
  const auto pass = [&](int ms, uint64_t each) {
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

TEST_CASE("a host's own flood is read and counted to the last datagram") {
  const uint16_t port = freePort();
  const auto source = openStateSource(fmt::format("native-fdm://:{}", port));
  REQUIRE(source);
  const auto host = UdpSocket::connectTo({kLoopbackAddress, port});
  constexpr int kBursts = 200, kBurst = 40;
  for (int i = 0; i < kBursts; ++i) {
    for (int k = 0; k < kBurst; ++k) (void)host->send(k == 0 ? fdm(i) : Bytes(static_cast<size_t>(k)));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const SourceSample sample = waitFor(**source, kBursts * kBurst);
  CHECK(sample.counts.packets == kBursts * kBurst);
  CHECK(sample.counts.rejected >= sample.counts.packets - kBursts);
}

}  // namespace
}  // namespace eye
