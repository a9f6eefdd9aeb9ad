#include "bench/prediction_study.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>

#include "geo/frames.h"
#include "predict/viewpoint_predictor.h"

namespace eye {
namespace {

constexpr double kRateHz = 60, kSpeedMS = 300, kGravityMS2 = 9.80665;
constexpr int kSubSteps = 16;       // of the simulation, a sample
constexpr double kWarmUpS = 5;      // before errors count
constexpr double kDifferenceS = 1;  // over which the velocity is taken: shorter, and the noise is worse than the lag
constexpr Geodetic kStart{47, 11, 3000};

double towards(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

// What the pilot wants at a moment: bank, and the climb angle's rate.
struct Command {
  double bankRad, climbRateRadS, rollRateRadS;
};

Command commandAt(Manoeuvre manoeuvre, double timeS) {
  const double standardBankRad = std::atan(kSpeedMS * radFromDeg(3) / kGravityMS2);
  switch (manoeuvre) {
    case Manoeuvre::straight:
      return {0, 0, 1};
    case Manoeuvre::standardRateTurns: {
      const double phaseS = std::fmod(timeS, 80);
      const double side = phaseS >= 10 && phaseS < 40 ? 1 : phaseS >= 50 ? -1 : 0;
      return {side * standardBankRad, 0, radFromDeg(15)};
    }
    case Manoeuvre::bankReversals:
      return {radFromDeg(std::fmod(timeS, 20) < 10 ? 60 : -60), 0, radFromDeg(60)};
    case Manoeuvre::climbs: {
      // Up for 6 s, down for 12, up for 6: the climb angle comes back to where it was.
      const double phaseS = std::fmod(timeS, 24);
      return {0, (phaseS < 6 || phaseS >= 18 ? 1 : -1) * kGravityMS2 / kSpeedMS, 1};
    }
  }
  return {0, 0, 1};
}

Vec3d velocityEnu(double courseRad, double climbRad) {
  return kSpeedMS *
         Vec3d(std::sin(courseRad) * std::cos(climbRad), std::cos(courseRad) * std::cos(climbRad), std::sin(climbRad));
}

double quantile95(std::vector<double>& values) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

struct Guess {
  Vec3d ecefM{};
  double radius98M = std::numeric_limits<double>::quiet_NaN();
  Pose pose;
};

// A method under study: is shown every observation, and asked for the place `horizonS` later.
struct Method {
  std::string name;
  std::function<void(const TrackSample&)> observe;
  std::function<Guess(double timeS)> at;
  std::function<PredictorState()> state;  // empty without a model
};

Method holdMethod() {
  const auto newest = std::make_shared<TrackSample>();
  return {"hold",
          [newest](const TrackSample& sample) { *newest = sample; },
          [newest](double) { return Guess{.ecefM = ecefFromGeodetic(newest->pose.position), .pose = newest->pose}; },
          {}};
}

Method differenceMethod() {
  const auto last = std::make_shared<std::vector<TrackSample>>();
  return {"difference",
          [last](const TrackSample& sample) {
            last->push_back(sample);
            // Keeps the newest sample that is at least as old as the span, and all after it.
            const auto isOld = [&](const TrackSample& s) { return s.timeS <= sample.timeS - kDifferenceS; };
            const auto firstYoung = std::find_if_not(last->begin(), last->end(), isOld);
            if (firstYoung - last->begin() > 1) last->erase(last->begin(), firstYoung - 1);
          },
          [last](double timeS) {
            const TrackSample &from = last->front(), &to = last->back();
            const Vec3d fromM = ecefFromGeodetic(from.pose.position), toM = ecefFromGeodetic(to.pose.position);
            const double spanS = to.timeS - from.timeS;
            const Vec3d movedM = spanS > 0 ? (toM - fromM) * ((timeS - to.timeS) / spanS) : Vec3d(0.0);
            return Guess{.ecefM = toM + movedM, .pose = to.pose};
          },
          {}};
}

Method kalmanMethod(const std::string& name, const PredictorOptions& options) {
  const auto predictor = std::make_shared<ViewpointPredictor>(options);
  return {name, [predictor](const TrackSample& sample) { predictor->observe(sample.timeS, sample.pose); },
          [predictor](double timeS) {
            const Prediction p = predictor->at(timeS);
            return Guess{.ecefM = p.ecefM, .radius98M = p.radius98M, .pose = p.pose};
          },
          [predictor] { return predictor->state(); }};
}

struct Errors {
  std::vector<double> distancesM;
  double squaresM2 = 0, turnSquaresRad2 = 0;
  size_t within98 = 0;

  void add(const Guess& guess, const Pose& truth) {
    const Vec3d offEcefM = guess.ecefM - ecefFromGeodetic(truth.position);
    const double distanceM = glm::length(offEcefM);
    distancesM.push_back(distanceM);
    squaresM2 += distanceM * distanceM;
    const double upM = glm::dot(offEcefM, upAt(truth.position.latDeg, truth.position.lonDeg));
    within98 += std::sqrt(std::max(distanceM * distanceM - upM * upM, 0.0)) <= guess.radius98M;
    const glm::dquat turn = glm::conjugate(attitudeOf(guess.pose)) * attitudeOf(truth);
    const double turnRad = 2 * std::atan2(std::hypot(turn.x, turn.y, turn.z), std::abs(turn.w));
    turnSquaresRad2 += turnRad * turnRad;
  }
};

}  // namespace

const char* manoeuvreName(Manoeuvre manoeuvre) {
  switch (manoeuvre) {
    case Manoeuvre::straight:
      return "straight";
    case Manoeuvre::standardRateTurns:
      return "standard-rate turns";
    case Manoeuvre::bankReversals:
      return "60-degree bank reversals";
    case Manoeuvre::climbs:
      return "pull-ups and push-overs";
  }
  return "";
}

std::vector<TrackSample> simulatedTrack(Manoeuvre manoeuvre, double durationS) {
  const Mat3d frame = ecefFromEnu(kStart.latDeg, kStart.lonDeg);
  const Vec3d originM = ecefFromGeodetic(kStart);
  const auto count = static_cast<size_t>(durationS * kRateHz) + 1;
  const double stepS = 1 / kRateHz / kSubSteps;

  std::vector<TrackSample> samples;
  samples.reserve(count);
  Vec3d placeEnuM{};
  double courseRad = 1, climbRad = 0, bankRad = 0, climbRateRadS = 0;
  for (size_t i = 0; i < count; ++i) {
    const double timeS = static_cast<double>(i) / kRateHz;
    const Geodetic position = geodeticFromEcef(originM + frame * placeEnuM);
    samples.push_back({timeS, {position, degFromRad(courseRad), degFromRad(climbRad), degFromRad(bankRad)}});
    for (int sub = 0; sub < kSubSteps; ++sub) {
      const Command command = commandAt(manoeuvre, timeS + sub * stepS);
      bankRad = towards(bankRad, command.bankRad, command.rollRateRadS * stepS);
      climbRateRadS = towards(climbRateRadS, command.climbRateRadS, 0.05 * stepS);  // 1.5 g a second
      const double midCourseRad = courseRad + kGravityMS2 * std::tan(bankRad) / kSpeedMS * stepS / 2;
      placeEnuM += velocityEnu(midCourseRad, climbRad + climbRateRadS * stepS / 2) * stepS;
      courseRad = 2 * midCourseRad - courseRad;
      climbRad += climbRateRadS * stepS;
    }
  }
  for (TrackSample& sample : samples) sample.pose.headingDeg -= 360 * std::floor(sample.pose.headingDeg / 360);
  return samples;
}

std::vector<TrackSample> withNoise(std::vector<TrackSample> samples, double sigmaM, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, sigmaM);
  for (TrackSample& sample : samples) {
    const Vec3d noiseM(normal(random), normal(random), normal(random));
    sample.pose.position = geodeticFromEcef(ecefFromGeodetic(sample.pose.position) + noiseM);
  }
  return samples;
}

std::vector<PredictionRow> studyPrediction(const std::string& name, const std::vector<TrackSample>& observed,
                                           const Track& truth) {
  const Method methods[] = {holdMethod(),
                            differenceMethod(),
                            kalmanMethod("kalman6", {.states = 6, .processNoise = {}, .adapt = false}),
                            kalmanMethod("kalman9", {.states = 9, .processNoise = {}, .adapt = false}),
                            kalmanMethod("kalman12", {.states = 12, .processNoise = {}, .adapt = false}),
                            kalmanMethod("kalman9-adaptive", {.states = 9, .processNoise = {}, .adapt = true})};
  constexpr size_t kHorizons = std::size(kStudyHorizonsS);
  std::vector<PredictionRow> rows;
  for (const Method& method : methods) {
    Errors errors[kHorizons];
    double nisSum = 0;
    size_t nisCount = 0;
    for (const TrackSample& sample : observed) {
      method.observe(sample);
      if (sample.timeS < kWarmUpS) continue;
      nisSum += method.state ? method.state().nis / 3 : 0;
      ++nisCount;
      for (size_t i = 0; i < kHorizons; ++i) {
        const double laterS = sample.timeS + kStudyHorizonsS[i];
        if (laterS <= truth.durationS()) errors[i].add(method.at(laterS), truth.at(laterS));
      }
    }
    for (size_t i = 0; i < kHorizons; ++i) {
      Errors& e = errors[i];
      if (e.distancesM.empty()) continue;
      const auto count = static_cast<double>(e.distancesM.size());
      const double none = std::numeric_limits<double>::quiet_NaN();
      rows.push_back({.manoeuvre = name,
                      .method = method.name,
                      .horizonS = kStudyHorizonsS[i],
                      .rmsM = std::sqrt(e.squaresM2 / count),
                      .p95M = quantile95(e.distancesM),
                      .nisMean = method.state ? nisSum / static_cast<double>(nisCount) : none,
                      .coverage98 = method.state ? static_cast<double>(e.within98) / count : none,
                      .attitudeRmsDeg = degFromRad(std::sqrt(e.turnSquaresRad2 / count))});
    }
  }
  return rows;
}

}  // namespace eye
