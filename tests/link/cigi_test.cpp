#include "link/cigi.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <limits>

#include "cigi_random.h"
#include "packets.h"

namespace eye {
namespace {

using namespace eye::test;
using namespace eye::cigi;

Bytes bytesOf(std::initializer_list<int> values) {
  Bytes bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

// A message of IG Control and these packets.
Bytes hostMessage(const Format& format, std::initializer_list<Packet> packets) {
  Builder builder(format, IgControl{});
  for (const Packet& packet : packets) REQUIRE(builder.add(packet));
  return builder.take();
}

TEST_CASE("CIGI: every packet comes back as it was, in every version and byte order") {
  for (const Format& format : cigiFormats()) {
    RandomCigi random(7 + format.version.minor, format.version);
    for (size_t alternative = 0; alternative < std::variant_size_v<Packet>; ++alternative)
      for (int trial = 0; trial < 200; ++trial) {
        INFO("CIGI " << int(format.version.major) << "." << int(format.version.minor) << " packet " << alternative);
        const Packet sent = random.packet(alternative);
        std::vector<Packet> expected;
        Bytes bytes;
        if (const auto* header = std::get_if<IgControl>(&sent)) {
          bytes = Builder(format, *header).take();
          expected = {sent};
        } else if (const auto* frame = std::get_if<StartOfFrame>(&sent)) {
          bytes = Builder(format, *frame).take();
          expected = {sent};
        } else {
          const IgControl first = random.igControl();
          Builder builder(format, first);
          REQUIRE(builder.add(sent));
          bytes = builder.take();
          expected = {first, sent};
          if (const auto* entity = std::get_if<Entity>(&sent); entity && format.version.major == 4)
            expected = {first, Entity{entity->id, entity->traits, {}}, Entity{entity->id, {}, entity->place}};
        }
        CHECK(bytes.size() % 8 == 0);
        const auto message = parse(bytes);
        REQUIRE(message);
        // 3.0 and 3.1 cannot be told apart: neither has a minor version on the wire.
        const bool old = format.version.major == 3 && format.version.minor < 2;
        CHECK(message->format.version == (old ? Version{3, 0} : format.version));
        CHECK(message->format.order == format.order);
        CHECK(message->rejected == 0);
        CHECK(message->unknown == 0);
        CHECK(message->firstRejection.empty());
        REQUIRE(message->packets.size() == expected.size());
        CHECK(message->packets == expected);
      }
  }
}

TEST_CASE("CIGI 3.3 and 4.0: headers byte by byte") {
  IgControl control;
  control.databaseNumber = 5;
  control.mode = IgMode::operate;
  control.hostFrame = 0x01020304;
  control.ticks = 0x0a0b0c0d;
  control.igFrame = 0x11121314;
  CHECK(Builder({{3, 3}, std::endian::big}, control).take() ==
        bytesOf({1, 24, 3, 5, 0x35, 0, 0x80, 0, 1, 2, 3, 4, 10, 11, 12, 13, 0x11, 0x12, 0x13, 0x14, 0, 0, 0, 0}));
  CHECK(Builder({{3, 3}, std::endian::little}, control).take() ==
        bytesOf({1, 24, 3, 5, 0x35, 0, 0, 0x80, 4, 3, 2, 1, 13, 12, 11, 10, 0x14, 0x13, 0x12, 0x11, 0, 0, 0, 0}));
  CHECK(Builder({{3, 0}, std::endian::big}, control).take() ==
        bytesOf({1, 16, 3, 5, 0x05, 0, 0x80, 0, 1, 2, 3, 4, 10, 11, 12, 13}));
  CHECK(Builder({{4, 0}, std::endian::big}, control).take() ==
        bytesOf({0, 24, 0, 0, 4, 5, 0, 5, 1, 2, 3, 4, 0x11, 0x12, 0x13, 0x14, 10, 11, 12, 13, 0, 0, 0, 0}));

  StartOfFrame frame;
  frame.databaseNumber = -5;
  frame.mode = IgMode::maintenance;
  frame.igFrame = 0x01020304;
  frame.hostFrame = 0x11121314;
  frame.overframing = true;
  frame.excessVariableData = true;
  CHECK(Builder({{3, 3}, std::endian::big}, frame).take() ==
        bytesOf({101, 24, 3, 251, 0, 0x33, 0x80, 0, 1, 2, 3, 4, 0, 0, 0, 0, 0x11, 0x12, 0x13, 0x14, 0, 0, 0, 0}));
  CHECK(Builder({{4, 0}, std::endian::big}, frame).take() ==
        bytesOf({0, 24, 255, 255, 4, 251, 0, 3, 1, 2, 3, 4, 0, 0, 0, 0, 0x11, 0x12, 0x13, 0x14, 5, 0, 0, 0}));
  CHECK(Builder({{4, 0}, std::endian::little}, frame).take() ==
        bytesOf({24, 0, 255, 255, 4, 251, 0, 3, 4, 3, 2, 1, 0, 0, 0, 0, 0x14, 0x13, 0x12, 0x11, 0, 5, 0, 0}));
}

TEST_CASE("CIGI 4.0: extended answers and Acceleration Control byte by byte") {
  const Format format{{4, 0}, std::endian::big};
  const auto built = [&](const Packet& packet) {
    Builder builder(format, StartOfFrame{});
    REQUIRE(builder.add(packet));
    const Bytes all = builder.take();
    return Bytes(all.begin() + 24, all.end());
  };

  SightExtendedResponse answer{0x0102, true, true, 7, 3, 0x0304, 2.0, false, 0, 0, 0, 9, 10, 11, 12, 0x0d0e0f10, 0, 0};
  answer.altMOrZM = -2.0;
  Bytes expected = bytesOf({0, 64, 0x0f, 0xfc, 1, 2, 3, 4, 0x7f, 3, 0, 0, 0, 0, 0, 0, 0x40});
  expected.resize(64);
  putU(expected, 40, 0xc000000000000000, 8);
  putU(expected, 48, 0x090a0b0c0d0e0f10, 8);
  CHECK(built(answer) == expected);

  expected = bytesOf({0, 40, 0x0f, 0xfe, 0xf1, 0, 1, 2, 0x40});
  expected.resize(40);
  putU(expected, 16, 0xc000000000000000, 8);
  putU(expected, 24, 0x0a0b0c0d, 4);
  putF32(expected, 28, 90.f);
  putF32(expected, 32, 45.f);
  CHECK(built(HeightExtendedResponse{0x0102, 15, SurfacePoint{2, -2, 0x0a0b0c0d, 90, 45}}) == expected);

  expected = bytesOf({0, 32, 0, 0x13, 1, 2, 9, 3, 0x40});
  expected.resize(32);
  putF32(expected, 28, -2.f);
  Acceleration acceleration;
  acceleration.entityId = 0x0102;
  acceleration.xMS2 = 2;
  acceleration.partId = uint8_t{9};
  acceleration.inBodyFrame = true;
  acceleration.yawDegS2 = -2;
  CHECK(built(acceleration) == expected);
}

TEST_CASE("CIGI: what is no message of a known version is refused in words") {
  const auto reason = [](const Bytes& bytes) {
    const auto message = parse(bytes);
    REQUIRE_FALSE(message);
    CHECK_FALSE(looksLikeCigi(bytes));
    return message.error().message;
  };
  const Bytes good3 = Builder({{3, 3}, std::endian::little}, IgControl{}).take();
  const Bytes good4 = Builder({{4, 0}, std::endian::little}, IgControl{}).take();
  CHECK(looksLikeCigi(good3));
  CHECK(looksLikeCigi(good4));
  const auto changed = [](Bytes bytes, size_t at, int value) {
    bytes.at(at) = static_cast<std::byte>(value);
    return bytes;
  };
  CHECK_THAT(reason({}), Catch::Contains("0 bytes"));
  CHECK_THAT(reason(Bytes(15)), Catch::Contains("15 bytes"));
  CHECK_THAT(reason(changed(good3, 2, 1)), Catch::Contains("CIGI 1; 3.0 to 3.3 and 4.0 are understood"));
  CHECK_THAT(reason(changed(good3, 2, 2)), Catch::Contains("CIGI 2;"));
  CHECK_THAT(reason(changed(good3, 4, 0x40)), Catch::Contains("CIGI 3.4;"));
  CHECK_THAT(reason(changed(good3, 2, 9)), Catch::Contains("version would be 9"));
  CHECK_THAT(reason(changed(good3, 0, 16)), Catch::Contains("begins with packet 16"));
  CHECK_THAT(reason(changed(good3, 7, 1)), Catch::Contains("byte order mark is 0x0001"));
  CHECK_THAT(reason(changed(good4, 4, 5)), Catch::Contains("CIGI 5;"));
  CHECK_THAT(reason(changed(good4, 0, 32)), Catch::Contains("32 bytes"));
  CHECK_THAT(reason(changed(good4, 3, 7)), Catch::Contains("begins with packet 0x0700"));
  CHECK(parse(changed(good3, 2, 2)).error().kind == ErrorKind::unsupported);
  CHECK(parse(Bytes(15)).error().kind == ErrorKind::badData);
}

TEST_CASE("CIGI: a bad packet is counted with its reason, and the others stay") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Entity entity{7, EntityTraits{}, EntityPlace{}};
  const auto placed = [&](double latDeg, double altM, double yawDeg) {
    Entity e = entity;
    e.place->position = Geodetic{latDeg, 20, altM};
    e.place->yawDeg = yawDeg;
    return e;
  };
  const Velocity good{7, {}, false, 1, 2, 3, 4, 5, 6};
  struct Case {
    Packet bad;
    std::string reason;
  };
  ViewDefinition wide;
  wide.leftDegOrM = -95;
  CelestialSphere february;
  february.dateTime = DateTime{2023, 2, 29, 0, 0, 0};
  CelestialSphere noon;
  noon.dateTime = DateTime{2024, 2, 29, 24, 0, 0};
  Weather wet;
  wet.humidityPercent = 101;
  for (const Format& format : cigiFormats()) {
    const bool is4 = format.version.major == 4;
    const std::string place = is4 ? "Entity Position: " : "Entity Control: ";
    const std::vector<Case> cases{
        {placed(nan, 0, 0), place + "latitude is not a finite number"},
        {placed(91, 0, 0), place + "latitude 91 is outside -90 to 90"},
        {placed(0, -2000, 0), place + "altitude -2000 is outside -1000 to 100000000"},
        {placed(0, 0, std::numeric_limits<double>::infinity()), place + "yaw is not a finite number"},
        {placed(0, 0, 361), place + "yaw 361 is outside -360 to 360"},
        {wide, "View Definition: half-angle -95 is outside"},
        {february, "Celestial Sphere Control: date 2292023 is no MMDDYYYY"},
        {noon, "Celestial Sphere Control: hour 24 is outside 0 to 23"},
        {wet, "Weather Control: percentage 101 is outside 0 to 100"},
        {SightVectorRequest{1, false, false, 0, 0, 0, 0, 0, 20, 10, {}, 0}, "minimum range is beyond"},
    };
    for (const auto& [bad, reason] : cases) {
      auto message = parse(hostMessage(format, {bad, good}));
      REQUIRE(message);
      CHECK(message->rejected == 1);
      CHECK_THAT(message->firstRejection, Catch::Contains(reason));
      REQUIRE(message->packets.size() >= 2);
      CHECK(message->packets.back() == Packet(good));
    }
  }
}

TEST_CASE("CIGI: numbers that are not asked for need not be numbers") {
  ViewControl view;
  view.yawDeg = 30;
  Bytes bytes = hostMessage({{3, 3}, std::endian::big}, {view});
  for (size_t i = 8; i < 28; ++i) bytes.at(24 + i) = std::byte{0xff};  // five NaNs, all but yaw
  const auto message = parse(bytes);
  REQUIRE(message);
  REQUIRE(message->rejected == 0);
  CHECK(message->packets.back() == Packet(view));
}

TEST_CASE("CIGI: enumerations have no other values") {
  const Format format{{3, 3}, std::endian::little};
  Bytes bytes = hostMessage(format, {Entity{1, EntityTraits{}, EntityPlace{}}, HeightRequest{}});
  bytes.at(24 + 4) |= std::byte{3};
  bytes.at(24 + 48 + 4) |= std::byte{3};
  const auto message = parse(bytes);
  REQUIRE(message);
  CHECK(message->packets.size() == 1);
  CHECK(message->rejected == 2);
  CHECK(message->firstRejection == "Entity Control: entity state 3 means nothing");
}

TEST_CASE("CIGI: unknown packets are passed over by their size, a broken size ends the message") {
  for (const Format& format : cigiFormats()) {
    const bool is4 = format.version.major == 4, big = format.order == std::endian::big;
    const size_t header = Builder(format, IgControl{}).size();
    Bytes bytes = Builder(format, IgControl{}).take();
    Bytes foreign(32, std::byte{0xff});
    if (is4) {
      putU(foreign, 0, 32, 2, big);
      putU(foreign, 2, 0x8001, 2, big);
    } else {
      putU(foreign, 0, 201, 1);
      putU(foreign, 1, 32, 1);
    }
    const Bytes velocity = [&] {
      const Bytes all = hostMessage(format, {Velocity{3, {}, false, 1, 2, 3, 4, 5, 6}});
      return Bytes(all.begin() + static_cast<std::ptrdiff_t>(header), all.end());
    }();
    append(bytes, foreign);
    append(bytes, velocity);
    append(bytes, foreign);
    auto message = parse(bytes);
    REQUIRE(message);
    CHECK(message->unknown == 2);
    CHECK(message->rejected == 0);
    CHECK(message->packets.size() == 2);

    for (const int wrong : {0, 4, 7, 40}) {  // the last foreign packet
      Bytes cut = bytes;
      if (is4)
        putU(cut, cut.size() - 32, static_cast<uint64_t>(wrong), 2, big);
      else
        putU(cut, cut.size() - 31, static_cast<uint64_t>(wrong), 1);
      message = parse(cut);
      REQUIRE(message);
      CHECK(message->packets.size() == 2);
      CHECK(message->unknown == 1);
      CHECK(message->rejected == 1);
      CHECK_THAT(
          message->firstRejection,
          Catch::Contains(fmt::format("at byte {} says that it has {} bytes; 32 are there", cut.size() - 32, wrong)));
    }
  }
}

TEST_CASE("CIGI: a packet that is too short is rejected, one that is longer is read") {
  const Format format{{3, 3}, std::endian::little};
  const Bytes good = hostMessage(format, {Velocity{3, {}, false, 1, 2, 3, 4, 5, 6}});
  Bytes shorter = good;
  putU(shorter, 25, 24, 1);
  shorter.resize(48);
  auto message = parse(shorter);
  REQUIRE(message);
  CHECK(message->firstRejection == "Rate Control has 24 bytes instead of 32");
  Bytes longer = good;
  putU(longer, 25, 40, 1);
  longer.resize(64);
  message = parse(longer);
  REQUIRE(message);
  CHECK(message->rejected == 0);
  CHECK(message->packets == parse(good)->packets);
}

TEST_CASE("CIGI: one header a message, and a bounded number of packets") {
  const Format format{{3, 3}, std::endian::little};
  Bytes bytes = Builder(format, IgControl{}).take();
  append(bytes, Builder(format, StartOfFrame{}).take());
  auto message = parse(bytes);
  REQUIRE(message);
  CHECK(message->packets.size() == 1);
  CHECK(message->firstRejection == "Start of Frame: the message has one already");

  Bytes many = Builder(format, IgControl{}).take();
  for (int i = 0; i < 3000; ++i) append(many, bytesOf({201, 8, 0, 0, 0, 0, 0, 0}));
  message = parse(many);
  REQUIRE(message);
  CHECK(message->unknown == kMaxPackets - 1);
  CHECK(message->firstRejection == "the message has more than 2048 packets");
}

TEST_CASE("CIGI: a builder takes what fits into a datagram and no more") {
  for (const Format& format : cigiFormats()) {
    Builder builder(format, StartOfFrame{});
    size_t taken = 0;
    while (builder.add(SightExtendedResponse{})) REQUIRE(++taken < 1000);
    CHECK(builder.size() <= kMaxMessageBytes);
    CHECK(builder.size() + 64 > kMaxMessageBytes);
    CHECK(parse(builder.take())->packets.size() == taken + 1);
  }
}

TEST_CASE("CIGI: longitudes come back within half a turn") {
  const auto message = parse(hostMessage({{3, 3}, std::endian::big},
                                         {Entity{1, EntityTraits{}, EntityPlace{.position = Geodetic{10, 264.5, 5}}}}));
  REQUIRE(message);
  CHECK(std::get<Geodetic>(std::get<Entity>(message->packets.back()).place->position).lonDeg == -95.5);
}

// Whether a packet that is built and read once more is the same.
bool comesAgain(const Packet& packet, const Format& format) {
  Bytes bytes;
  if (const auto* control = std::get_if<IgControl>(&packet)) {
    bytes = Builder(format, *control).take();
  } else if (const auto* frame = std::get_if<StartOfFrame>(&packet)) {
    bytes = Builder(format, *frame).take();
  } else {
    Builder builder(format, StartOfFrame{});
    if (!builder.add(packet)) return false;
    bytes = builder.take();
  }
  const auto message = parse(bytes);
  return message && message->rejected == 0 && message->packets.back() == packet;
}

// No matter what comes: no crash, no more packets than the bytes can hold, and nothing that would not come again.
void checkAnything(const Bytes& bytes) {
  const auto message = parse(bytes);
  if (!message) {
    REQUIRE_FALSE(message.error().message.empty());
    return;
  }
  REQUIRE((message->packets.size() + message->unknown) * 8 <= bytes.size());
  REQUIRE((message->rejected == 0) == message->firstRejection.empty());
  REQUIRE(std::ranges::all_of(message->packets, [&](const Packet& p) { return comesAgain(p, message->format); }));
}

TEST_CASE("CIGI: a hundred thousand random and damaged datagrams") {
  std::mt19937_64 random(20240229);
  int understood = 0;
  std::vector<Bytes> seeds;
  for (const Format& format : cigiFormats()) {
    RandomCigi packets(random(), format.version);
    for (const bool host : {true, false}) {
      Builder builder = host ? Builder(format, packets.igControl()) : Builder(format, packets.startOfFrame());
      for (size_t i = 0; i < std::variant_size_v<Packet>; ++i)
        if (i != kIgControlIndex && i != kStartOfFrameIndex) REQUIRE(builder.add(packets.packet(i)));
      seeds.push_back(builder.take());
    }
  }
  for (int trial = 0; trial < 100'000; ++trial) {
    Bytes bytes;
    if (trial % 4 == 0) {
      bytes.resize(random() % 200);
      for (std::byte& b : bytes) b = static_cast<std::byte>(random());
      if (bytes.size() > 16 && trial % 8 == 0)  // a header, then noise
        std::copy_n(seeds[random() % seeds.size()].begin(), 16, bytes.begin());
    } else {
      bytes = seeds[random() % seeds.size()];
      damage(bytes, random);
    }
    checkAnything(bytes);
    understood += parse(bytes).has_value() ? 1 : 0;
  }
  CHECK(understood > 50'000);  // the damage does get behind the header
}

}  // namespace
}  // namespace eye
