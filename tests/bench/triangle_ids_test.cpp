// The identity buffer counts what shows and nothing else.
#include <catch2/catch.hpp>

#include "bench/triangle_ids.h"

namespace eye {

TEST_CASE("A triangle counts when a pixel shows it") {
  const View view = makeView({{49, 20, 500}, 0, 0, 0}, symmetricFrustum(90, 200, 150, 1), 200, 150);
  const Mat3d axes = ecefFromEnu(49, 20);
  const auto at = [&](double east, double north, double up) { return axes * Vec3d(east, north, up); };
  TriangleIds ids(view);
  CHECK(ids.visible() == 0);
  // Counterclockwise from the south, where the eye is.
  const auto wall = [&](double north, double half, uint32_t id) {
    ids.draw(at(-half, north, -half), at(half, north, -half), at(half, north, half), id);
    ids.draw(at(-half, north, -half), at(half, north, half), at(-half, north, half), id + 1);
  };
  wall(300, 50, 10);
  CHECK(ids.visible() == 2);
  wall(100, 60, 20);  // before it: hides it whole
  CHECK(ids.visible() == 2);
  wall(200, 60, 30);  // behind the new one
  CHECK(ids.visible() == 2);
  wall(400, 390, 40);  // behind as well, but looks out at the sides
  CHECK(ids.visible() == 4);
  ids.draw(at(-10, 50, -10), at(10, 50, 10), at(10, 50, -10), 50);      // turns its back
  ids.draw(at(-10, -50, -10), at(-10, -50, 10), at(10, -50, -10), 51);  // behind the eye
  CHECK(ids.visible() == 4);
  // The ground under the eye, which reaches from behind it into the picture: clipped, not left out.
  ids.draw(at(-500, -100, -5), at(500, -100, -5), at(0, 60, -5), 60);
  CHECK(ids.visible() == 5);
}

}  // namespace eye
