// Time stamps of hosts on this machine's clock: jitter, drift, wraps, jumps, and clocks that are none.
#include "link/host_clock.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <random>

#include "link/fdm_clock.h"

namespace eye {
namespace {

constexpr int64_t kMs = 1'000'000, kSecond = 1000 * kMs, kHour = 3600 * kSecond;
constexpr int64_t kCigiWrap = (int64_t{1} << 32) * 10'000;

// Sixty packets a second, each held up for up to `jitterNs`, in the order of their sending.
class Network {
 public:
  explicit Network(int64_t jitterNs) : jitterNs_(jitterNs) {}
  int64_t sentNs(int i) const { return i * kSecond / 60; }
  int64_t arrivedNs(int i) {
    newestNs_ = std::max(newestNs_ + 1, 77 * kSecond + sentNs(i) + static_cast<int64_t>(uniform_(random_)));
    return newestNs_;
  }

 private:
  int64_t jitterNs_, newestNs_ = 0;
  std::mt19937_64 random_{3};
  std::uniform_real_distribution<> uniform_{0, static_cast<double>(jitterNs_)};
};

int64_t wrapped(int64_t ns, int64_t wrapNs) {
  return (ns % wrapNs + wrapNs) % wrapNs;
}

TEST_CASE("host clock: after two seconds moments are those of sending, whatever the jitter and where stamps wrap") {
  for (const int64_t wrapNs : {kCigiWrap, kHour})
    for (const int64_t firstStampNs :
         {int64_t{0}, wrapNs - 5 * kSecond}) {  // the second begins anew after five seconds
      HostClock clock(wrapNs);
      Network network(30 * kMs);
      for (int i = 0; i < 60 * 20; ++i) {
        const int64_t arrivedNs = network.arrivedNs(i);
        const Moment moment = clock.take(wrapped(firstStampNs + network.sentNs(i), wrapNs), arrivedNs);
        CAPTURE(i, firstStampNs, wrapNs);
        REQUIRE_FALSE(moment.overtaken);
        REQUIRE(moment.atNs <= arrivedNs);
        if (i < 110 || i > 135) REQUIRE(moment.byHost == (i > 135));
        if (i > 300) REQUIRE(std::abs(moment.atNs - 77 * kSecond - network.sentNs(i)) < 2 * kMs);
      }
    }
}

TEST_CASE("host clock: a drift is followed") {
  for (const double drift : {1e-4, -1e-4, 1e-3}) {
    HostClock clock(kHour);
    Network network(10 * kMs);
    int64_t mostNs = 0;
    for (int i = 0; i < 60 * 300; ++i) {
      const auto stampNs = static_cast<int64_t>(static_cast<double>(network.sentNs(i)) * (1 + drift));
      const Moment moment = clock.take(stampNs, network.arrivedNs(i));
      if (i < 300) continue;
      REQUIRE(moment.byHost);
      mostNs = std::max(mostNs, std::abs(moment.atNs - 77 * kSecond - network.sentNs(i)));
    }
    CHECK(static_cast<double>(mostNs) < 3e6 + 6e9 * std::abs(drift));  // six seconds' worth
  }
}

TEST_CASE("host clock: one that is set begins anew at once, and is believed again after two seconds") {
  for (const int64_t jumpNs : {10 * kSecond, kSecond / 5, -30 * kSecond, -20 * 60 * kSecond}) {
    HostClock clock(kHour);
    Network network(20 * kMs);
    int notBelieved = 0;
    for (int i = 0; i < 1200; ++i) {
      const int64_t stampNs = wrapped(30 * 60 * kSecond + network.sentNs(i) + (i >= 600 ? jumpNs : 0), kHour);
      const int64_t arrivedNs = network.arrivedNs(i);
      const Moment moment = clock.take(stampNs, arrivedNs);
      CAPTURE(i, jumpNs);
      REQUIRE_FALSE(moment.overtaken);
      REQUIRE(moment.atNs <= arrivedNs);
      if (i > 600) notBelieved += moment.byHost ? 0 : 1;
      if (i >= 600) REQUIRE(arrivedNs - moment.atNs < 25 * kMs);
    }
    CHECK(notBelieved > 60);
    CHECK(notBelieved < 150);
  }
}

TEST_CASE("host clock: overtaken packets are told, and a clock that is set back a little is not overtaken for ever") {
  HostClock clock(kHour);
  for (int i = 0; i < 300; ++i) (void)clock.take(i * 10 * kMs, kSecond + i * 10 * kMs);
  CHECK(clock.believed());
  const Moment late = clock.take(2960 * kMs, kSecond + 3000 * kMs);
  CHECK((late.overtaken && late.atNs == kSecond + 2960 * kMs));
  CHECK_FALSE(clock.take(3010 * kMs, kSecond + 3010 * kMs).overtaken);
  CHECK_FALSE(clock.take(3010 * kMs, kSecond + 3015 * kMs).overtaken);  // once more
  int overtaken = 0;
  for (int i = 0; i < 100; ++i)
    overtaken += clock.take(1000 * kMs + i * 10 * kMs, 6 * kSecond + i * 10 * kMs).overtaken;
  CHECK(overtaken == 0);  // long after the newest
  overtaken = 0;
  for (int i = 0; i < 100; ++i) overtaken += clock.take(i * 10 * kMs, 7000 * kMs + i * 10 * kMs).overtaken;
  CHECK(overtaken == 9);
}

TEST_CASE("host clock: one that stands, or runs at another rate, is not believed") {
  for (const double rate : {0.0, 0.5, 0.95, 1.05, 2.0}) {
    HostClock clock(kCigiWrap);
    Network network(5 * kMs);
    int believed = 0;
    for (int i = 0; i < 3600; ++i) {
      const auto stampNs = static_cast<int64_t>(rate * static_cast<double>(network.sentNs(i)));
      const int64_t arrivedNs = network.arrivedNs(i);
      const Moment moment = clock.take(stampNs, arrivedNs);
      believed += moment.byHost ? 1 : 0;
      REQUIRE(moment.atNs == arrivedNs);
    }
    CHECK(believed == 0);
  }
}

// What native-fdm hosts write, sixty times a second.
int believedOf(const std::function<uint32_t(double)>& ticksAt, double* worstMs = nullptr) {
  FdmClock clock;
  Network network(30 * kMs);
  int believed = 0;
  for (int i = 0; i < 60 * 30; ++i) {
    const int64_t arrivedNs = network.arrivedNs(i);
    const Moment moment = clock.take(ticksAt(static_cast<double>(network.sentNs(i)) * 1e-9), arrivedNs);
    REQUIRE_FALSE(moment.overtaken);
    believed += moment.byHost ? 1 : 0;
    if (!moment.byHost) REQUIRE(moment.atNs == arrivedNs);
    if (worstMs != nullptr && i > 60 * 10)
      *worstMs =
          std::max(*worstMs, std::abs(static_cast<double>(moment.atNs - 77 * kSecond - network.sentNs(i))) / kMs);
  }
  return believed;
}

uint32_t modulo(double ticks) {
  return static_cast<uint32_t>(static_cast<int64_t>(ticks));
}

TEST_CASE("native-fdm's clock is used where it runs, in milli-, micro- and nanoseconds, and not where it is none") {
  for (const double ticksPerS : {1e3, 1e6, 1e9}) {  // the last one wraps every 4.3 s
    double worstMs = 0;
    CHECK(believedOf([=](double t) { return modulo(4.29e9 + t * ticksPerS); }, &worstMs) > 60 * 20);
    CHECK(worstMs < 3);
  }
  CHECK(believedOf([](double) { return 1234567890u; }) == 0);                        // JSBSim's usual one
  CHECK(believedOf([](double t) { return modulo(1.7e9 + t); }) == 0);                // FlightGear's
  CHECK(believedOf([](double t) { return modulo(t * 60); }) == 0);                   // frames
  CHECK(believedOf([](double t) { return modulo(t * 0.5e6); }) == 0);                // slow motion
  CHECK(believedOf([](double t) { return modulo(1e9 * std::sin(1e4 * t)); }) == 0);  // garbage
}

}  // namespace
}  // namespace eye
