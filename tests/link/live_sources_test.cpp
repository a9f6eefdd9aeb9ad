// DIS and X-Plane as sources, over real sockets on the loopback; URLs of live hosts.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <thread>

#include "link/angles.h"
#include "link/dis_motion.h"
#include "link/host_url.h"
#include "link/state_source.h"
#include "link/xplane.h"
#include "loopback.h"
#include "packets.h"

namespace eye {
namespace {

using namespace eye::test;

double metresBetween(const Pose& a, const Pose& b) {
  return glm::length(ecefFromGeodetic(a.position) - ecefFromGeodetic(b.position));
}

TEST_CASE("URLs of live hosts: options that are wrong are said so") {
  const std::pair<const char*, const char*> bad[] = {
      {"cigi://:8000?views=1", "there are: reply, answers, view, database, allow"},
      {"cigi://:8000?view", "view=VALUE"},
      {"cigi://:8000?view=", "view=VALUE"},
      {"cigi://:8000?view=1&view=2", "twice"},
      {"cigi://:8000?view=70000", "0 to 65535"},
      {"cigi://:8000?view=-1", "0 to 65535"},
      {"cigi://:8000?database=128", "1 to 127"},
      {"cigi://:8000?reply=127.0.0.1", "reply"},
      {"cigi://:8000?allow=nobody.invalid", "allow"},
      {"cigi://", "port"},
      {"native-fdm://:5550?reply=1", "there are: allow"},
      {"dis://:3000?entity=1:2", "site:application:entity"},
      {"dis://:3000?entity=1:2:3:4", "site:application:entity"},
      {"dis://:3000?entity=1:2:70000", "site:application:entity"},
      {"xplane://:49000?rate=100", "1 to 99"},
      {"xplane://300.1.1.1:49000", "300.1.1.1"}};
  for (const auto& [url, part] : bad) {
    INFO(url);
    const auto source = openStateSource(url);
    REQUIRE_FALSE(source);
    INFO(source.error().message);
    CHECK(exitStatus(source.error()) == 2);
    CHECK(source.error().message.find(part) != std::string::npos);
  }
}

TEST_CASE("DIS: dead reckoning of every kind is where small steps lead") {
  DisEntityState state;
  state.pose = Pose{{47, 8, 3000}, 30, 10, -20};
  const Mat3d attitude = ecefFromBody(state.pose);
  const Vec3d start = ecefFromGeodetic(state.pose.position);
  for (int kind = 1; kind <= 9; ++kind) {
    INFO(kind);
    state.deadReckoning = static_cast<DeadReckoning>(kind);
    const bool body = kind >= 6, turns = kind == 3 || kind == 4 || kind == 7 || kind == 8;
    const bool speeds = kind == 4 || kind == 5 || kind == 8 || kind == 9, moves = kind > 1;
    state.velocityMS = body ? Vec3d{200, 3, -5} : attitude * Vec3d{200, 3, -5};
    state.accelerationMS2 = body ? Vec3d{4, -1, 2} : attitude * Vec3d{4, -1, 2};
    state.turnRateBodyRadS = {0.1, 0.05, 0.2};
    // Many small steps of the definition: position by the velocity, attitude by the turn rate about the body's axes.
    Vec3d at = start;
    Mat3d axes = attitude;
    constexpr int kSteps = 200'000;
    const double dt = 5.0 / kSteps;
    for (int i = 0; moves && i < kSteps; ++i) {
      const double t = (i + 0.5) * dt;
      const Vec3d velocity = state.velocityMS + (speeds ? state.accelerationMS2 * t : Vec3d{});
      at += (body ? axes * velocity : velocity) * dt;
      if (!turns) continue;
      const Vec3d turn = state.turnRateBodyRadS * dt;
      Mat3d next = axes;
      next[0] += axes[1] * turn.z - axes[2] * turn.y;
      next[1] += axes[2] * turn.x - axes[0] * turn.z;
      next[2] += axes[0] * turn.y - axes[1] * turn.x;
      for (int k = 0; k < 3; ++k) axes[k] = glm::normalize(next[k]);
    }
    const Pose pose = deadReckoned(state, 5);
    CHECK(glm::length(ecefFromGeodetic(pose.position) - at) < 0.02);
    const Mat3d there = ecefFromBody(pose);
    for (int k = 0; k < 3; ++k) CHECK(glm::length(there[k] - axes[k]) < 1e-4);
  }
  CHECK(deadReckoned(state, 0) == state.pose);
}

TEST_CASE("DIS over UDP: the first entity heard, or the one that is asked for, and the others are passed over") {
  DisEntityState first, second;
  first.site = 1, first.application = 2, first.entity = 3;
  first.pose = Pose{{47, 8, 3000}, 30, 10, -20};
  second = first;
  second.entity = 4;
  second.pose.position.latDeg = 48;
  second.deadReckoning = DeadReckoning::fpw;
  second.velocityMS = {100, 0, 0};
  for (const bool asked : {false, true}) {
    const uint16_t port = freePort();
    const auto source = openStateSource(fmt::format("dis://:{}{}", port, asked ? "?entity=1:2:4" : ""));
    REQUIRE(source);
    const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
    for (int i = 0; i < 3; ++i)
      for (const auto* state : {&first, &second}) CHECK(socket->send(buildDisEntityState(*state)) == SendOutcome::sent);
    CHECK(socket->send(Bytes(144)) == SendOutcome::sent);
    const SourceSample sample = waitFor(**source, 7);
    CHECK((sample.counts.packets == 7 && sample.counts.rejected == 1));
    REQUIRE(sample.valid);
    if (!asked) {
      CHECK(metresBetween(sample.pose, first.pose) < 1e-6);
      continue;
    }
    CHECK(metresBetween(sample.pose, second.pose) < 100);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const double movedM = metresBetween((*source)->sample(0).pose, sample.pose);
    CHECK((movedM > 9 && movedM < 50));
  }
}

TEST_CASE("X-Plane over UDP: it is asked, asked again while silent, and told when it is enough") {
  const auto xplane = UdpSocket::listenOn({kLoopbackAddress, 0});
  auto source = openStateSource(fmt::format("xplane://:{}?rate=30", xplane->port()));
  REQUIRE(source);
  Bytes buffer(kMaxDatagramBytes);
  Peer asker;
  for (int i = 0; i < 2; ++i) {
    REQUIRE(xplane->wait(3000));
    const auto request = xplane->receiveFrom(buffer, asker);
    REQUIRE(request);
    CHECK(Bytes(request->begin(), request->end()) == buildRposRequest(30));
  }
  RposState state;
  state.pose = Pose{{-33.9, 151.2, 500}, 160, 3, 4};
  CHECK(xplane->sendTo(buildRpos(state), asker));
  CHECK(xplane->sendTo(Bytes(69), asker));
  const SourceSample sample = waitFor(**source, 2);
  CHECK(sample.counts.rejected == 1);
  REQUIRE(sample.valid);
  CHECK(sample.pose.position == state.pose.position);
  CHECK(sample.pose.headingDeg == Approx(160));
  source->reset();
  REQUIRE(xplane->wait(1000));
  const auto request = xplane->receiveFrom(buffer, asker);
  CHECK(Bytes(request->begin(), request->end()) == buildRposRequest(0));
}

TEST_CASE("X-Plane over UDP: the last request is that there be no more") {
  const auto xplane = UdpSocket::listenOn({kLoopbackAddress, 0});
  for (const int waitMs : {970, 985, 995}) {  // about when it would be asked again
    auto source = openStateSource(fmt::format("xplane://:{}?rate=30", xplane->port()));
    REQUIRE(source);
    REQUIRE(xplane->wait(3000));
    std::this_thread::sleep_for(std::chrono::milliseconds(waitMs));
    source->reset();
    Bytes buffer(kMaxDatagramBytes), last;
    Peer asker;
    while (xplane->wait(100)) {
      const auto request = xplane->receiveFrom(buffer, asker);
      last.assign(request->begin(), request->end());
    }
    CHECK(last == buildRposRequest(0));
  }
}

TEST_CASE("CIGI over UDP: replies go to a broadcast address too") {
  const auto everybody = UdpSocket::listenOn({"127.255.255.255", freePort()});
  REQUIRE(everybody);
  const auto source =
      openStateSource(fmt::format("cigi://:{}?reply=127.255.255.255:{}", freePort(), everybody->port()));
  REQUIRE(source);
  (*source)->frameDone({});
  CHECK(everybody->wait(2000));
}

}  // namespace
}  // namespace eye
