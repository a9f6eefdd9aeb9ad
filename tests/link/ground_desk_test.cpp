// The desk that answers questions about the ground: it ends when it is told to, and answers nobody else's.
#include "link/ground_desk.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <future>

namespace eye::cigi {
namespace {

using namespace std::chrono_literals;

// Takes its time, and counts.
class SlowProbe : public GroundProbe {
 public:
  explicit SlowProbe(std::atomic<int>& asked) : asked_(asked) {}
  std::optional<GroundPoint> under(double latDeg, double lonDeg) override {
    ++asked_;
    std::this_thread::sleep_for(5ms);
    return GroundPoint{{latDeg, lonDeg, 100}, {0, 0, 1}};
  }
  Result<std::optional<GroundPoint>> between(const Vec3d&, const Vec3d&) override { return std::nullopt; }

 private:
  std::atomic<int>& asked_;
};

std::vector<GroundQuestion> heights(int count, uint16_t firstId) {
  std::vector<GroundQuestion> questions(static_cast<size_t>(count));
  for (GroundQuestion& question : questions) {
    question.at = Geodetic{49, 20, 1000};
    question.request = HeightRequest{.id = firstId++, .kind = HeightKind::both, .point = *question.at};
  }
  return questions;
}

struct Desk {
  std::atomic<int> asked = 0;
  Replies replies{std::nullopt, std::nullopt};
  GroundDesk desk{
      replies, [this]() -> Result<std::unique_ptr<GroundProbe>> { return std::make_unique<SlowProbe>(asked); }, "test"};
  void awaitAsked(int count) const {
    for (int waitedMs = 0; asked < count && waitedMs < 5000; ++waitedMs) std::this_thread::sleep_for(1ms);
    REQUIRE(asked >= count);
  }
};

TEST_CASE("ground desk: it ends within a question's time, whatever waits") {
  auto desk = std::make_unique<Desk>();
  desk->desk.ask(heights(2000, 1));
  desk->awaitAsked(2);
  desk->desk.ask(heights(2000, 3000));  // while the others are under way
  auto ended = std::async(std::launch::async, [&] { desk.reset(); });
  REQUIRE(ended.wait_for(2s) == std::future_status::ready);
}

TEST_CASE("ground desk: the next host gets its own answers alone") {
  Desk desk;
  const Peer first{0x7f000001, 1000}, second{0x7f000001, 2000};
  const Format format;
  IgControl control;
  control.hostFrame = 1;
  desk.replies.heard(first, format, control, 0);
  desk.desk.ask(heights(300, 1));
  desk.awaitAsked(3);
  desk.desk.forget();
  desk.replies.forget();
  desk.replies.heard(second, format, control, 0);
  desk.desk.ask(heights(2, 700));
  std::vector<uint16_t> answered;
  for (int frame = 0; frame < 400 && answered.size() < 2; ++frame) {
    std::this_thread::sleep_for(5ms);
    const auto reply = desk.replies.frame({}, std::nullopt, 0);
    REQUIRE(reply);
    const auto message = parse(reply->message);
    REQUIRE(message);
    for (const Packet& packet : message->packets)
      if (const auto* height = std::get_if<HeightExtendedResponse>(&packet)) answered.push_back(height->id);
  }
  CHECK(answered == std::vector<uint16_t>{700, 701});
}

}  // namespace
}  // namespace eye::cigi
