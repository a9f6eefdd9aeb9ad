// The study's errors, against what is known of them; by hand, the whole table.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "bench/prediction_study.h"
#include "geo/frames.h"
#include "link/track_file.h"
#include "support/places.h"

namespace eye {
namespace {

void print(const std::vector<PredictionRow>& rows) {
  for (const PredictionRow& r : rows)
    fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.1f} | {:.2f} |\n", r.manoeuvre, r.method, r.horizonS,
               r.rmsM, r.p95M, r.nisMean, 100 * r.coverage98, r.attitudeRmsDeg);
}

// NaN where there is no such row.
double valueOf(const std::vector<PredictionRow>& rows, const std::string& method, double horizonS,
               double PredictionRow::*value) {
  for (const PredictionRow& row : rows) {
    if (row.method == method && row.horizonS == horizonS) return row.*value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("Simulated manoeuvres are what their names say") {
  for (const Manoeuvre manoeuvre : kManoeuvres) {
    INFO(manoeuvreName(manoeuvre));
    const std::vector<TrackSample> samples = simulatedTrack(manoeuvre, 90);
    REQUIRE(samples.size() == 90 * 60 + 1);
    double mostBankDeg = 0, mostClimbMS = 0, mostTurnDeg = 0;
    for (size_t i = 1; i < samples.size(); ++i) {
      const Pose &from = samples[i - 1].pose, &to = samples[i].pose;
      const double movedM = glm::length(ecefFromGeodetic(to.position) - ecefFromGeodetic(from.position));
      REQUIRE(movedM * 60 == Approx(300).epsilon(1e-3));
      mostBankDeg = std::max(mostBankDeg, std::abs(to.rollDeg));
      mostClimbMS = std::max(mostClimbMS, std::abs(to.position.altM - from.position.altM) * 60);
      mostTurnDeg = std::max(mostTurnDeg, 60 * std::abs(std::remainder(to.headingDeg - from.headingDeg, 360)));
    }
    const bool isTurn = manoeuvre == Manoeuvre::standardRateTurns, isReversal = manoeuvre == Manoeuvre::bankReversals;
    CHECK(mostBankDeg == Approx(isTurn ? 58 : isReversal ? 60 : 0).margin(0.1));
    CHECK(mostTurnDeg == Approx(isTurn ? 3 : isReversal ? 3.245 : 0).margin(0.01));
    CHECK((mostClimbMS > 30) == (manoeuvre == Manoeuvre::climbs));
  }
}

TEST_CASE("Errors in standard-rate turns are the ones that are known") {
  const std::vector<TrackSample> truth = simulatedTrack(Manoeuvre::standardRateTurns, 90);
  const std::vector<PredictionRow> rows = studyPrediction("turns", withNoise(truth, 2, 1), Track(truth));
  // RMS and 95 % of an independent computation over such flights: nine states, and holding the last place.
  const double known[][3] = {{0.5, 2.4, 3.9}, {1, 4.7, 7.8}, {2, 12, 21}, {5, 63, 127}};
  for (const auto& [horizonS, rmsM, p95M] : known) {
    INFO(horizonS << " s");
    CHECK(valueOf(rows, "kalman9", horizonS, &PredictionRow::rmsM) == Approx(rmsM).epsilon(0.15));
    CHECK(valueOf(rows, "kalman9", horizonS, &PredictionRow::p95M) == Approx(p95M).epsilon(0.15));
    CHECK(valueOf(rows, "hold", horizonS, &PredictionRow::rmsM) == Approx(300 * horizonS).epsilon(0.01));
    const double errors[] = {valueOf(rows, "kalman9-adaptive", horizonS, &PredictionRow::rmsM),
                             valueOf(rows, "kalman9", horizonS, &PredictionRow::rmsM),
                             valueOf(rows, "kalman6", horizonS, &PredictionRow::rmsM),
                             valueOf(rows, "difference", horizonS, &PredictionRow::rmsM)};
    CHECK(std::is_sorted(std::begin(errors), std::end(errors)));
  }
  CHECK(valueOf(rows, "kalman9", 1, &PredictionRow::attitudeRmsDeg) < 3.5);
  CHECK(valueOf(rows, "hold", 1, &PredictionRow::attitudeRmsDeg) > 6);
}

TEST_CASE("Recorded flights are predicted better than by holding still or flying straight on") {
  const Result<Track> track = loadTrack(eye::test::kTestData + "/captures/jsbsim_c1723_takeoff.pcap");
  if (!track) {
    WARN("no recordings: " << track.error().message);
    return;
  }
  const std::vector<PredictionRow> rows = studyPrediction("takeoff", track->samples(), *track);
  for (const double horizonS : {0.5, 1.0, 2.0}) {
    const double errorM = valueOf(rows, "kalman9-adaptive", horizonS, &PredictionRow::rmsM);
    CHECK(errorM < 0.1 * valueOf(rows, "hold", horizonS, &PredictionRow::rmsM));
    CHECK(errorM < 0.7 * valueOf(rows, "difference", horizonS, &PredictionRow::rmsM));
    CHECK(valueOf(rows, "kalman9-adaptive", horizonS, &PredictionRow::coverage98) > 0.97);
  }
}

TEST_CASE("Table of prediction errors", "[.][table]") {
  for (const double sigmaM : {2.0, 0.0}) {
    for (const Manoeuvre manoeuvre : kManoeuvres) {
      const std::vector<TrackSample> truth = simulatedTrack(manoeuvre, 90);
      print(studyPrediction(fmt::format("{}, noise {} m", manoeuvreName(manoeuvre), sigmaM),
                            withNoise(truth, sigmaM, 1), Track(truth)));
    }
  }
  for (const char* file : {"tracks/igc/glider_australia_1s.igc", "tracks/igc/glider_nimbus4_frenchalps_1hz.igc",
                           "tracks/igc/helicopter_germany_4s.igc", "captures/jsbsim_737_cruise.pcap",
                           "captures/jsbsim_c1723_takeoff.pcap"}) {
    const Result<Track> track = loadTrack(eye::test::kTestData + "/" + file);
    if (!track) {
      WARN("no " << file << ": " << track.error().message);
      continue;
    }
    print(studyPrediction(file, track->samples(), *track));
  }
}

}  // namespace
}  // namespace eye
