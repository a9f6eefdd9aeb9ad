#include "link/xplane.h"

#include <catch2/catch.hpp>
#include <limits>

#include "packets.h"

namespace eye {
namespace {

using namespace eye::test;

std::string textOf(const Bytes& bytes) {
  std::string text;
  for (const std::byte b : bytes) text += std::to_integer<char>(b);
  return text;
}

// By hand, as X-Plane sends it: little-endian, longitude first.
Bytes rpos(double lonDeg, double latDeg, double altM, const std::vector<float>& rest) {
  Bytes bytes(69);
  const char* const name = "RPOS4";
  for (size_t i = 0; i < 5; ++i) bytes[i] = static_cast<std::byte>(name[i]);
  size_t at = 5;
  for (const double value : {lonDeg, latDeg, altM}) {
    putU(bytes, at, std::bit_cast<uint64_t>(value), 8, false);
    at += 8;
  }
  for (const float value : rest) {
    putU(bytes, at, std::bit_cast<uint32_t>(value), 4, false);
    at += 4;
  }
  return bytes;
}

const std::vector<float> kRest{120, 5, 270, -30, 60, 2, -10, 0.1f, 0.2f, 0.3f};

TEST_CASE("RPOS is read at its offsets") {
  const auto state = parseRpos(rpos(-122.5, 37.5, 1500.25, kRest));
  REQUIRE(state);
  CHECK(state->pose == Pose{{37.5, -122.5, 1500.25}, 270, 5, -30});
  CHECK(state->aglM == 120);
  CHECK(state->velocityEnuMS == Vec3d(60, 10, 2));  // east, north, up out of east, up, south
  CHECK(state->rollRateRadS == double(0.1f));
  CHECK(state->pitchRateRadS == double(0.2f));
  CHECK(state->yawRateRadS == double(0.3f));
}

TEST_CASE("RPOS comes back as it was built") {
  std::mt19937_64 random(9);
  const auto within = [&](float low, float high) {
    std::uniform_real_distribution<float> range(low, high);
    return static_cast<double>(range(random));
  };
  for (int trial = 0; trial < 1000; ++trial) {
    RposState sent;
    sent.pose = {{within(-90, 90), within(-180, 180), within(-400, 20000)},
                 within(0, 359.9f),
                 within(-89, 89),
                 within(-180, 179)};
    sent.aglM = within(0, 9000);
    sent.velocityEnuMS = {within(-300, 300), within(-300, 300), within(-300, 300)};
    sent.rollRateRadS = within(-3, 3);
    sent.pitchRateRadS = within(-3, 3);
    sent.yawRateRadS = within(-3, 3);
    const auto bytes = buildRpos(sent);
    CHECK(looksLikeRpos(bytes));
    const auto got = parseRpos(bytes);
    REQUIRE(got);
    CHECK(got->pose == sent.pose);
    CHECK(got->aglM == sent.aglM);
    CHECK(got->velocityEnuMS == sent.velocityEnuMS);
    CHECK(got->rollRateRadS == sent.rollRateRadS);
    CHECK(got->pitchRateRadS == sent.pitchRateRadS);
    CHECK(got->yawRateRadS == sent.yawRateRadS);
  }
}

TEST_CASE("RPOS is asked for in the words that X-Plane knows") {
  CHECK(textOf(buildRposRequest(60)) == std::string("RPOS\0"
                                                    "60\0",
                                                    8));
  CHECK(textOf(buildRposRequest(-1)) == std::string("RPOS\0"
                                                    "0\0",
                                                    7));
  CHECK(textOf(buildRposRequest(1000)) == std::string("RPOS\0"
                                                      "99\0",
                                                      8));
}

TEST_CASE("RPOS that is none, or has no numbers, is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(parseRpos({}));
  Bytes shorter = rpos(0, 0, 0, kRest);
  shorter.pop_back();
  CHECK_FALSE(parseRpos(shorter));
  CHECK_THAT(parseRpos(Bytes(69)).error().message, Catch::Contains("no RPOS"));
  for (const double bad : {nan, 361.0, -1e300}) CHECK_FALSE(parseRpos(rpos(bad, 0, 0, kRest)));
  for (const double bad : {nan, 90.1, -1e300}) CHECK_FALSE(parseRpos(rpos(0, bad, 0, kRest)));
  for (const double bad : {nan, -1000.5, 1e300}) CHECK_FALSE(parseRpos(rpos(0, 0, bad, kRest)));
  for (size_t i = 0; i < kRest.size(); ++i)
    for (const float bad : {static_cast<float>(nan), std::numeric_limits<float>::infinity(), -1e30f}) {
      auto rest = kRest;
      rest[i] = bad;
      CHECK_FALSE(parseRpos(rpos(0, 0, 0, rest)));
    }
}

TEST_CASE("RPOS: a hundred thousand random and damaged datagrams") {
  std::mt19937_64 random(10);
  int understood = 0;
  for (int trial = 0; trial < 100'000; ++trial) {
    Bytes bytes = rpos(10, 50, 500, kRest);
    if (trial % 4 == 0)
      for (size_t i = 5; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(random());
    damage(bytes, random);
    const auto state = parseRpos(bytes);
    if (!state) continue;
    ++understood;
    REQUIRE(std::abs(state->pose.position.latDeg) <= 90);
    REQUIRE(std::abs(state->pose.position.lonDeg) <= 180);
    REQUIRE(state->pose.headingDeg >= 0);
    REQUIRE(state->pose.headingDeg < 360);
    REQUIRE(std::abs(state->pose.pitchDeg) <= 90);
  }
  CHECK(understood > 10'000);
}

}  // namespace
}  // namespace eye
