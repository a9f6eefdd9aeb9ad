#include "control/shortest_pass.h"

#include <catch2/catch.hpp>

using namespace eye;

TEST_CASE("what culling takes is the shortest of a size's newest sixteen times") {
  ShortestPass pass;
  constexpr DepthMapChoice kSmall = kDepthMaps[0], kLarge = kDepthMaps[3];
  CHECK(pass.observe(kSmall, 2) == 2);
  CHECK(pass.observe(kSmall, 5) == 2);
  CHECK(pass.observe(kSmall, 1) == 1);
  for (int i = 0; i < 15; ++i) CHECK(pass.observe(kSmall, 3) == 1);
  CHECK(pass.observe(kSmall, 3) == 3);  // the 1 is the seventeenth now
  CHECK(pass.observe(kLarge, 9) == 9);  // another size has times of its own
  CHECK(pass.observe(kLarge, 11) == 9);
  CHECK(pass.observe(kSmall, 7) == 3);
}
