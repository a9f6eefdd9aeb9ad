#include <catch2/catch.hpp>

#include "bench/panorama_figures.h"
#include "bench/small_database.h"
#include "bench/summit_places.h"

namespace eye {

TEST_CASE("Distance figures: by hand") {
  const std::array<DistancePair, 4> pairs{{{1040, 1000}, {1800, 2000}, {3000, 3000}, {4920, 4000}}};
  const DistanceFigures f = distanceFigures(pairs);
  CHECK(f.peaks == 4);
  CHECK(f.within[0] == 0.5);  // 0 and 4 %
  CHECK(f.within[1] == 0.5);  // 10 % is not below 10 %
  CHECK(f.within[2] == 0.75);
  CHECK(f.within[4] == 1);  // 23 %
  CHECK(f.mape == Approx((0.04 + 0.1 + 0.23) / 4));
  CHECK(f.rmseM == Approx(std::sqrt((1600.0 + 40000 + 846400) / 4)));
  CHECK(f.relativeSquaredError == Approx(888000.0 / 5e6));  // of what the mean, 2,500 m, would do
  CHECK(f.r2 == Approx(1 - 888000.0 / 5e6));
}

TEST_CASE("Regression: a line is taken out, by folds that had no part in it") {
  std::vector<DistancePair> pairs;
  for (int i = 0; i < 42; ++i) pairs.push_back({1000.0 * i + 500, 0.9 * (1000.0 * i + 500) - 100});
  for (const DistancePair& pair : withRegression(pairs)) CHECK(pair.toldM == Approx(pair.trueM).margin(1e-6));
  // One that lies: its own line would follow it, the others' does not.
  pairs[3].trueM += 5000;
  const auto corrected = withRegression(pairs);
  CHECK(corrected[3].toldM == Approx(0.9 * pairs[3].toldM - 100).margin(1e-6));
  CHECK(withRegression(std::span(pairs).first(13)).front().toldM == pairs.front().toldM);  // too few
}

TEST_CASE("Summits of the terrain itself: the highest first, apart, and in sight of each other or not") {
  const auto reader = DatabaseReader::open(smallDatabase());
  REQUIRE(reader);
  const auto summits = terrainSummits(*reader, 20);
  REQUIRE(summits);
  REQUIRE(summits->size() == 20);
  CHECK(summits->front().heightM.value() > 1000);
  for (size_t i = 1; i < summits->size(); ++i)
    CHECK((*summits)[i].heightM.value() <= (*summits)[i - 1].heightM.value());

  auto ground = GroundQuery::open(smallDatabase());
  REQUIRE(ground);
  const auto viewpoints = summitViewpoints(*summits, 1, *ground);
  REQUIRE(viewpoints);
  REQUIRE(viewpoints->size() == 2);
  const Geodetic eye = (*viewpoints)[0].eye;
  const auto under = ground->under(eye.latDeg, eye.lonDeg);
  REQUIRE(under);
  CHECK(eye.altM == Approx(under->position.altM + 2));
  // The ground at one's feet is in sight; what lies behind the mountain is not, nor is a point in the air.
  const auto beside = ground->under(eye.latDeg + 0.0005, eye.lonDeg),
             behind = ground->under(eye.latDeg + 0.1, eye.lonDeg);
  REQUIRE(beside);
  REQUIRE(behind);
  CHECK(isInSight(*ground, eye, beside->position, 0.13, 0.01).value());
  Geodetic deep = behind->position;
  deep.altM -= 2000;
  CHECK_FALSE(isInSight(*ground, eye, deep, 0.13, 0).value());
  CHECK_FALSE(isInSight(*ground, eye, {eye.latDeg + 0.05, eye.lonDeg, 5000}, 0.13, 0).value());
}

}  // namespace eye
