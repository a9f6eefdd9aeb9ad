// What a frame gets of its sources.
#include <catch2/catch.hpp>

#include "app/image_generator.h"

namespace eye {
namespace {

// Says what the test has put into `next`.
class ToldSource final : public StateSource {
 public:
  explicit ToldSource(const SourceSample& next) : next_(next) {}
  SourceSample sample(double) override { return next_; }
  bool isLive() const override { return true; }
  bool isFixed() const override { return false; }

 private:
  const SourceSample& next_;
};

TEST_CASE("lens, clock and visibility of a host stay while the eye's entity is gone") {
  SourceSample told;
  Sources sources = Sources::of(std::make_unique<ToldSource>(told));
  told.live = told.valid = true;
  told.arrivedNs = 100;
  told.pose.position.altM = 700;
  told.edges.leftDeg = -20;
  told.julianDayUtc = 2460000.5;
  told.visibilityM = 3000;
  told.clouds[0].coverage = 0.5;
  told.hostFrame = 7;
  CHECK(sources.sample(0).valid);
  told.valid = false;  // the session is as it was, but for the entity
  told.pose = {};
  told.visibilityM.reset();
  told.arrivedNs = 200;
  told.edges.leftDeg = -25;
  told.hostFrame = 8;
  for (int frame = 0; frame < 3; ++frame) {
    const SourceSample sample = sources.sample(0);
    CHECK_FALSE(sample.valid);
    CHECK(sample.edges.leftDeg == -25.0);
    CHECK(sample.julianDayUtc == 2460000.5);
    CHECK(sample.visibilityM == 3000.0);
    CHECK(sample.clouds == told.clouds);
    CHECK(sample.hostFrame == 8u);
    CHECK(sample.arrivedNs == 200);
  }
}

}  // namespace
}  // namespace eye
