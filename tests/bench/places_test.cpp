// Places, ground heights and the flight over them.
#include <catch2/catch.hpp>

#include "bench/places.h"
#include "bench/selector_flight.h"
#include "bench/small_database.h"

namespace eye {

TEST_CASE("The mountains and the plain are found where they are") {
  const auto reader = DatabaseReader::open(smallDatabase());
  REQUIRE(reader);
  const auto places = findPlaces(*reader);
  REQUIRE(places);
  const auto& [plain, mountains] = *places;
  CHECK(plain.name == "plain");
  CHECK(mountains.name == "mountains");
  CHECK(mountains.reliefM > 500);
  CHECK(plain.reliefM < mountains.reliefM / 2);
  for (const Spot& spot : mountains.spots) {
    CHECK(spot.at.latDeg > 49.29);
    CHECK(spot.at.lonDeg > 20.29);
    CHECK(spot.groundM == Approx(swellsAndRidgesM(spot.at.latDeg, spot.at.lonDeg)).margin(40));
    CHECK((spot.headingDeg >= 0 && spot.headingDeg < 360));
  }
  CHECK(mountains.spots[0].groundM < mountains.spots[1].groundM);  // the valley, then the slope
  for (const Spot& spot : plain.spots) {                           // inside of the data, with terrain all round
    CHECK((spot.at.latDeg > 49.05 && spot.at.latDeg < 49.55));
    CHECK((spot.at.lonDeg > 20.05 && spot.at.lonDeg < 20.55));
  }
}

TEST_CASE("Bearings are clockwise from north") {
  CHECK(bearingDeg({49, 20}, {49.1, 20}) == Approx(0));
  CHECK(bearingDeg({49, 20}, {49, 20.1}) == Approx(90));
  CHECK(bearingDeg({49, 20}, {48.9, 20}) == Approx(180));
  CHECK(bearingDeg({49, 20}, {49, 19.9}) == Approx(270));
}

TEST_CASE("Ground heights are the meshes' own") {
  const auto reader = DatabaseReader::open(smallDatabase());
  REQUIRE(reader);
  GroundHeights ground(*reader);
  double worstM = 0;
  for (double lat = 49.02; lat < 49.29; lat += 0.013) {
    for (double lon = 20.02; lon < 20.58; lon += 0.017) {
      const auto heightM = ground.heightM({lat, lon});
      REQUIRE(heightM);
      worstM = std::max(worstM, std::abs(*heightM - swellsAndRidgesM(lat, lon)));
    }
  }
  CHECK(worstM < 4.5);  // the bake's tolerance and the posts' interpolation
}

TEST_CASE("The flight is low and high over both places and never in the ground") {
  CHECK(flightHeightM(-1) == 30);
  CHECK(flightHeightM(75) == Approx(std::sqrt(30.0 * 150)));  // half way between keys: the geometric mean
  CHECK(flightHeightM(230) == 10000);
  const auto reader = DatabaseReader::open(smallDatabase());
  REQUIRE(reader);
  const auto places = findPlaces(*reader);
  REQUIRE(places);
  GroundHeights ground(*reader);
  const auto flight = makeSelectorFlight(*places, ground);
  REQUIRE(flight);
  for (const double beganS : {0.0, kFlightHalfS}) {
    double lowestM = 1e9, highestM = -1e9, leastPitch = 90, mostPitch = -90, mostRoll = 0;
    for (double t = beganS; t < beganS + kFlightHalfS; t += 0.5) {
      const Pose pose = flight->at(t);
      const auto groundM = ground.heightM({pose.position.latDeg, pose.position.lonDeg});
      REQUIRE(groundM);
      lowestM = std::min(lowestM, pose.position.altM - *groundM);
      highestM = std::max(highestM, pose.position.altM - *groundM);
      leastPitch = std::min(leastPitch, pose.pitchDeg);
      mostPitch = std::max(mostPitch, pose.pitchDeg);
      mostRoll = std::max(mostRoll, std::abs(pose.rollDeg));
    }
    CHECK(lowestM > 10);
    CHECK(lowestM < 60);
    CHECK(highestM > 9000);
    CHECK(leastPitch < -15);
    CHECK(mostPitch > 8);
    CHECK(mostRoll > 10);
  }
}

}  // namespace eye
