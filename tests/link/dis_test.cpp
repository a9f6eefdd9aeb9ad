#include "link/dis.h"

#include <array>
#include <catch2/catch.hpp>
#include <limits>

#include "base/byte_reader.h"
#include "dissection.h"
#include "link/angles.h"
#include "link/pcap.h"
#include "support/places.h"

namespace eye {
namespace {

using namespace eye::test;

DisEntityState randomState(std::mt19937_64& random) {
  const auto within = [&](float low, float high) {
    std::uniform_real_distribution<float> range(low, high);
    return static_cast<double>(range(random));
  };
  const auto vector = [&] { return Vec3d(within(-300, 300), within(-300, 300), within(-300, 300)); };
  const auto u16 = [&] { return static_cast<uint16_t>(random()); };
  const auto u8 = [&] { return static_cast<uint8_t>(random()); };
  DisEntityState state;
  state.version = static_cast<uint8_t>(5 + random() % 3);
  state.exercise = u8();
  state.timestamp = static_cast<uint32_t>(random());
  state.site = u16();
  state.application = u16();
  state.entity = u16();
  state.force = static_cast<uint8_t>(random() % 4);
  state.type = {1, 2, u16(), u8(), u8(), u8(), u8()};
  state.pose = {
      {within(-90, 90), within(-180, 180), within(-400, 30000)}, within(0, 359.9f), within(-89, 89), within(-180, 179)};
  state.velocityMS = vector();
  state.accelerationMS2 = vector();
  state.turnRateBodyRadS = vector();
  state.deadReckoning = static_cast<DeadReckoning>(1 + random() % 9);
  state.appearance = static_cast<uint32_t>(random());
  state.capabilities = static_cast<uint32_t>(random());
  state.marking = std::string("EYEPOINT 99").substr(0, random() % 12);
  return state;
}

// Angles travel as floats against the Earth's axes: 2e-5 degrees, and near the vertical heading and roll share them.
void checkPose(const Pose& a, const Pose& b) {
  CHECK(a.position.latDeg == Approx(b.position.latDeg).margin(1e-9));
  CHECK(wrappedDeg180(a.position.lonDeg - b.position.lonDeg) == Approx(0).margin(1e-7));
  CHECK(a.position.altM == Approx(b.position.altM).margin(1e-6));
  const Mat3d x = ecefFromBody(a), y = ecefFromBody(b);
  for (int i = 0; i < 3; ++i) CHECK(glm::length(x[i] - y[i]) < 1e-6);
}

TEST_CASE("DIS: an entity's state comes back as it was") {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    const DisEntityState sent = randomState(random);
    const auto bytes = buildDisEntityState(sent);
    REQUIRE(bytes.size() == kDisEntityStateBytes);
    const auto got = parseDisEntityState(bytes);
    REQUIRE(got);
    checkPose(got->pose, sent.pose);
    CHECK(got->version == sent.version);
    CHECK(got->exercise == sent.exercise);
    CHECK(got->timestamp == sent.timestamp);
    CHECK(got->site == sent.site);
    CHECK(got->application == sent.application);
    CHECK(got->entity == sent.entity);
    CHECK(got->force == sent.force);
    CHECK(got->type == sent.type);
    CHECK(got->velocityMS == sent.velocityMS);
    CHECK(got->accelerationMS2 == sent.accelerationMS2);
    CHECK(got->turnRateBodyRadS == sent.turnRateBodyRadS);
    CHECK(got->deadReckoning == sent.deadReckoning);
    CHECK(got->appearance == sent.appearance);
    CHECK(got->capabilities == sent.capabilities);
    CHECK(got->marking == sent.marking);
  }
}

TEST_CASE("DIS: orientation is against the axes of the Earth") {
  // Where the equator meets the prime meridian east is y and up is x: a level aircraft that heads north has its nose
  // along z, that is theta = -90; one that heads east has psi = 90 and rolls its belly to -x, phi = -90.
  const auto angles = [](const Pose& pose) {
    DisEntityState state;
    state.pose = pose;
    const auto bytes = buildDisEntityState(state);
    ByteReader reader{std::span(bytes).subspan(72), std::endian::big};
    const float psi = reader.f32(), theta = reader.f32(), phi = reader.f32();
    return std::array<double, 3>{degFromRad(double(psi)), degFromRad(double(theta)), degFromRad(double(phi))};
  };
  const auto east = angles({{0, 0, 1000}, 90, 0, 0});
  CHECK(east[0] == Approx(90));
  CHECK(east[1] == Approx(0).margin(1e-5));
  CHECK(east[2] == Approx(-90));
  CHECK(angles({{0, 0, 1000}, 0, 0, 0})[1] == Approx(-90));
  // Over the pole, on the prime meridian's side, heading along it (180): nose towards +x, level.
  const auto pole = angles({{90, 0, 1000}, 180, 0, 0});
  CHECK(pole[0] == Approx(0).margin(1e-5));
  CHECK(pole[1] == Approx(0).margin(1e-5));
  CHECK(std::abs(pole[2]) == Approx(180));
}

TEST_CASE("DIS: what is no Entity State is refused in words") {
  std::mt19937_64 random(6);
  const Bytes good = buildDisEntityState(randomState(random));
  const auto reason = [](const Bytes& bytes) {
    const auto state = parseDisEntityState(bytes);
    REQUIRE_FALSE(state);
    return state.error().message;
  };
  const auto with = [&](auto&& change) {
    Bytes bytes = good;
    change(bytes);
    return bytes;
  };
  CHECK_THAT(reason({}), Catch::Contains("0 bytes"));
  CHECK_THAT(reason(Bytes(good.begin(), good.end() - 1)), Catch::Contains("143 bytes"));
  CHECK_THAT(reason(with([](Bytes& b) { putU(b, 2, 2, 1); })), Catch::Contains("type 2"));
  CHECK_THAT(reason(with([](Bytes& b) { putU(b, 0, 4, 1); })), Catch::Contains("version 4"));
  CHECK_THAT(reason(with([](Bytes& b) { putU(b, 0, 8, 1); })), Catch::Contains("version 8"));
  CHECK_THAT(reason(with([](Bytes& b) { putU(b, 8, 160, 2); })), Catch::Contains("160 bytes"));
  CHECK_THAT(reason(with([](Bytes& b) { putU(b, 19, 1, 1); })), Catch::Contains("1 variable parameters"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const size_t at : {48u, 56u, 64u})
    for (const double bad : {nan, 1e300, -std::numeric_limits<double>::infinity()})
      CHECK_THAT(reason(with([&](Bytes& b) { putF64(b, at, bad); })), Catch::Contains("location"));
  for (const size_t at : {72u, 76u, 80u})
    CHECK_THAT(reason(with([&](Bytes& b) { putF32(b, at, float(nan)); })), Catch::Contains("orientation"));
  for (const size_t at : {36u, 40u, 44u, 104u, 116u})
    CHECK_THAT(reason(with([&](Bytes& b) { putF32(b, at, 1e30f); })), Catch::Contains("velocity"));
  const Bytes centre = with([](Bytes& b) {
    for (const size_t at : {48u, 56u, 64u}) putF64(b, at, 0);
  });
  CHECK_THAT(reason(centre), Catch::Contains("altitude"));

  Bytes longer = with([](Bytes& b) {
    putU(b, 8, 144 + 32, 2);
    putU(b, 19, 2, 1);
  });
  longer.resize(176 + 5);  // two variable parameters, and what another layer has left behind
  CHECK(parseDisEntityState(longer));
  CHECK(parseDisEntityState(with([](Bytes& b) { putU(b, 88, 77, 1); }))->deadReckoning == DeadReckoning::other);
}

TEST_CASE("DIS: timestamps") {
  CHECK(disSecondsPastHour(disTimestamp(1234.5, true)) == Approx(1234.5).margin(1e-5));
  CHECK(disIsUtc(disTimestamp(0, true)));
  CHECK_FALSE(disIsUtc(disTimestamp(3599.9999999, false)));
  CHECK(disSecondsPastHour(0xffffffff) < 3600);
}

TEST_CASE("DIS: Wireshark reads what is built as it was meant") {
  std::mt19937_64 random(7);
  std::vector<Bytes> payloads;
  std::vector<DisEntityState> states;
  for (int i = 0; i < 20; ++i) {
    states.push_back(randomState(random));
    payloads.push_back(buildDisEntityState(states.back()));
  }
  const auto text = tsharkVerbose(captureOf(payloads, 3000), "udp.port==3000,dis", "dis");
  if (!text) {
    WARN("no tshark: nobody judges");
    return;
  }
  CHECK(text->find("Malformed") == std::string::npos);
  // Its sections' names, not packets', are on the outer level; in what is between, labels are unique but for X, Y and
  // Z.
  std::vector<std::map<std::string, std::string>> judged;
  TextLines lines(*text);
  std::string section;
  while (const auto next = lines.next()) {
    const std::string line(*next);
    const size_t start = line.find_first_not_of(' ');
    if (line.starts_with("Distributed Interactive Simulation")) judged.emplace_back();
    if (start == std::string::npos || judged.empty()) continue;
    const size_t colon = line.find(": ");
    if (colon == std::string::npos)
      section = line.substr(start);
    else
      judged.back().try_emplace(
          (line[start] >= 'X' && colon == start + 1 ? section + " " : "") + line.substr(start, colon - start),
          line.substr(colon + 2));
  }
  REQUIRE(judged.size() == states.size());
  for (size_t i = 0; i < states.size(); ++i) {
    const auto& s = states[i];
    const auto is = [&](const std::string& label, double value, double epsilon) {
      INFO(label << ": " << judged[i][label]);
      const auto number = numberIn(judged[i][label]);
      REQUIRE(number);
      CHECK(*number == Approx(value).epsilon(epsilon).margin(1e-9));
    };
    const Vec3d ecefM = ecefFromGeodetic(s.pose.position);
    is("Entity Location X", ecefM.x, 1e-14);
    is("Entity Location Y", ecefM.y, 1e-14);
    is("Entity Location Z", ecefM.z, 1e-14);
    is("Entity Linear Velocity X", s.velocityMS.x, 1e-5);
    is("Entity Linear Velocity Z", s.velocityMS.z, 1e-5);
    is("Entity ID Site", s.site, 0);
    is("Entity ID Application", s.application, 0);
    is("Entity ID Entity", s.entity, 0);
    is("Exercise ID", s.exercise, 0);
    is("Proto version", s.version, 0);
    is("Dead Reckoning Algorithm", double(s.deadReckoning), 0);
    is("Entity Linear acceleration X", s.accelerationMS2.x, 1e-5);
    is("Entity Angular Velocity Y", s.turnRateBodyRadS.y, 1e-5);
    CHECK(judged[i]["Entity Marking"] == s.marking);
  }
}

TEST_CASE("DIS: a recorded walker stands where Wireshark says") {
  const std::string source = eye::test::kTestData + "/cigi/DIS_EntityState_1.pcapng";
  const auto path = std::filesystem::temp_directory_path() / ("eyepoint_dis_" + std::to_string(::getpid()) + ".pcap");
  const int status = std::system(("tshark -r " + source + " -F pcap -w " + path.string() + " 2>/dev/null").c_str());
  std::ifstream stream(path, std::ios::binary);
  const std::vector<char> file((std::istreambuf_iterator<char>(stream)), {});
  std::filesystem::remove(path);
  if (status != 0) {
    WARN("no tshark, or no " << source);
    return;
  }
  const auto capture = parsePcap(std::as_bytes(std::span(file)));
  REQUIRE(capture);
  REQUIRE(capture->datagrams.size() == 287);
  for (const auto& datagram : capture->datagrams) {
    const auto state = parseDisEntityState(datagram.payload);
    REQUIRE(state);
    CHECK(state->version == 5);
  }
  const auto first = *parseDisEntityState(capture->datagrams.front().payload);
  CHECK(first.marking == "KARL");
  CHECK(first.type == EntityType{3, 1, 225, 3, 0, 1, 0});
  CHECK(disSecondsPastHour(first.timestamp) == Approx(40 * 60 + 44.435966).margin(1e-4));
  // A soldier in California, upright on the ground: level to a degree only if orientation is read as it is meant.
  CHECK(first.pose.position.latDeg == Approx(40.7).margin(0.3));
  CHECK(first.pose.position.lonDeg == Approx(-122.6).margin(0.3));
  CHECK(std::abs(first.pose.pitchDeg) < 1);
  CHECK(std::abs(first.pose.rollDeg) < 1);
}

TEST_CASE("DIS: a hundred thousand random and damaged datagrams") {
  std::mt19937_64 random(8);
  int understood = 0;
  for (int trial = 0; trial < 100'000; ++trial) {
    Bytes bytes = buildDisEntityState(randomState(random));
    if (trial % 4 == 0)
      for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    damage(bytes, random);
    const auto state = parseDisEntityState(bytes);
    if (!state) continue;
    ++understood;
    REQUIRE(std::abs(state->pose.position.latDeg) <= 90);
    REQUIRE(state->pose.position.altM >= -1000);
    REQUIRE(state->pose.headingDeg >= 0);
    REQUIRE(state->pose.headingDeg < 360);
    REQUIRE(std::abs(state->pose.pitchDeg) <= 90);
    REQUIRE(state->marking.size() <= 11);
  }
  CHECK(understood > 10'000);
}

}  // namespace
}  // namespace eye
