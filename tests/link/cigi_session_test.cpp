// What a CIGI session makes of messages: recorded flights, entities on entities, motion, sky and air, and questions.
#include "link/cigi_session.h"

#include <catch2/catch.hpp>

#include "cigi_random.h"
#include "geo/sun.h"
#include "link/angles.h"
#include "link/cigi_host.h"
#include "link/native_fdm.h"
#include "link/pcap.h"
#include "link/track_file.h"
#include "support/places.h"

namespace eye {
namespace {

using namespace eye::cigi;

constexpr int64_t kSecond = 1'000'000'000;

struct Host {
  Session session;
  uint32_t frame = 0;
  int64_t nowNs = kSecond;
  bool smoothing = false;
  IgMode mode = IgMode::operate;

  explicit Host(uint16_t view = 0) : session(view) {}
  // The packets in a message of the next frame, through the wire.
  void says(const std::vector<Packet>& packets, Version version = {3, 3}) {
    IgControl control;
    control.mode = mode;
    control.hostFrame = frame++;
    control.smoothing = smoothing;
    Builder builder(Format{version, std::endian::big}, control);
    for (const Packet& packet : packets) REQUIRE(builder.add(packet));
    const auto message = parse(builder.take());
    REQUIRE(message);
    REQUIRE(message->rejected == 0);
    session.take(*message, nowNs, "test");
  }
  std::optional<Pose> pose(double inS = 0) {
    return poseOf(session.snapshot().eye, nowNs + static_cast<int64_t>(inS * 1e9));
  }
};

Entity entityAt(uint16_t id, const Pose& pose, EntityTraits traits = {}) {
  return {id, traits, EntityPlace{Clamp::none, 0, pose.rollDeg, pose.pitchDeg, pose.headingDeg, pose.position}};
}

Entity attached(uint16_t id, uint16_t parentId, const BodyOffset& offset, double yaw, double pitch, double roll) {
  return {id, EntityTraits{}, EntityPlace{Clamp::none, parentId, roll, pitch, yaw, offset}};
}

// The plain twin: rotations about one axis after another, written out by their elements.
struct Twin {
  Vec3d at{};
  double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  void turn(int i, int j, double deg) {  // columns i and j of m: the body's axis i turns towards j
    const double c = std::cos(deg * M_PI / 180), s = std::sin(deg * M_PI / 180);
    for (auto& row : m) {
      const double a = row[i], b = row[j];
      row[i] = c * a + s * b;
      row[j] = c * b - s * a;
    }
  }
  void turnYawPitchRoll(double yaw, double pitch, double roll) { turn(0, 1, yaw), turn(2, 0, pitch), turn(1, 2, roll); }
  void move(double x, double y, double z) {
    for (int i = 0; i < 3; ++i) at[i] += m[i][0] * x + m[i][1] * y + m[i][2] * z;
  }
  static Twin of(const Pose& pose) {
    Twin twin;
    twin.at = ecefFromGeodetic(pose.position);
    const double lat = pose.position.latDeg * M_PI / 180, lon = pose.position.lonDeg * M_PI / 180;
    const double north[] = {-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat)};
    const double east[] = {-std::sin(lon), std::cos(lon), 0};
    const double down[] = {-std::cos(lat) * std::cos(lon), -std::cos(lat) * std::sin(lon), -std::sin(lat)};
    for (int i = 0; i < 3; ++i) twin.m[i][0] = north[i], twin.m[i][1] = east[i], twin.m[i][2] = down[i];
    twin.turnYawPitchRoll(pose.headingDeg, pose.pitchDeg, pose.rollDeg);
    return twin;
  }
};

void checkSame(const std::optional<Pose>& pose, const Twin& twin) {
  REQUIRE(pose);
  CHECK(glm::length(ecefFromGeodetic(pose->position) - twin.at) < 1e-8 * (1 + glm::length(twin.at) * 1e-6));
  const Mat3d axes = ecefFromBody(*pose);
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 3; ++i) CHECK(axes[axis][i] == Approx(twin.m[i][axis]).margin(1e-9));
}

double metresBetween(const Pose& a, const Pose& b) {
  return glm::length(ecefFromGeodetic(a.position) - ecefFromGeodetic(b.position));
}

TEST_CASE(
    "session: a recorded flight is where its packets say, in both versions, and its side view where a matrix is") {
  for (const char* name : {"cigi33_ccl_c1723.pcap", "cigi40_ccl_c1723.pcap"}) {
    const auto file = readTrackFile(eye::test::kTestData + "/captures/" + name);
    if (!file) {
      WARN("no recording " << name);
      return;
    }
    const auto capture = parsePcap(*file);
    REQUIRE(capture);
    Session ahead(0), side(1);
    size_t compared = 0;
    for (const auto& datagram : capture->datagrams) {
      if (!isFromHost(datagram.payload)) continue;
      const auto message = parse(datagram.payload);
      REQUIRE(message);
      ahead.take(*message, datagram.timeNs, "recording");
      side.take(*message, datagram.timeNs, "recording");
      const auto told = entityPoseIn(datagram.payload);
      REQUIRE(told);
      REQUIRE(poseOf(ahead.snapshot().eye, datagram.timeNs + kSecond / 60) == told);
      Twin twin = Twin::of(*told);
      twin.move(1.5, -0.4f, -1.2f);
      twin.turnYawPitchRoll(60, -3, 0);
      if (++compared % 100 == 0) checkSame(poseOf(side.snapshot().eye, datagram.timeNs), twin);
    }
    CHECK(compared == 3600);
    CHECK(ahead.lostFrames() == 0);
    const ViewEdges edges = side.snapshot().edges;
    CHECK((edges.leftDeg == -30.0 && edges.rightDeg == 30.0 && edges.topDeg == 20.0 && edges.bottomDeg == -20.0));
    CHECK(edges.nearM == 0.5);
    CHECK(ahead.snapshot().edges == ViewEdges{});
    CHECK(ahead.snapshot().air.visibilityM == 16000.0);
    CHECK(ahead.snapshot().sky.julianDayUtc == Approx(julianDay(2026, 6, 21 + 14.5 / 24)).margin(2e-3));
  }
}

TEST_CASE("session: one flight is at the same poses in native-fdm, CIGI 3.3 and 4.0") {
  Session in33(0), in40(0);
  for (int i = 0; i < 600; ++i) {
    const double t = i / 60.0;
    Pose pose{
        {46 + 1e-3 * t, 179.995 + 1e-3 * t, 1000 + 30 * std::sin(t)}, 350 + 3 * t, 20 * std::sin(t), 60 * std::cos(t)};
    if (pose.position.lonDeg > 180) pose.position.lonDeg -= 360;
    normaliseAngles(pose);
    const auto fdm = parseNativeFdm(buildNativeFdm({pose, std::nullopt}));
    REQUIRE(fdm);
    for (auto* session : {&in33, &in40}) {
      const Version version = session == &in33 ? Version{3, 3} : Version{4, 0};
      const auto message = parse(hostMessage(version, {static_cast<uint32_t>(i), 0, t, pose}));
      REQUIRE(message);
      session->take(*message, i * kSecond / 60, "test");
      const auto there = poseOf(session->snapshot().eye, i * kSecond / 60);
      REQUIRE(there);
      CHECK(there->position == pose.position);
      CHECK(metresBetween(*there, fdm->pose) < 1e-8);
      CHECK(std::abs(wrappedDeg180(there->headingDeg - fdm->pose.headingDeg)) < 5e-5);  // floats on both wires
      CHECK(there->pitchDeg == Approx(fdm->pose.pitchDeg).margin(1e-5));
      CHECK(there->rollDeg == Approx(fdm->pose.rollDeg).margin(1e-5));
    }
    CHECK(poseOf(in33.snapshot().eye, 0) == poseOf(in40.snapshot().eye, 0));
  }
}

TEST_CASE("session: entities on entities and the eye point in them are where plain matrices put them") {
  std::mt19937_64 random(5);
  const auto within = [&](double lowest, double highest) {
    return static_cast<double>(
        static_cast<float>(lowest + (highest - lowest) * static_cast<double>(random() >> 11) * 0x1p-53));
  };
  for (int round = 0; round < 200; ++round) {
    Host host(3);
    const Version version = round % 2 == 0 ? Version{3, 3} : Version{4, 0};
    const Pose root{
        {within(-89, 89), within(-180, 180), within(-100, 30000)}, within(0, 360), within(-80, 80), within(-180, 180)};
    Twin twin = Twin::of(root);
    std::vector<Packet> packets{entityAt(10, root)};
    const int depth = round % 5;
    for (int i = 1; i <= depth; ++i) {
      const BodyOffset offset{within(-50, 50), within(-50, 50), within(-50, 50)};
      const double yaw = within(-180, 180), pitch = within(-80, 80), roll = within(-180, 180);
      packets.emplace_back(
          attached(static_cast<uint16_t>(10 + i), static_cast<uint16_t>(9 + i), offset, yaw, pitch, roll));
      twin.move(offset.xM, offset.yM, offset.zM);
      twin.turnYawPitchRoll(yaw, pitch, roll);
    }
    ViewControl eye{3,
                    0,
                    static_cast<uint16_t>(10 + depth),
                    within(-9, 9),
                    within(-9, 9),
                    within(-9, 9),
                    within(-180, 180),
                    within(-80, 80),
                    within(0, 360)};
    packets.emplace_back(eye);
    host.says(packets, version);
    twin.move(*eye.xM, *eye.yM, *eye.zM);
    twin.turnYawPitchRoll(*eye.yawDeg, *eye.pitchDeg, *eye.rollDeg);
    checkSame(host.pose(), twin);
    // What a later View Control leaves out stays; another view's, or a group's that this view is not in, is not ours.
    eye.xM.reset(), eye.yawDeg.reset();
    ViewControl others = eye;
    others.viewId = 4, others.entityId = 999;
    ViewControl groups = eye;
    groups.groupId = 7, groups.entityId = 999;
    host.says({eye, others, groups}, version);
    checkSame(host.pose(), twin);
  }
}

TEST_CASE("session: circles, depths without end, parents that are not there and destroyed ones give no pose") {
  Host host;
  const Pose pose{{47, 8, 500}, 10, 2, 3};
  host.says({attached(0, 1, {}, 0, 0, 0), attached(1, 0, {}, 0, 0, 0)});
  CHECK_FALSE(host.pose());
  host.says({entityAt(1, pose)});
  CHECK(host.pose());
  EntityTraits destroyed;
  destroyed.state = EntityState::destroyed;
  host.says({entityAt(1, pose, destroyed)});
  CHECK_FALSE(host.pose());  // its child is destroyed with it
  host.says({entityAt(1, pose)});
  CHECK_FALSE(host.pose());
  std::vector<Packet> chain{entityAt(100, pose)};
  for (uint16_t id = 101; id < 100 + kMaxChain + 1; ++id)
    chain.emplace_back(attached(id, static_cast<uint16_t>(id - 1), {}, 0, 0, 0));
  host.says(chain);
  ViewControl view;
  view.entityId = 100 + kMaxChain - 1;
  host.says({view});
  CHECK(host.pose());
  view.entityId = 100 + kMaxChain;
  host.says({view});
  CHECK_FALSE(host.pose());
}

TEST_CASE("session: the table is bounded, and what is beyond is counted") {
  EntityTable table;
  for (uint32_t id = 0; id < 5000; ++id) table.take(entityAt(static_cast<uint16_t>(id), Pose{}), Stamp{1, 1});
  CHECK(table.size() == kMaxEntities);
  CHECK(table.turnedAway() == 5000 - kMaxEntities);
}

TEST_CASE("session: a rate carries on what is not placed anew, level along the ground") {
  const Pose start{{60, 10, 1000}, 90, 0, 0};
  Host host;
  Velocity velocity;
  velocity.yMS = 200, velocity.yawDegS = 3;
  host.says({entityAt(0, start), velocity});
  CHECK(host.pose(0.1) == start);  // told in this frame: shown as told
  CHECK_FALSE(isCarriedOn(host.session.snapshot().eye));
  for (int i = 0; i < 600; ++i) host.nowNs += kSecond / 60, host.says({});
  const auto after = host.pose();
  REQUIRE(after);
  CHECK(metresBetween(*after, start) == Approx(2000).margin(0.05));
  CHECK(after->position.altM == Approx(1000).margin(1e-6));
  CHECK(after->headingDeg == Approx(120).margin(1e-3));
  CHECK(isCarriedOn(host.session.snapshot().eye));
  CHECK(metresBetween(*host.pose(0.1), *after) == Approx(20).margin(0.1));
  // In the body's axes, with an acceleration, and smoothing by the host's leave.
  Host smooth;
  smooth.smoothing = true;
  EntityTraits traits;
  traits.smoothing = true;
  velocity = {};
  velocity.inBodyFrame = true;
  velocity.xMS = 100;
  Acceleration acceleration;
  acceleration.xMS2 = 10;
  acceleration.inBodyFrame = true;
  smooth.says({entityAt(0, start, traits), velocity, acceleration}, {4, 0});
  CHECK(metresBetween(*smooth.pose(0.1), start) == Approx(10 + 0.05).margin(1e-4));
  CHECK(smooth.pose(0.1)->position.lonDeg > 10);
}

TEST_CASE("session: lost, overtaken and repeated frames; a host that begins anew") {
  Host host;
  const auto at = [](double alt) { return entityAt(0, Pose{{1, 2, alt}, 0, 0, 0}); };
  host.says({at(100)});
  host.frame = 5;
  host.says({at(105)});
  CHECK(host.session.lostFrames() == 4);
  host.frame = 3;
  host.says({at(103)});
  CHECK(host.session.lostFrames() == 3);
  CHECK(host.pose()->position.altM == 105);
  host.frame = 3;
  host.says({at(103)});  // once more
  CHECK(host.session.lostFrames() == 3);
  host.frame = 5;
  host.says({at(106)});  // one frame in two datagrams
  CHECK(host.session.lostFrames() == 3);
  CHECK(host.pose()->position.altM == 106);
  host.frame = 4'000'000'000;
  host.says({at(200)});
  CHECK(host.session.lostFrames() == 3);
  host.frame = 0;
  host.says({at(300)});
  CHECK(host.session.lostFrames() == 3);
  CHECK(host.pose()->position.altM == 300);
  host.frame = 0xffffffff;
  host.says({});
  host.says({});  // the number wraps
  CHECK(host.frame == 1);
}

TEST_CASE("session: a host that begins anew from the same port is followed within ten frames") {
  Host host;
  const auto at = [](double alt) { return entityAt(0, Pose{{1, 2, alt}, 0, 0, 0}); };
  for (int i = 0; i < 90; ++i) host.says({at(100)});
  host.frame = 0;
  int frames = 0;
  do {
    host.says({at(700)});
    ++frames;
  } while (host.pose()->position.altM != 700 && frames < 90);
  CHECK(frames <= 10);
  CHECK(host.session.lostFrames() == 0);
  // Overtaken ones, however many, are no new beginning: newer ones come between them.
  host.frame = 200;
  host.says({at(800)});
  for (uint32_t i = 0; i < 40; ++i) {
    host.frame = 150 + i;
    host.says({at(900)});
    host.frame = 201 + i;
    host.says({at(800)});
  }
  CHECK(host.pose()->position.altM == 800);
}

TEST_CASE(
    "session: a host that was silent and counts from lower on is another run of it: nothing of the former is left") {
  for (const uint32_t back : {40u, 5000u}) {  // frames; few are overtaken ones while it speaks
    Host host;
    ViewDefinition narrow;
    narrow.leftDegOrM = -5, narrow.rightDegOrM = 5;
    HeightRequest repeated;
    repeated.id = 78, repeated.everyFrames = 1, repeated.point = Geodetic{1, 2, 0};
    host.frame = 6000;
    host.says({entityAt(3, Pose{{1, 2, 100}, 0, 0, 0}), narrow, repeated});
    const uint64_t resets = host.session.resets();
    (void)host.session.takeQuestions();
    host.frame = 6000 - back;
    host.nowNs += 5 * kSecond;
    ViewDefinition high;
    high.topDegOrM = 20;
    host.says({entityAt(0, Pose{{1, 2, 700}, 0, 0, 0}), high});
    CHECK(host.session.resets() == resets + 1);
    REQUIRE(host.pose());
    CHECK(host.pose()->position.altM == Approx(700));
    CHECK(host.session.snapshot().edges.topDeg == 20.0);
    CHECK_FALSE(host.session.snapshot().edges.leftDeg);
    CHECK(host.session.takeQuestions().empty());
  }
  // Silent, and it goes on: a host that was halted.
  Host host;
  ViewDefinition narrow;
  narrow.leftDegOrM = -5;
  host.says({narrow});
  const uint64_t resets = host.session.resets();
  host.nowNs += 60 * kSecond;
  host.says({});
  CHECK(host.session.resets() == resets);
  CHECK(host.session.snapshot().edges.leftDeg == -5.0);
}

TEST_CASE("session: visibility has no step where a layer's edge begins, whether or not an atmosphere is told") {
  for (const bool told : {false, true}) {
    Host host;
    Weather haze;
    haze.enabled = true;
    haze.layer = 9, haze.visibilityM = 20000, haze.baseM = 0, haze.thicknessM = 2000, haze.transitionM = 1800;
    host.says({haze});
    if (told) {
      Atmosphere atmosphere;
      atmosphere.visibilityM = 100000;
      host.says({atmosphere});
    }
    const Air air = host.session.snapshot().air;
    for (double altM = 0; altM < 6000; altM += 10) {
      const double here = *visibilityAt(air, altM), above = *visibilityAt(air, altM + 10);
      INFO(altM << " m: " << here << " m, then " << above);
      CHECK(std::abs(1 / here - 1 / above) <= 1 / 20000.0 / 180 + 1e-9);
      CHECK(here <= (told ? 100000 : kClearVisibilityM) + 1e-6);
    }
  }
}

TEST_CASE("session: standby forgets, and obeys from operate on") {
  Host host;
  host.says({entityAt(0, Pose{})});
  CHECK(host.pose());
  host.mode = IgMode::standby;
  host.says({entityAt(0, Pose{})});
  CHECK_FALSE(host.pose());
  host.mode = IgMode::operate;
  host.says({});
  CHECK_FALSE(host.pose());
  host.says({entityAt(0, Pose{})});
  CHECK(host.pose());
}

TEST_CASE("session: air has layers with soft edges; the sky's clock runs when it is told to") {
  Host host;
  Atmosphere atmosphere;
  atmosphere.visibilityM = 20000;
  Weather fog, cloud;
  fog.enabled = cloud.enabled = true;
  fog.layer = 0, fog.visibilityM = 200, fog.baseM = 400, fog.thicknessM = 100;
  cloud.layer = 1, cloud.visibilityM = 100, cloud.baseM = 2000, cloud.thicknessM = 500, cloud.transitionM = 100;
  CelestialSphere sky;
  sky.dateTime = DateTime{2024, 6, 21, 12, 30, 0};
  host.says({atmosphere, fog, cloud, sky});
  const auto at = [&](double altM) { return *visibilityAt(host.session.snapshot().air, altM); };
  CHECK(at(-100) == Approx(200));
  CHECK(at(500) == Approx(200));
  CHECK(at(501) == Approx(20000));
  CHECK(at(1899) == Approx(20000));
  CHECK(at(1950) == Approx(1 / (0.5 / 20000 + 0.5 / 100)));
  CHECK(at(2250) == Approx(100));
  CHECK(at(2601) == Approx(20000));
  cloud.enabled = false;
  host.says({cloud});
  CHECK(at(2250) == Approx(20000));
  CHECK_FALSE(visibilityAt(Air{}, 0));

  const double told = julianDay(2024, 6, 21 + 12.5 / 24);
  CHECK(julianDayAt(host.session.snapshot().sky, host.nowNs + 3600 * kSecond) == Approx(told).margin(1e-9));
  sky.clockRuns = true;
  host.says({sky});
  CHECK(*julianDayAt(host.session.snapshot().sky, host.nowNs + 3600 * kSecond) - told == Approx(1 / 24.0).margin(1e-8));
}

TEST_CASE("a host's frustum replaces what it says and keeps what it does not, and never has no picture") {
  const Frustum own{-1, 1, -0.75, 0.75, 1};
  CHECK(frustumWith(own, {}) == own);
  const Frustum left = frustumWith(own, {-60, 0, std::nullopt, std::nullopt, 0.5});
  CHECK(left.tanLeft == Approx(-std::sqrt(3)));
  CHECK(left.tanRight == 0);
  CHECK((left.tanTop == 0.75 && left.nearM == 0.5));
  CHECK(frustumWith(own, {30, -30, 10, 10, std::nullopt}) == own);
}

// A sphere for a ground, of 6,371 km: every answer is known.
class Ball : public GroundProbe {
 public:
  static constexpr double kRadiusM = 6371000;
  std::optional<GroundPoint> under(double latDeg, double lonDeg) override {
    return GroundPoint{{latDeg, lonDeg, 120}, upAt(latDeg, lonDeg)};
  }
  Result<std::optional<GroundPoint>> between(const Vec3d& from, const Vec3d& to) override {
    const Vec3d d = to - from;
    const double a = glm::dot(d, d), b = glm::dot(from, d), c = glm::dot(from, from) - kRadiusM * kRadiusM;
    const double root = b * b - a * c;
    const double s = root < 0 ? 2 : (-b - std::sqrt(root)) / a;
    if (s < 0 || s > 1) return std::nullopt;
    const Vec3d hit = from + d * s;
    return GroundPoint{geodeticFromEcef(hit), glm::normalize(hit)};
  }
};

TEST_CASE("session: questions about the ground are resolved, repeated as asked, and answered") {
  Host host;
  Ball ball;
  const auto answers = [&] {
    std::vector<Packet> packets;
    for (const GroundQuestion& question : host.session.takeQuestions()) packets.push_back(answerTo(question, &ball));
    return packets;
  };
  HeightRequest above{7, HeightKind::aboveTerrain, 0, 0, Geodetic{10, 20, 1000}};
  HeightRequest body{8, HeightKind::both, 3, 0, BodyOffset{0, 0, 50}};
  host.frame = 18;
  host.says({entityAt(0, Pose{{10, 20, 2000}, 0, 0, 0}), above, body});
  auto said = answers();
  REQUIRE(said.size() == 2);
  CHECK(said[0] == Packet(HeightResponse{7, false, 2, 880.0}));
  const auto* both = std::get_if<HeightExtendedResponse>(&said[1]);
  REQUIRE((both != nullptr && both->surface));
  CHECK(both->surface->aboveTerrainM == Approx(1830).margin(1e-6));
  CHECK(both->surface->ofTerrainM == 120);
  CHECK(both->surface->normalElevationDeg == Approx(90));
  // Every third frame, once each.
  std::vector<size_t> counts;
  for (int i = 0; i < 7; ++i) host.says({}), counts.push_back(answers().size());
  CHECK(counts == std::vector<size_t>{0, 0, 1, 0, 0, 1, 0});
  body.everyFrames = 0;
  host.says({body});
  CHECK(answers().size() == 1);
  for (int i = 0; i < 4; ++i) {
    host.says({});
    CHECK(answers().empty());
  }

  // Straight down from the equator; then level, over the ground; with the source in the entity's frame.
  SightVectorRequest ray{9, true, false, 0, 0, 0, 0, -90, 10, 1e6, Geodetic{0, 0, 10000}, 0};
  host.says({ray});
  said = answers();
  const auto* down = std::get_if<SightExtendedResponse>(&said.at(0));
  REQUIRE((down != nullptr && down->valid && down->rangeM));
  CHECK(*down->rangeM == Approx(kSemiMajorM + 10000 - Ball::kRadiusM));
  CHECK_FALSE(down->visible);
  CHECK(down->normalElevationDeg == Approx(90).margin(1e-5));
  ray.elevationDeg = 10;
  host.says({ray});
  said = answers();
  CHECK_FALSE(std::get<SightExtendedResponse>(said.at(0)).valid);
  ray = {9, true, true, 0, 0, 0, 0, -90, 0, 1e6, BodyOffset{0, 0, 0}, 0};
  host.says({ray});
  said = answers();
  const auto inBody = std::get<SightExtendedResponse>(said.at(0));
  CHECK(inBody.valid);
  CHECK(inBody.latDegOrXM == Approx(0).margin(1e-6));
  CHECK(inBody.altMOrZM == Approx(*inBody.rangeM));
  SightSegmentRequest segment{4, false, false, 0, 0, 0, std::nullopt, Geodetic{0, 0, 10000}, Geodetic{0, 1, 10000}, 0};
  host.says({segment});
  said = answers();
  CHECK(std::get<SightResponse>(said.at(0)).visible);
  CHECK(std::get<SightResponse>(said.at(0)).rangeM == Approx(111493.9).margin(1.0));
  segment.destination = Geodetic{0, 90, 10000};
  segment.sourceEntityId = 77, segment.source = BodyOffset{};
  host.says({segment});
  CHECK_FALSE(std::get<SightResponse>(answers().at(0)).rangeM);  // an entity that there is not
  host.says({above});
  const auto question = host.session.takeQuestions();
  CHECK(answerTo(question.at(0), nullptr) ==
        Packet(HeightResponse{7, false, static_cast<uint8_t>((host.frame - 1) & 15), std::nullopt}));
}

TEST_CASE("session: a datagram that a network has doubled asks once; one that is sent again asks again") {
  Host host;
  HeightRequest once{7, HeightKind::aboveTerrain, 0, 0, Geodetic{10, 20, 1000}};
  HeightRequest often{8, HeightKind::aboveTerrain, 2, 0, Geodetic{10, 20, 1000}};
  const auto asked = [&](const std::vector<Packet>& packets, double laterS, uint32_t frame) {
    host.nowNs += static_cast<int64_t>(laterS * 1e9);
    host.frame = frame;
    host.says(packets);
    return host.session.takeQuestions().size();
  };
  CHECK(asked({once, often}, 0, 10) == 2);
  CHECK(asked({once, often}, 0.02, 10) == 0);
  CHECK(asked({}, 0, 11) == 0);
  CHECK(asked({once, often}, 0.02, 10) == 0);  // overtaken as well
  CHECK(asked({once}, 0, 11) == 1);            // the same question, of another frame
  CHECK(asked({}, 0, 12) == 1);                // in time, as if nothing had come twice
  CHECK(asked({once, often}, 0.07, 10) == 1);  // more than 0.1 s after the first: sent again; overtaken, so only once
  CHECK(asked({once}, 0.2, 13) == 1);
  CHECK(asked({once}, 0.09, 13) == 0);
  CHECK(asked({once}, 0.02, 13) == 1);
  // Two of one frame that ask for different things are no doubles.
  CHECK(asked({once, once}, 0, 14) == 3);  // and the one that repeats
  often.everyFrames = 0;
  CHECK(asked({often, once}, 0, 14) == 2);
  // A thousand heights in one frame's datagrams, all of them twice.
  size_t first = 0, again = 0;
  const auto heightsFrom = [&](uint16_t id) {
    std::vector<Packet> heights;
    for (uint16_t i = 0; i < 40; ++i)
      heights.push_back(HeightRequest{static_cast<uint16_t>(id + i), HeightKind::aboveTerrain, 0, 0, Geodetic{}});
    return heights;
  };
  for (uint16_t id = 0; id < 1000; id = static_cast<uint16_t>(id + 40)) first += asked(heightsFrom(id), 0, 20);
  for (uint16_t id = 0; id < 1000; id = static_cast<uint16_t>(id + 40)) again += asked(heightsFrom(id), 0, 20);
  CHECK(first == 1000);
  CHECK(again == 0);
  // Another run of the host may say the very same.
  CHECK(asked({once}, 0, 5) == 1);
  host.session.reset();
  CHECK(asked({once}, 0, 5) == 1);
}

TEST_CASE("session: random messages of every kind leave it bounded and its poses believed") {
  for (const Version version : {Version{3, 3}, Version{4, 0}}) {
    test::RandomCigi random(11, version);
    Session session(0);
    std::mt19937_64 chance(3);
    for (int i = 0; i < 20'000; ++i) {
      IgControl control;
      control.mode = chance() % 50 == 0 ? IgMode::standby : IgMode::operate;
      control.hostFrame = static_cast<uint32_t>(i);
      Builder builder(Format{version, std::endian::little}, control);
      for (int k = 0; k < 4; ++k) builder.add(random.packet(1 + chance() % 11));
      const auto message = parse(builder.take());
      REQUIRE(message);
      session.take(*message, i * kSecond / 60, "test");
      const auto pose = poseOf(session.snapshot().eye, i * kSecond / 60);
      if (pose) REQUIRE((std::abs(pose->position.latDeg) <= 90 && std::isfinite(pose->headingDeg)));
      REQUIRE(session.takeQuestions().size() <= kMaxPackets + 256);
    }
  }
}

}  // namespace
}  // namespace eye
