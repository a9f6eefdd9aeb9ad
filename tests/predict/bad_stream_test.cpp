// Streams as hosts really send them, and worse.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "bench/prediction_study.h"
#include "predict/viewpoint_predictor.h"

namespace eye {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const std::vector<TrackSample>& flight() {
  static const std::vector<TrackSample> samples = simulatedTrack(Manoeuvre::standardRateTurns, 60);
  return samples;
}

void fly(ViewpointPredictor& predictor, size_t from, size_t to) {
  for (size_t i = from; i < to; ++i) predictor.observe(flight()[i].timeS, flight()[i].pose);
}

// Of the prediction half a second after sample `i`.
double errorM(const ViewpointPredictor& predictor, size_t i) {
  return glm::length(predictor.at(flight()[i].timeS + 0.5).ecefM - ecefFromGeodetic(flight()[i + 30].pose.position));
}

bool isFinite(const Prediction& p) {
  double sum = p.radius98M + p.pose.headingDeg + p.pose.pitchDeg + p.pose.rollDeg + p.pose.position.latDeg +
               p.pose.position.lonDeg + p.pose.position.altM + p.turnRateDegS + p.horizonS + p.timeS;
  for (int i = 0; i < 3; ++i) {
    sum += p.ecefM[i] + p.velocityEcefMS[i] + p.rateBodyRadS[i];
    for (int j = 0; j < 3; ++j) sum += p.covarianceEcefM2[i][j];
  }
  return std::isfinite(sum);
}

TEST_CASE("Before the first observation nothing is predicted") {
  ViewpointPredictor predictor;
  CHECK_FALSE(predictor.at(1).valid);
  predictor.observe(kNaN, flight()[0].pose);
  CHECK_FALSE(predictor.at(1).valid);
  predictor.observe(5, flight()[0].pose);
  CHECK(predictor.at(5).valid);
  CHECK(glm::length(predictor.at(5.5).ecefM - ecefFromGeodetic(flight()[0].pose.position)) < 1e-6);
}

TEST_CASE("What is no pose is refused and changes nothing") {
  ViewpointPredictor predictor, untouched;
  fly(predictor, 0, 300);
  fly(untouched, 0, 300);
  const double t = flight()[300].timeS;
  for (double Geodetic::*part : {&Geodetic::latDeg, &Geodetic::lonDeg, &Geodetic::altM}) {
    for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300}) {
      Pose pose = flight()[300].pose;
      pose.position.*part = bad;
      predictor.observe(t, pose);
    }
  }
  for (double Pose::*part : {&Pose::headingDeg, &Pose::pitchDeg, &Pose::rollDeg}) {
    for (const double bad : {kNaN, kInfinity}) {
      Pose pose = flight()[300].pose;
      pose.*part = bad;
      predictor.observe(t, pose);
    }
  }
  predictor.observe(kNaN, flight()[300].pose);
  predictor.observe(kInfinity, flight()[300].pose);
  CHECK(predictor.state().counts.refused == 20);
  CHECK(predictor.at(t + 1).ecefM == untouched.at(t + 1).ecefM);
  CHECK(isFinite(predictor.at(kNaN)));
  CHECK(predictor.at(kNaN).horizonS == 0);
}

TEST_CASE("Repeated and late stamps are skipped and counted, whatever they carry") {
  ViewpointPredictor predictor, untouched;
  fly(predictor, 0, 300);
  fly(untouched, 0, 300);
  predictor.observe(flight()[299].timeS, flight()[100].pose);
  predictor.observe(flight()[299].timeS, flight()[299].pose);
  predictor.observe(flight()[260].timeS, flight()[260].pose);
  predictor.observe(std::nextafter(flight()[299].timeS, 0), flight()[299].pose);
  CHECK(predictor.state().counts.repeated == 2);
  CHECK(predictor.state().counts.late == 2);
  CHECK(predictor.at(6).ecefM == untouched.at(6).ecefM);
  // The smallest step there is does no harm either.
  Pose pose = flight()[299].pose;
  pose.rollDeg += 0.1;
  predictor.observe(std::nextafter(flight()[299].timeS, 10), pose);
  fly(predictor, 300, 400);
  CHECK(errorM(predictor, 399) < 5);
  CHECK(predictor.state().counts.teleports == 0);
}

TEST_CASE("A host that sends every state twice is flying on") {
  ViewpointPredictor predictor;
  for (size_t i = 0; i < 600; ++i) {
    predictor.observe(flight()[i].timeS, flight()[i].pose);
    predictor.observe(flight()[i].timeS + 0.008, flight()[i].pose);
  }
  CHECK(predictor.state().counts.duplicates == 600);
  CHECK(predictor.state().counts.outliers == 0);
  CHECK(errorM(predictor, 599) < 5);
}

TEST_CASE("A host that is paused stands still, and flies on when it does") {
  ViewpointPredictor predictor;
  fly(predictor, 0, 600);
  for (int k = 1; k <= 60; ++k) {
    predictor.observe(flight()[599].timeS + k / 60.0, flight()[599].pose);
    // Until it is believed the flight goes on: a quarter of a second and three packets.
    const double offM =
        glm::length(predictor.at(flight()[599].timeS + k / 60.0).ecefM - ecefFromGeodetic(flight()[599].pose.position));
    REQUIRE(offM < (k < 20 ? 100 : 5));
  }
  const Prediction paused = predictor.at(flight()[599].timeS + 1.5);
  CHECK(glm::length(paused.ecefM - ecefFromGeodetic(flight()[599].pose.position)) < 5);
  CHECK(predictor.state().counts.teleports == 1);
  for (size_t i = 600; i < 720; ++i) predictor.observe(flight()[i].timeS + 1, flight()[i].pose);
  CHECK(glm::length(predictor.at(flight()[719].timeS + 1.5).ecefM - ecefFromGeodetic(flight()[749].pose.position)) <
        20);
}

TEST_CASE("A parked aircraft stays where it is, and a turning head is seen") {
  ViewpointPredictor predictor;
  const Geodetic place{47, 11, 600};
  for (int k = 0; k < 600; ++k) predictor.observe(k / 60.0, {.position = place});
  for (int k = 600; k < 1200; ++k) predictor.observe(k / 60.0, {.position = place, .headingDeg = (k - 600) * 0.5});
  CHECK(glm::length(predictor.at(25).ecefM - ecefFromGeodetic(place)) < 0.01);
  CHECK(predictor.at(1199 / 60.0).turnRateDegS == Approx(30).margin(0.1));
  CHECK(predictor.state().counts.outliers == 0);
}

TEST_CASE("Gaps are bridged; after ten seconds it begins anew") {
  ViewpointPredictor predictor;
  fly(predictor, 0, 600);
  CHECK(predictor.at(60).horizonS == 30);
  fly(predictor, 720, 780);
  CHECK(predictor.state().counts.gaps == 1);
  CHECK(predictor.state().counts.teleports == 0);
  CHECK(errorM(predictor, 779) < 5);
  fly(predictor, 2000, 2060);
  CHECK(predictor.state().counts.gaps == 2);
  CHECK(predictor.state().counts.teleports == 0);
  CHECK(errorM(predictor, 2059) < 20);
}

TEST_CASE("Time that goes back is a host that began again") {
  ViewpointPredictor predictor;
  fly(predictor, 1200, 1800);
  fly(predictor, 0, 120);
  CHECK(predictor.state().counts.resets == 1);
  CHECK(predictor.state().counts.late == 0);
  CHECK(errorM(predictor, 119) < 20);
}

TEST_CASE("One packet gone astray is not believed") {
  ViewpointPredictor predictor;
  fly(predictor, 0, 600);
  Pose astray = flight()[600].pose;
  astray.position.altM += 120;
  predictor.observe(flight()[600].timeS, astray);
  CHECK(predictor.state().counts.outliers == 1);
  CHECK(predictor.state().counts.teleports == 0);
  CHECK(errorM(predictor, 600) < 5);
}

TEST_CASE("Teleports: a long way at once, a short way after three observations") {
  Geodetic offset;
  uint64_t observations = 0;
  SECTION("a degree") {
    offset = {1, 0, 0};
    observations = 1;
  }
  SECTION("to the antipodes") {
    offset = {-94, 180, 0};
    observations = 1;
  }
  SECTION("200 m up") {
    offset = {0, 0, 200};
    observations = 3;
  }
  ViewpointPredictor predictor;
  fly(predictor, 0, 600);
  for (size_t i = 600; i < 660; ++i) {
    Pose pose = flight()[i].pose;
    pose.position = {pose.position.latDeg + offset.latDeg, pose.position.lonDeg + offset.lonDeg,
                     pose.position.altM + offset.altM};
    predictor.observe(flight()[i].timeS, pose);
    CHECK(predictor.state().counts.teleports == (i - 599 >= observations ? 1 : 0));
    if (i - 599 >= observations)
      CHECK(glm::length(predictor.at(flight()[i].timeS).ecefM - ecefFromGeodetic(pose.position)) < 10);
  }
  CHECK(predictor.state().counts.outliers == observations);
}

TEST_CASE("A flight that is shifted a little keeps its velocity") {
  ViewpointPredictor predictor;
  fly(predictor, 0, 600);
  const auto shifted = [](size_t i) {
    Pose pose = flight()[i].pose;
    pose.position.altM += 200;
    return pose;
  };
  for (size_t i = 600; i < 603; ++i) predictor.observe(flight()[i].timeS, shifted(i));
  REQUIRE(predictor.state().counts.teleports == 1);
  const Prediction p = predictor.at(flight()[602].timeS + 0.5);
  CHECK(glm::length(p.ecefM - ecefFromGeodetic(shifted(632).position)) < 10);
}

TEST_CASE("A hard turn after a quiet hour, seen once a second, is a turn and no teleport") {
  const Vec3d originM = ecefFromGeodetic({47, 11, 3000});
  const Mat3d frame = ecefFromEnu(47, 11);
  ViewpointPredictor predictor;
  const double speedMS = 60, turnRadS = 0.4;  // 24 m/s² from one moment to the next
  for (int k = -600; k < 60; ++k) {
    const double angle = turnRadS * std::max(k - 0.5, 0.0);
    const Vec3d enuM =
        k <= 0 ? Vec3d(speedMS * (k - 0.5), 0, 0) : speedMS / turnRadS * Vec3d(std::sin(angle), 1 - std::cos(angle), 0);
    predictor.observe(k, {.position = geodeticFromEcef(originM + frame * enuM)});
  }
  CHECK(predictor.state().counts.teleports == 0);
  CHECK(predictor.state().counts.outliers == 0);
}

TEST_CASE("Teleports every second, for all models") {
  for (const int states : {6, 9, 12}) {
    INFO(states);
    PredictorOptions options;
    options.states = states;
    ViewpointPredictor predictor(options);
    double worstM = 0;
    for (size_t i = 0; i + 30 < flight().size(); ++i) {
      const double westDeg = static_cast<double>(i / 60 % 7) * 25;
      const auto moved = [&](Pose pose) {
        pose.position.lonDeg -= westDeg;
        return pose;
      };
      predictor.observe(flight()[i].timeS, moved(flight()[i].pose));
      const Geodetic truth = moved(flight()[i + 6].pose).position;  // a tenth of a second later
      const double offM = glm::length(predictor.at(flight()[i].timeS + 0.1).ecefM - ecefFromGeodetic(truth));
      if (i % 60 >= 15) worstM = std::max(worstM, offM);  // a quarter of a second after each
    }
    CHECK(predictor.state().counts.teleports == 59);
    CHECK(worstM < 5);
  }
}

TEST_CASE("Beginning anew tells nothing of the noise") {
  const std::vector<TrackSample> noisy = withNoise(flight(), 2, 4);
  ViewpointPredictor predictor;
  for (size_t i = 0; i < noisy.size(); ++i) {
    Pose pose = noisy[i].pose;
    pose.position.lonDeg -= static_cast<double>(i / 60 % 7) * 25;
    predictor.observe(noisy[i].timeS, pose);
  }
  CHECK(predictor.state().counts.teleports == 60);
  CHECK(predictor.state().horizontalSigmaM == Approx(2).epsilon(0.15));
}

TEST_CASE("Whatever is observed, what is predicted is finite and on time") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const int states : {6, 9, 12}) {
    PredictorOptions options;
    options.states = states;
    ViewpointPredictor predictor(options);
    double timeS = 0;
    for (int k = 0; k < 20000; ++k) {
      const double wild = std::pow(10, 9 * unit(random));
      timeS += unit(random) < 0.9 ? std::abs(unit(random)) * 0.1 : unit(random) * wild;
      Pose pose = flight()[static_cast<size_t>(k) % flight().size()].pose;
      if (unit(random) > 0.8) pose.position.latDeg = 95 * unit(random);
      if (unit(random) > 0.8) pose.position.lonDeg = 370 * unit(random);
      if (unit(random) > 0.8) pose.position.altM = wild * unit(random);
      if (unit(random) > 0.8) pose.pitchDeg = unit(random) > 0.9 ? kNaN : 1000 * unit(random);
      predictor.observe(timeS, pose);
      const Prediction p = predictor.at(timeS + 20 * unit(random));
      REQUIRE((!p.valid || isFinite(p)));
      REQUIRE(p.radius98M >= 0);
    }
    CHECK(predictor.state().counts.observations == 20000);
  }
}

}  // namespace
}  // namespace eye
