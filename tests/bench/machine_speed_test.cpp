// The speed reference does work that takes time, and the same work again.
#include <catch2/catch.hpp>

#include "bench/machine_speed.h"
#include "render/renderer.h"

namespace eye {

TEST_CASE("The speed reference measures the same machine as the same machine") {
  const auto devices = Renderer::listDevices();
  if (!devices || devices->empty()) {
    WARN("no Vulkan device: not tested");
    return;
  }
  Result<SpeedReference> reference = SpeedReference::create("");
  REQUIRE(reference);
  // The machine may have other work during one of two measurements, hardly during all.
  constexpr int kTries = 3;
  const auto isAlike = [](double a, double b) { return a < 2 * b && b < 2 * a; };
  bool areAlike = false;
  for (int i = 0; i < kTries && !areAlike; ++i) {
    const Result<MachineSpeed> first = reference->measure(), second = reference->measure();
    REQUIRE((first && second));
    CHECK(first->loopMs > 1);
    CHECK(first->drawMs.value_or(1) > 0.2);  // of a GPU nothing is measured
    areAlike = isAlike(first->loopMs, second->loopMs) && isAlike(first->drawMs.value_or(1), second->drawMs.value_or(1));
  }
  CHECK(areAlike);
}

TEST_CASE("Both parts of the speed reference count, or the one that there is") {
  CHECK(MachineSpeed{.loopMs = 4}.referenceMs() == 4);
  CHECK(MachineSpeed{.loopMs = 4, .drawMs = 9}.referenceMs() == Approx(6));
  CHECK(meanOf({.loopMs = 2, .drawMs = 8}, {.loopMs = 4, .drawMs = 10}).drawMs == 9);
}

}  // namespace eye
