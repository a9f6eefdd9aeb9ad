// A host of several channels: who has shown what, whom it waits for, and what it asks and prints.
#include "link/host_channels.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "link/cigi_host.h"
#include "link/host_lockstep.h"
#include "link/host_questions.h"
#include "link/loopback.h"
#include "link/reply_text.h"
#include "link/sender.h"
#include "link/state_source.h"

namespace eye::cigi {
namespace {

constexpr Peer kA{0x7f000001, 1}, kB{0x7f000001, 2};

TEST_CASE("host channels: all have a frame when as many as expected have shown it, whatever the numbers wrap to") {
  HostChannels channels(2);
  CHECK_FALSE(channels.allHave(0));
  channels.heard(kA, 5);
  CHECK_FALSE(channels.allHave(5));  // the other has not spoken
  channels.heard(kB, 4);
  CHECK(channels.allHave(4));
  CHECK_FALSE(channels.allHave(5));
  CHECK(channels.behind(5) == std::vector<Peer>{kB});
  channels.heard(kB, 5);
  CHECK(channels.allHave(5));
  channels.heard(kA, 0xffffffff);
  channels.heard(kB, 1);
  CHECK(channels.behind(1) == std::vector<Peer>{kA});
  channels.heard(kA, 2);
  CHECK(channels.allHave(1));
}

TEST_CASE("host channels: one that was given up is not waited for until it speaks again; none is never enough") {
  HostChannels channels(2);
  channels.heard(kA, 7);
  channels.heard(kB, 3);
  channels.giveUp(kB);
  CHECK(channels.allHave(7));
  CHECK(channels.behind(7).empty());
  CHECK(channels.heard(kB, 6));
  CHECK_FALSE(channels.allHave(7));
  channels.giveUp(kA);
  channels.giveUp(kB);
  CHECK_FALSE(channels.allHave(1));
}

TEST_CASE("host channels: one that ends, by standby after it operated, is not waited for; one that begins so is") {
  HostChannels channels(2);
  channels.heard(kA, 7);
  channels.heard(kB, 0, false);
  CHECK_FALSE(channels.allHave(7));
  channels.heard(kB, 0, false);
  CHECK(channels.behind(7) == std::vector<Peer>{kB});
  channels.heard(kB, 6);
  CHECK_FALSE(channels.heard(kB, 0, false));
  CHECK(channels.allHave(7));
  CHECK(channels.heard(kB, 7));
}

TEST_CASE("CIGI over UDP: a synchronous host of two channels goes on at once when one of them ends") {
  std::vector<std::unique_ptr<StateSource>> all;
  const uint16_t port = test::freePort();
  constexpr const char* kGroup = "239.255.69.92";
  for (int i = 0; i < 2; ++i) {
    auto source = openStateSource(fmt::format("cigi://{}:{}?interface=127.0.0.1", kGroup, port));
    REQUIRE(source);
    all.push_back(std::move(*source));
  }
  const auto socket = UdpSocket::connectTo({kGroup, port}, "127.0.0.1");
  ReplyListener replies(*socket, 2);
  const auto show = [&](uint32_t number) {
    (void)socket->send(hostMessage({3, 3}, {number, 0, 0, Pose{{46, 8, 1000}, 0, 0, 0}}));
    for (const auto& channel : all) {
      CHECK(test::waitFor(*channel, number).hostFrame == number);
      channel->frameDone({});
    }
  };
  show(1);
  CHECK(replies.awaitChannels(1, 2000));
  all.pop_back();
  show(2);
  CHECK(replies.awaitChannels(2, 200));
  all.clear();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  CHECK_FALSE(replies.awaitChannels(2, 0));  // none is left
}

TEST_CASE("requests go out first and then in frames in which they are due, so that each has one answer") {
  const auto asks = parseAsks({"hat,los", "hot", "hat"});
  REQUIRE(asks);
  CHECK(*asks == std::vector{Ask::hat, Ask::los, Ask::hot});
  const auto bad = parseAsks({"height"});
  REQUIRE_FALSE(bad);
  CHECK(bad.error().message.find("hat, hot, hat-hot, los, los-extended") != std::string::npos);
  const AskPlan plan{*asks, 7, 1};
  for (uint32_t frame = 0; frame < 200; ++frame) {
    const auto packets = requestsAt(plan, frame);
    const bool isDue = frame == 1 || frame % 63 == 0;  // the first multiple of 7 from a second on
    INFO(frame);
    REQUIRE(packets.size() == (isDue ? 3u : 0u));
    if (isDue) CHECK(std::get<HeightRequest>(packets[0]).everyFrames == 7);
  }
}

TEST_CASE("replies in words: every kind has a line, and what is not valid says so") {
  CHECK(textOf(StartOfFrame{.databaseNumber = -3,
                            .mode = IgMode::operate,
                            .igFrame = 12,
                            .ticks = 250'000,
                            .hostFrame = 11,
                            .overframing = true,
                            .paging = true}) ==
        "Start of Frame 12, operate, database -3, host frame 11, clock 2.50000 s, overframing, paging");
  CHECK(textOf(HeightResponse{2, true, 10, 812.346}) == "HOT 2 (host frame ...a): 812.35 m");
  CHECK(textOf(HeightResponse{1, false, 10, {}}) == "HAT 1 (host frame ...a): not valid");
  CHECK(textOf(HeightExtendedResponse{3, 1, SurfacePoint{100, 900, 7, 45, 80}}) ==
        "HAT/HOT 3 (host frame ...1): HAT 100.00 m, HOT 900.00 m, normal azimuth 45.0 elevation 80.0, material 7");
  SightResponse sight;
  sight.id = 4;
  CHECK(textOf(sight) == "LOS 4 (host frame ...0): nothing met, or not valid");
  sight.rangeM = 1234.5;
  CHECK(textOf(sight) == "LOS 4 (host frame ...0): met at 1234.50 m");
  sight.visible = true;
  CHECK(textOf(sight) == "LOS 4 (host frame ...0): visible, range 1234.50 m");
  SightExtendedResponse extended;
  extended.id = 5;
  extended.valid = true;
  extended.rangeM = 50;
  extended.latDegOrXM = 49.25, extended.lonDegOrYM = 20.1, extended.altMOrZM = 1500;
  CHECK(textOf(extended) ==
        "LOS extended 5 (host frame ...0): met at 50.00 m, 49.250000 20.100000 1500.00 m, normal azimuth 0.0 elevation "
        "0.0");
  CHECK(textOf(Weather{}).empty());
}

}  // namespace
}  // namespace eye::cigi
