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
  const Result<MachineSpeed> first = reference->measure(), second = reference->measure();
  REQUIRE((first && second));
  CHECK(first->loopMs > 1);
  CHECK(first->loopMs < 2 * second->loopMs);
  CHECK(second->loopMs < 2 * first->loopMs);
  if (!first->drawMs) return;  // a GPU
  CHECK(*first->drawMs > 0.2);
  CHECK(*first->drawMs < 2 * *second->drawMs);
  CHECK(*second->drawMs < 2 * *first->drawMs);
  CHECK(meanOf(*first, *second).referenceMs() == Approx(first->referenceMs()).epsilon(1));
}

TEST_CASE("Both parts of the speed reference count, or the one that there is") {
  CHECK(MachineSpeed{.loopMs = 4}.referenceMs() == 4);
  CHECK(MachineSpeed{.loopMs = 4, .drawMs = 9}.referenceMs() == Approx(6));
  CHECK(meanOf({.loopMs = 2, .drawMs = 8}, {.loopMs = 4, .drawMs = 10}).drawMs == 9);
}

}  // namespace eye
