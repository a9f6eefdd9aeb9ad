// What the flight suite flies: its own tracks over the ground, and recordings over other ground.
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "bake/raster_files.h"
#include "bench/flight_tasks.h"
#include "bench/small_database.h"

namespace eye {
namespace {

// A climbing turn of 20 s, a sample a second.
Track turn(const Geodetic& from) {
  std::vector<TrackSample> samples;
  for (int i = 0; i <= 20; ++i) {
    const double angle = 0.1 * i;
    Geodetic at = offsetBy(from, 800 * (1 - std::cos(angle)), 800 * std::sin(angle));
    at.altM = from.altM + 10 * i;
    samples.push_back({static_cast<double>(i), {at, degFromRad(angle), 5, 30}});
  }
  return Track(std::move(samples));
}

Vec3d localM(const Track& track, size_t i) {
  const Geodetic from = track.samples().front().pose.position;
  const Vec3d way = ecefFromGeodetic(track.samples()[i].pose.position) - ecefFromGeodetic(from);
  return glm::transpose(ecefFromEnu(from.latDeg, from.lonDeg)) * way;
}

double distanceM(const Geodetic& a, const Geodetic& b) {
  return glm::length(ecefFromGeodetic(a) - ecefFromGeodetic(b));
}

}  // namespace

TEST_CASE("A track that is moved keeps its shape, its altitudes and its attitude") {
  const Track flown = turn({-33.5, 151.2, 500});
  const Track moved = movedTo(flown, {49.25, 20.5});
  REQUIRE(moved.samples().size() == flown.samples().size());
  const Geodetic middle = moved.samples()[10].pose.position;
  CHECK(middle.latDeg == Approx(49.25).margin(1e-9));
  CHECK(middle.lonDeg == Approx(20.5).margin(1e-9));
  for (size_t i = 0; i < moved.samples().size(); ++i) {
    CHECK(glm::length(localM(moved, i) - localM(flown, i)) < 0.5);  // over some 1,600 m
    CHECK(moved.samples()[i].pose.position.altM == flown.samples()[i].pose.position.altM);
    CHECK(moved.samples()[i].pose.headingDeg == flown.samples()[i].pose.headingDeg);
    CHECK(moved.samples()[i].timeS == flown.samples()[i].timeS);
  }
}

TEST_CASE("The middle of a track, and whether the terrain covers it") {
  const Track flown = turn({49, 20, 500});
  const Track middle = middleOf(flown, 5);
  CHECK(middle.durationS() == Approx(5));
  CHECK(distanceM(middle.at(0).position, flown.at(7.5).position) < 1e-3);
  CHECK(distanceM(middle.at(2.5).position, flown.at(10).position) < 1e-3);
  CHECK(middleOf(flown, 20).samples().size() == flown.samples().size());
  CHECK(middleOf(flown, 100).durationS() == 20);

  CHECK(isWithin(flown, {48.9, 49.1, 19.9, 20.1}));
  CHECK_FALSE(isWithin(flown, {48.9, 49.1, 20.005, 20.1}));
  CHECK_FALSE(isWithin(flown, {48.9, 49.005, 19.9, 20.1}));
}

TEST_CASE("The built-in flights keep speed and height, and turn as they should") {
  const auto reader = DatabaseReader::open(smallDatabase());
  REQUIRE(reader);
  const auto places = findPlaces(*reader);
  REQUIRE(places);
  GroundHeights ground(*reader);
  const auto tasks = builtInTasks((*places)[1], ground, 30);
  REQUIRE(tasks);
  REQUIRE(tasks->size() == 3);
  CHECK((*tasks)[0].ssePx == 0.5);
  for (const FlightTask& task : *tasks) {
    INFO(task.name);
    CHECK(task.track.durationS() == Approx(30));
    const double speedMS = task.published == 3 ? 120 : 300;
    double leastM = 1e9, mostM = -1e9, greatestBankDeg = 0;
    for (double timeS = 0; timeS + 1 <= 30; timeS += 0.5) {
      const Geodetic at = task.track.at(timeS).position, next = task.track.at(timeS + 0.5).position;
      const Geodetic level{next.latDeg, next.lonDeg, at.altM};
      CHECK(distanceM(at, level) / 0.5 == Approx(speedMS).epsilon(0.03));
      const auto groundM = ground.heightM({at.latDeg, at.lonDeg});
      REQUIRE(groundM);
      leastM = std::min(leastM, at.altM - *groundM);
      mostM = std::max(mostM, at.altM - *groundM);
      greatestBankDeg = std::max(greatestBankDeg, std::abs(task.track.at(timeS).rollDeg));
    }
    CHECK(leastM > 150);  // ridges of 1,000 m, 1.7 km apart
    CHECK(mostM < 1700);
    CHECK(greatestBankDeg == Approx(59).margin(6));
  }
  // Half way it is over the spot, but for what a turn takes it aside.
  const Spot& spot = (*places)[1].spots[1];
  const Geodetic half = (*tasks)[1].track.at(15).position;
  CHECK(distanceM({half.latDeg, half.lonDeg, 0}, {spot.at.latDeg, spot.at.lonDeg, 0}) < 2000);
}

TEST_CASE("A recording of elsewhere is moved over the terrain and clear of the ground") {
  const TestFolder folder;
  const auto write = [&](const char* name, double latDeg, double altM) {
    std::ofstream file(folder.file(name));
    file << "time,lat,lon,alt\n";
    for (int i = 0; i <= 60; ++i) file << fmt::format("{},{:.6f},20.3,{}\n", i, latDeg + i * 5e-4, altM);
    return folder.file(name);
  };
  const auto reader = DatabaseReader::open(smallDatabase());
  REQUIRE(reader);
  GroundHeights ground(*reader);
  const TileBounds bounds = reader->info().dataBounds;

  const auto here = recordedTask(write("here.csv", 49.2, 5000), bounds, ground, 10);
  REQUIRE(here);
  CHECK_FALSE(here->isMoved);
  CHECK(here->raisedM == 0);
  CHECK(here->name == "here.csv");
  CHECK(here->track.at(0).position.latDeg == Approx(49.2125).epsilon(1e-7));

  const auto low = recordedTask(write("low.csv", 10, -50), bounds, ground, 10);
  REQUIRE(low);
  CHECK(low->isMoved);
  CHECK(low->raisedM > 300);
  CHECK(isWithin(low->track, bounds));
  const Geodetic at = low->track.at(5).position;
  CHECK(at.altM - *ground.heightM({at.latDeg, at.lonDeg}) >= 50);

  const auto none = recordedTask("/nowhere/none.csv", bounds, ground, 10);
  REQUIRE_FALSE(none);
  CHECK(none.error().message.find("/nowhere/none.csv") != std::string::npos);
}

}  // namespace eye
