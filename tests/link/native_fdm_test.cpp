#include "link/native_fdm.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "link/angles.h"
#include "link/pcap.h"
#include "link/track_file.h"
#include "packets.h"
#include "support/places.h"

namespace eye {
namespace {

using namespace eye::test;

constexpr double kPi = 3.14159265358979323846;

// What every state that comes out of the parser must keep.
bool inRange(const NativeFdmState& s) {
  const auto& [position, heading, pitch, roll] = s.pose;
  return std::abs(position.latDeg) <= 90 && std::abs(position.lonDeg) <= 180 && position.altM >= -1000 &&
         position.altM <= 1e8 && heading >= 0 && heading < 360 && std::abs(pitch) <= 90 && std::abs(roll) <= 180 &&
         (!s.visibilityM || (*s.visibilityM >= 1 && *s.visibilityM <= 1e7));
}

TEST_CASE("native-fdm version 24 is read at its offsets") {
  const auto state = parseNativeFdm(fdmPacket(0.8, -1.7, 1234.5, 0.1f, -0.2f, 3.0f, 25000.f));
  REQUIRE(state);
  CHECK(state->pose.position.latDeg == Approx(0.8 * 180 / kPi).epsilon(1e-14));
  CHECK(state->pose.position.lonDeg == Approx(-1.7 * 180 / kPi).epsilon(1e-14));
  CHECK(state->pose.position.altM == 1234.5);
  CHECK(state->pose.rollDeg == Approx(0.1 * 180 / kPi).epsilon(1e-6));
  CHECK(state->pose.pitchDeg == Approx(-0.2 * 180 / kPi).epsilon(1e-6));
  CHECK(state->pose.headingDeg == Approx(3.0 * 180 / kPi).epsilon(1e-6));
  CHECK(state->visibilityM == 25000.0);
}

TEST_CASE("native-fdm version 25 has its visibility elsewhere") {
  Bytes packet = fdmPacket(0.8, -1.7, 1234.5, 0.1f, -0.2f, 3.0f, 25000.f);
  packet.resize(552);
  putU(packet, 0, 25, 4);
  CHECK_FALSE(parseNativeFdm(packet)->visibilityM.has_value());
  putF32(packet, 508, 8000.f);
  const auto state = parseNativeFdm(packet);
  REQUIRE(state);
  CHECK(state->visibilityM == 8000.0);
  CHECK(state->pose.position.altM == 1234.5);
}

TEST_CASE("native-fdm of another version or length is refused with both in the message") {
  Bytes packet = fdmPacket(0, 0, 0, 0, 0, 0, 0);
  putU(packet, 0, 25, 4);
  REQUIRE_FALSE(parseNativeFdm(packet));
  CHECK(parseNativeFdm(packet).error().message.find("408 bytes says version 25") != std::string::npos);
  putU(packet, 0, 24, 4);
  packet.push_back({});
  CHECK_FALSE(parseNativeFdm(packet));
  packet.resize(407);
  CHECK_FALSE(parseNativeFdm(packet));
  CHECK_FALSE(parseNativeFdm({}));
}

TEST_CASE("native-fdm values that are no numbers or out of range are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto fnan = static_cast<float>(nan), finf = static_cast<float>(inf);
  for (const double bad : {nan, inf, -inf, 1e300, kPi / 2 + 1e-6, -1.6})
    CHECK_FALSE(parseNativeFdm(fdmPacket(bad, 0, 0, 0, 0, 0, 0)));
  for (const double bad : {nan, inf, -inf, 6.3, -6.3}) CHECK_FALSE(parseNativeFdm(fdmPacket(0, bad, 0, 0, 0, 0, 0)));
  for (const double bad : {nan, inf, -inf, 1.01e8, -1000.1})
    CHECK_FALSE(parseNativeFdm(fdmPacket(0, 0, bad, 0, 0, 0, 0)));
  for (const float bad : {fnan, finf, -finf, 1e30f, -1001.f}) {
    CHECK_FALSE(parseNativeFdm(fdmPacket(0, 0, 0, bad, 0, 0, 0)));
    CHECK_FALSE(parseNativeFdm(fdmPacket(0, 0, 0, 0, bad, 0, 0)));
    CHECK_FALSE(parseNativeFdm(fdmPacket(0, 0, 0, 0, 0, bad, 0)));
  }
  for (const float bad : {fnan, finf, -5.f, 0.f, 1e30f}) {
    const auto state = parseNativeFdm(fdmPacket(0, 0, 0, 0, 0, 0, bad));
    REQUIRE(state);  // haze is no reason to lose the aircraft
    CHECK_FALSE(state->visibilityM.has_value());
  }
}

TEST_CASE("native-fdm at the poles, across the date line and over the top") {
  CHECK(parseNativeFdm(fdmPacket(kPi / 2, kPi, 0, 0, 0, 0, 0))->pose.position == Geodetic{90, 180, 0});
  CHECK(parseNativeFdm(fdmPacket(-kPi / 2, -kPi, 0, 0, 0, 0, 0))->pose.position == Geodetic{-90, -180, 0});
  CHECK(parseNativeFdm(fdmPacket(0, 1.5 * kPi, 0, 0, 0, 0, 0))->pose.position.lonDeg == Approx(-90));
  const auto state =
      parseNativeFdm(fdmPacket(0, 0, 0, 0, static_cast<float>(2 * kPi / 3), static_cast<float>(-kPi / 2), 0));
  CHECK(state->pose.pitchDeg == Approx(60).margin(1e-4));
  CHECK(state->pose.headingDeg == Approx(90).margin(1e-4));
  CHECK(std::abs(state->pose.rollDeg) == Approx(180).margin(1e-4));
}

TEST_CASE("normalised angles are the same rotation") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> angle(-800, 800);
  for (int i = 0; i < 2000; ++i) {
    const Pose given{{}, angle(random), angle(random), angle(random)};
    Pose pose = given;
    normaliseAngles(pose);
    const Mat3d a = enuFromBody(given.headingDeg, given.pitchDeg, given.rollDeg);
    const Mat3d b = enuFromBody(pose.headingDeg, pose.pitchDeg, pose.rollDeg);
    for (int c = 0; c < 3; ++c) REQUIRE(glm::length(a[c] - b[c]) < 1e-12);
    REQUIRE(inRange({pose, std::nullopt}));
  }
}

TEST_CASE("a built packet is read back: position to a nanometre, attitude to a float") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Pose pose{{90 * unit(random), 180 * unit(random), 2e4 * (1 + unit(random))},
                    180 + 179.9 * unit(random),
                    89 * unit(random),
                    179 * unit(random)};
    const Bytes packet = buildNativeFdm({pose, 9000});
    REQUIRE(packet.size() == 408);
    const auto state = parseNativeFdm(packet);
    REQUIRE(state);
    const auto& [position, heading, pitch, roll] = state->pose;
    REQUIRE(glm::length(ecefFromGeodetic(position) - ecefFromGeodetic(pose.position)) < 2e-8);
    REQUIRE(heading == Approx(pose.headingDeg).margin(3e-5));
    REQUIRE(pitch == Approx(pose.pitchDeg).margin(3e-5));
    REQUIRE(roll == Approx(pose.rollDeg).margin(3e-5));
    REQUIRE(state->visibilityM == 9000.0);
  }
}

TEST_CASE("100,000 random and mutated packets: no crash, nothing out of range") {
  std::mt19937_64 random(7);
  const Bytes good24 = fdmPacket(0.6, 2.2, 1000, 0.1f, 0.1f, 1.f, 20000.f);
  Bytes good25 = good24;
  good25.resize(552);
  putU(good25, 0, 25, 4);
  size_t accepted = 0;
  for (int i = 0; i < 100'000; ++i) {
    Bytes packet;
    if (i % 4 == 0) {  // random through and through, with a good version and length half of the time
      packet.resize(i % 8 == 0 ? 408 : random() % 600);
      for (std::byte& b : packet) b = static_cast<std::byte>(random() & 0xff);
      if (i % 8 == 0) putU(packet, 0, 24, 4);
    } else {
      packet = i % 2 == 0 ? good24 : good25;
      damage(packet, random);
      // Damage where it matters: in the fields that are read.
      if (packet.size() > 60 && i % 3 == 0) packet[8 + random() % 40] = static_cast<std::byte>(random() & 0xff);
    }
    const auto state = parseNativeFdm(packet);
    if (!state) continue;
    ++accepted;
    REQUIRE(inRange(*state));
  }
  CHECK(accepted > 10'000);  // the mutations must get past the length check often enough to mean something
  CHECK(accepted < 90'000);
}

TEST_CASE("real JSBSim captures: every packet is read") {
  const std::pair<const char*, size_t> captures[] = {{"jsbsim_c1723_takeoff.pcap", 6602},
                                                     {"jsbsim_737_cruise.pcap", 3602}};
  for (const auto& [name, count] : captures) {
    const auto file = readTrackFile(eye::test::kTestData + "/captures/" + name);
    if (!file) {
      WARN("not tested: " << file.error().message);
      return;
    }
    const auto capture = parsePcap(*file);
    REQUIRE(capture);
    CHECK(capture->datagrams.size() == count);
    CHECK(capture->passedOver == 0);
    CHECK_FALSE(capture->truncated);
    size_t read = 0;
    for (const CapturedDatagram& datagram : capture->datagrams)
      if (const auto state = parseNativeFdm(datagram.payload);
          state && inRange(*state) && state->visibilityM == 25000.0)
        ++read;
    CHECK(read == count);
    const auto first = parseNativeFdm(capture->datagrams.front().payload)->pose.position;
    if (count == 6602) {  // Houston, standing on the ground
      CHECK(first.latDeg == Approx(29.759526278).margin(1e-9));
      CHECK(first.lonDeg == Approx(-95.163839809).margin(1e-9));
      CHECK(first.altM == Approx(1.312169).margin(1e-6));
    }
  }
}

}  // namespace
}  // namespace eye
