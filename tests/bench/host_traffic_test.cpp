// The floods and hosts of the host suite against the sources alone: what a flood cannot do to whoever listens.
#include "bench/host_traffic.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>

#include <unistd.h>

#include "link/state_source.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

double residentMiB() {
  std::ifstream statm("/proc/self/statm");
  uint64_t size = 0, resident = 0;
  statm >> size >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

uint16_t freePort() {
  return UdpSocket::listenOn({kLoopbackAddress, 0})->port();
}

}  // namespace

TEST_CASE("Poses are known again by their number, through every protocol") {
  const NumberedPoses poses({49.2, 20.1, 2600});
  for (const uint32_t number : {0u, 1u, 59u, 3600u}) CHECK(poses.numberOf(poses.at(number)) == number);
  for (const HostProtocol protocol : {HostProtocol::nativeFdm, HostProtocol::cigi33, HostProtocol::cigi40}) {
    const uint16_t port = freePort();
    const auto source = openStateSource(urlOf(protocol, port));
    REQUIRE(source);
    const SteadyHost host(protocol, port, poses);
    REQUIRE((*source)->await(2000));
    const uint32_t number = poses.numberOf((*source)->sample(0).pose);
    CHECK(host.sentNs(number) > 0);
    CHECK(host.sentNs(number) <= monotonicNs());
    CHECK(host.sentNs(number + 1000) == 0);
  }
}

TEST_CASE("A flood of garbage is counted, costs no memory, and the host is followed through it") {
  const NumberedPoses poses({49.2, 20.1, 2600});
  for (const HostProtocol protocol : {HostProtocol::nativeFdm, HostProtocol::cigi33}) {
    INFO(nameOf(protocol));
    const uint16_t port = freePort();
    const auto source = openStateSource(urlOf(protocol, port));
    REQUIRE(source);
    const SteadyHost host(protocol, port, poses);
    REQUIRE((*source)->await(2000));
    const auto all = garbage(protocol);
    const Flood flood(port, 20'000, [&](uint64_t index, double) { return std::span(all[index % all.size()]); });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const double beforeMiB = residentMiB();
    int looked = 0, followed = 0;
    for (const int64_t endNs = monotonicNs() + 1'000'000'000; monotonicNs() < endNs; ++looked) {
      const int64_t sentNs = host.sentNs(poses.numberOf((*source)->sample(0).pose));
      followed += monotonicNs() - sentNs < 100'000'000;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    const HostCounts counts = (*source)->sample(0).counts;
    CAPTURE(looked, followed, counts.packets, counts.rejected, flood.sentHz());
    CHECK(followed > looked * 9 / 10);
    CHECK(counts.rejected >= 1'000);  // read, before it is told from a single datagram astray
    CHECK(counts.rejected + counts.unread > 5'000);
    CHECK(counts.packets - counts.rejected < 200);  // the host's alone
    CHECK(residentMiB() - beforeMiB < 8);
  }
}

TEST_CASE("A host gone wild is shown at its newest") {
  const NumberedPoses poses({49.2, 20.1, 2600});
  for (const HostProtocol protocol : {HostProtocol::nativeFdm, HostProtocol::cigi40}) {
    INFO(nameOf(protocol));
    const uint16_t port = freePort();
    const auto source = openStateSource(urlOf(protocol, port));
    REQUIRE(source);
    const int64_t beganNs = monotonicNs();
    const Flood flood(port, 100'000, [&, message = std::vector<std::byte>()](uint64_t index, double timeS) mutable {
      message = messageOf(protocol, poses.at(static_cast<uint32_t>(timeS * kHostRateHz)), static_cast<uint32_t>(index),
                          timeS);
      return std::span<const std::byte>(message);
    });
    REQUIRE((*source)->await(2000));
    int looked = 0, followed = 0;
    for (; monotonicNs() < beganNs + 1'000'000'000; ++looked) {
      const double shownS = poses.numberOf((*source)->sample(0).pose) / kHostRateHz;
      followed += static_cast<double>(monotonicNs() - beganNs) * 1e-9 - shownS < 0.1;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    CAPTURE(looked, followed);
    CHECK(followed > looked * 9 / 10);
    CHECK((*source)->sample(0).counts.rejected == 0);
  }
}

}  // namespace eye
