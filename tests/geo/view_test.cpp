#include "geo/view.h"

#include <cmath>
#include <random>

#include <catch2/catch.hpp>

namespace eye {
namespace {

constexpr Pose kPose{{49.2, 20.1, 3000}, 200, -15, 5};

struct Pixel {
  double column, row;  // continuous: 0 at the left and top edge, pixel centres at halves
  double depthM;
};

// The textbook projection, against which rays and planes are checked.
Pixel project(const View& view, const Vec3d& fromEyeEcefM) {
  const Vec3d p = view.eyeFromEcef * fromEyeEcefM;
  const Frustum& f = view.frustum;
  return Pixel{(p.x / p.z - f.tanLeft) / (f.tanRight - f.tanLeft) * view.widthPx,
               (f.tanTop + p.y / p.z) / (f.tanTop - f.tanBottom) * view.heightPx, p.z};
}

TEST_CASE("a symmetric frustum has the asked horizontal angle and square pixels") {
  const Frustum f = symmetricFrustum(90, 800, 600, 2);
  CHECK(f.tanRight == Approx(1.0));
  CHECK(f.tanLeft == -f.tanRight);
  CHECK(f.tanTop == Approx(0.75));
  CHECK(f.tanBottom == -f.tanTop);
  CHECK(f.nearM == 2);
  const Frustum narrow = symmetricFrustum(60, 1920, 1080, 1);
  CHECK((narrow.tanRight - narrow.tanLeft) / 1920 == Approx((narrow.tanTop - narrow.tanBottom) / 1080));
  CHECK(degFromRad(2 * std::atan(narrow.tanRight)) == Approx(60));
}

TEST_CASE("an off-axis frustum takes each half-angle with its sign") {
  const Frustum f = offAxisFrustum(-45, -10, -20, 30, 1);
  CHECK(f.tanLeft == Approx(-1.0));
  CHECK(f.tanRight == Approx(std::tan(radFromDeg(-10))));
  CHECK(f.tanBottom == Approx(std::tan(radFromDeg(-20))));
  CHECK(f.tanTop == Approx(std::tan(radFromDeg(30))));
}

TEST_CASE("pixels a radian is the scale at the axis") {
  const View view = makeView(kPose, symmetricFrustum(90, 800, 600, 1), 800, 600);
  CHECK(pixelsPerRadian(view) == Approx(400));
  // One milliradian off the axis moves the projection by a thousandth of it.
  const Vec3d ahead = glm::transpose(view.eyeFromEcef) * Vec3d(0, 0, 1000),
              beside = glm::transpose(view.eyeFromEcef) * Vec3d(1, 0, 1000);
  CHECK(project(view, beside).column - project(view, ahead).column == Approx(0.4));
}

TEST_CASE("rays go through the centres of pixels, the top row first") {
  for (const Frustum& f : {symmetricFrustum(75, 640, 480, 1), offAxisFrustum(-60, 5, -10, 40, 1)}) {
    const View view = makeView(kPose, f, 640, 480);
    for (const int column : {0, 1, 319, 320, 639})
      for (const int row : {0, 100, 240, 479}) {
        const Vec3d ray = rayThroughPixel(f, 640, 480, column, row);
        CHECK(ray.z == 1.0);
        const Pixel pixel = project(view, glm::transpose(view.eyeFromEcef) * (ray * 5000.0));
        CHECK(pixel.column == Approx(column + 0.5).margin(1e-9));
        CHECK(pixel.row == Approx(row + 0.5).margin(1e-9));
      }
  }
  const Frustum f = symmetricFrustum(75, 640, 480, 1);
  CHECK(rayThroughPixel(f, 640, 480, 0, 0).y < 0);  // up, in a frame whose y points down
  CHECK(rayThroughPixel(f, 640, 480, 0, 0).x < 0);
}

TEST_CASE("what is ahead of a level eye over the ground is above the horizon's row") {
  const View view = makeView(Pose{{49.2, 20.1, 3000}, 90, 0, 0}, symmetricFrustum(60, 800, 600, 1), 800, 600);
  const Mat3d enu = ecefFromEnu(49.2, 20.1);
  const Pixel cloud = project(view, enu * Vec3d(1000, 0, 100)), field = project(view, enu * Vec3d(1000, 0, -100));
  CHECK(cloud.row < 300);
  CHECK(field.row > 300);
  CHECK(project(view, enu * Vec3d(1000, -100, 0)).column > 400);  // south is at the right of an eye that looks east
}

TEST_CASE("planes agree with projection point by point") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const Frustum& f : {symmetricFrustum(60, 800, 600, 10), symmetricFrustum(170, 800, 600, 10),
                           offAxisFrustum(-60, 5, -10, 40, 10), offAxisFrustum(10, 50, 5, 25, 10)}) {
    const View view = makeView(kPose, f, 800, 600);
    const FrustumPlanes planes = frustumPlanes(view);
    for (const Vec3d& normal : planes.normalsEcef) CHECK(glm::length(normal) == Approx(1.0));
    int insideCount = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Vec3d fromEyeM = Vec3d(unit(random), unit(random), unit(random)) * 40.0;
      const Pixel pixel = project(view, fromEyeM);
      const bool projectsInside =
          pixel.depthM >= f.nearM && pixel.column >= 0 && pixel.column <= 800 && pixel.row >= 0 && pixel.row <= 600;
      bool isInside = true;
      for (size_t plane = 0; plane < 5; ++plane)
        isInside = isInside && glm::dot(planes.normalsEcef[plane], fromEyeM) >= planes.offsetsM[plane];
      REQUIRE(isInside == projectsInside);
      insideCount += isInside ? 1 : 0;
    }
    CHECK(insideCount > 50);
  }
}

TEST_CASE("each plane keeps out its own side") {
  const View view = makeView(kPose, symmetricFrustum(60, 800, 600, 10), 800, 600);
  const FrustumPlanes planes = frustumPlanes(view);
  const Mat3d ecefFromEyeAxes = glm::transpose(view.eyeFromEcef);
  // left, right, bottom, top, near
  const std::array<Vec3d, 5> outside{Vec3d(-900, 0, 1000), Vec3d(900, 0, 1000), Vec3d(0, 700, 1000),
                                     Vec3d(0, -700, 1000), Vec3d(0, 0, 9)};
  for (size_t point = 0; point < 5; ++point)
    for (size_t plane = 0; plane < 5; ++plane) {
      const double side = glm::dot(planes.normalsEcef[plane], ecefFromEyeAxes * outside[point]);
      CHECK((side < planes.offsetsM[plane]) == (plane == point));
    }
}

}  // namespace
}  // namespace eye
