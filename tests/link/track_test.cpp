#include "link/track.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "link/angles.h"

namespace eye {
namespace {

Pose poseAt(double lat, double lon, double alt, double heading = 0, double pitch = 0, double roll = 0) {
  return {{lat, lon, alt}, heading, pitch, roll};
}

double distanceM(const Geodetic& a, const Geodetic& b) {
  return glm::length(ecefFromGeodetic(a) - ecefFromGeodetic(b));
}

double angleBetweenDeg(const Pose& a, const Pose& b) {
  const Mat3d turn = glm::transpose(ecefFromBody(a)) * ecefFromBody(b);
  return degFromRad(std::acos(std::min(1.0, (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2)));
}

TEST_CASE("a body's angles come back out of its matrix") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 3000; ++i) {
    const double pitch = i % 10 == 0 ? std::copysign(90, unit(random)) : 90 * unit(random);
    const Pose pose =
        poseAt(90 * unit(random), 180 * unit(random), 0, 180 + 180 * unit(random), pitch, 180 * unit(random));
    const Pose back = poseFromBody(pose.position, ecefFromBody(pose));
    const Mat3d a = ecefFromBody(pose), b = ecefFromBody(back);
    for (int c = 0; c < 3; ++c) REQUIRE(glm::length(a[c] - b[c]) < 1e-7);
  }
}

TEST_CASE("a track gives its samples exactly and holds at both ends") {
  const Track track({{100, poseAt(10, 20, 30, 40, 5, 6)},
                     {101, poseAt(10.001, 20.001, 33, 41, 6, 7)},
                     {103, poseAt(10.003, 20.002, 31, 43, 2, 0)}});
  CHECK(track.durationS() == 3);
  CHECK(track.at(-5) == poseAt(10, 20, 30, 40, 5, 6));
  CHECK(track.at(0) == poseAt(10, 20, 30, 40, 5, 6));
  CHECK(track.at(1) == poseAt(10.001, 20.001, 33, 41, 6, 7));
  CHECK(track.at(1000) == poseAt(10.003, 20.002, 31, 43, 2, 0));
  CHECK(track.at(std::nan("")) == poseAt(10, 20, 30, 40, 5, 6));
}

TEST_CASE("between samples a straight flight goes forward only, also when it stops or samples are uneven") {
  std::vector<TrackSample> samples;
  std::mt19937_64 random(4);
  double timeS = 0, lat = 49;
  for (int i = 0; i < 200; ++i) {
    samples.push_back({timeS, poseAt(lat, 20, 1000, 0)});
    timeS += 0.01 + static_cast<double>(random() % 1000) / 500.0;
    if (i % 20 < 12) lat += 1e-5 * static_cast<double>(random() % 100);  // stands still for eight samples out of twenty
  }
  const Track track(samples);
  double beforeLat = 0;
  for (int i = 0; i <= 20'000; ++i) {
    const double latDeg = track.at(track.durationS() * i / 20'000).position.latDeg;
    REQUIRE(latDeg >= beforeLat - 1e-12);
    beforeLat = latDeg;
  }
}

TEST_CASE("a circle sampled once a second is followed to centimetres, without kinks") {
  constexpr double kRadiusDeg = 0.01, kTurnS = 60;  // 1.1 km, 116 m/s
  const auto truth = [](double t) {
    const double angle = 2 * 3.14159265358979 * t / kTurnS;
    return poseAt(45 + kRadiusDeg * std::sin(angle), 179.999 + kRadiusDeg * std::cos(angle) / std::cos(radFromDeg(45)),
                  500);
  };
  std::vector<TrackSample> samples;
  for (int t = 0; t <= 60; ++t) {
    Pose pose = truth(t);
    if (pose.position.lonDeg > 180) pose.position.lonDeg -= 360;  // it crosses the date line
    samples.push_back({static_cast<double>(t), pose});
  }
  const Track track(samples);
  for (double t = 1; t < 59; t += 0.01) REQUIRE(distanceM(track.at(t).position, truth(t).position) < 0.15);
  // C1: the velocity on both sides of each sample is the same.
  for (int t = 2; t < 58; ++t) {
    const auto ecef = [&](double s) { return ecefFromGeodetic(track.at(s).position); };
    const Vec3d before = (ecef(t) - ecef(t - 1e-4)) / 1e-4, after = (ecef(t + 1e-4) - ecef(t)) / 1e-4;
    REQUIRE(glm::length(before - after) < 0.05);
  }
}

TEST_CASE("angles take the short way, at the poles too") {
  const Track north({{0, poseAt(0, 0, 0, 350)}, {1, poseAt(0, 0, 0, 10)}});
  const double heading = north.at(0.5).headingDeg;
  CHECK(std::min(heading, 360 - heading) == Approx(0).margin(1e-6));
  // Across the north pole, level and straight on: heading jumps from 0 to 180 while the aircraft does not turn.
  const Track pole({{0, poseAt(89.99, 30, 1000, 0)}, {10, poseAt(89.99, -150, 1000, 180)}});
  Pose before = pole.at(0);
  for (double t = 0.05; t <= 10; t += 0.05) {
    const Pose now = pole.at(t);
    REQUIRE(angleBetweenDeg(before, now) < 0.1);
    REQUIRE(std::abs(now.rollDeg) < 0.01);
    REQUIRE(now.position.altM == Approx(1000));
    before = now;
  }
}

TEST_CASE("a gap of hours does not cut through the Earth") {
  const Track track({{0, poseAt(50, 0, 10'000)}, {36'000, poseAt(40, -75, 10'000)}});
  for (double t = 0; t <= 36'000; t += 100) REQUIRE(track.at(t).position.altM == Approx(10'000).margin(1e-6));
}

TEST_CASE("attitude that a recording lacks comes from the path") {
  // A climbing right turn: 60 m/s, 3 degrees/s, 4 m/s up.
  std::vector<TrackFix> fixes;
  double headingRad = 0, lat = 47, lon = 11;
  for (int i = 0; i <= 600; ++i) {
    fixes.push_back({i * 0.2, {lat, lon, 1000 + i * 0.8}, {}, {}, {}});
    for (int k = 0; k < 20; ++k) {
      headingRad += radFromDeg(3) * 0.01;
      lat += 60 * 0.01 * std::cos(headingRad) / 111'175;
      lon += 60 * 0.01 * std::sin(headingRad) / (111'320 * std::cos(radFromDeg(47)));
    }
  }
  fixes[300].rollDeg = -7.0;  // what is there is kept
  const auto samples = withAttitude(fixes);
  REQUIRE(samples.size() == fixes.size());
  for (size_t i = 40; i + 40 < samples.size(); ++i) {
    const Pose& pose = samples[i].pose;
    REQUIRE(std::abs(wrappedDeg180(pose.headingDeg - 0.6 * static_cast<double>(i))) < 0.6);
    REQUIRE(pose.pitchDeg == Approx(degFromRad(std::atan(4.0 / 60))).margin(0.15));
    if (i != 300) REQUIRE(pose.rollDeg == Approx(degFromRad(std::atan(60 * radFromDeg(3) / 9.80665))).margin(0.4));
  }
  CHECK(samples[300].pose.rollDeg == -7.0);
}

TEST_CASE("an aircraft that stands looks the way in which it leaves") {
  std::vector<TrackFix> fixes;
  for (int i = 0; i < 60; ++i) {
    const double moved = std::max(0, i - 30) * 3e-4;
    const double noise = i % 2 == 0 ? 1e-6 : -1e-6;  // 10 cm
    fixes.push_back({static_cast<double>(i), {47 + noise, 11 + moved, 500}, {}, {}, {}});
  }
  const auto samples = withAttitude(fixes);
  for (size_t i = 0; i < samples.size(); ++i) {
    REQUIRE(samples[i].pose.headingDeg == Approx(90).margin(1));
    REQUIRE(std::abs(samples[i].pose.rollDeg) < 1);
  }
}

TEST_CASE("a track of one fix is a pose") {
  const auto samples = withAttitude({{5, {1, 2, 3}, {}, {}, {}}});
  CHECK(Track(samples).at(17) == poseAt(1, 2, 3));
}

}  // namespace
}  // namespace eye
