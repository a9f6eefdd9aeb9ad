// Clocks and filters over a long time.
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "bench/stability.h"
#include "geo/sun.h"
#include "predict/axis_kalman.h"
#include "predict/viewpoint_predictor.h"

namespace eye {
namespace {

constexpr double kDayS = 86400, kFrameS = 1.0 / 60;

// Steps of the sun's direction are all nearly the same: how far the worst is off the mean, as a share of it.
double sunUnevenness(int stepsPerS) {
  const double noon = julianDay(2026, 6, 21.5);
  const auto steps = static_cast<int64_t>(kDayS) * stepsPerS;
  Vec3d before = sunDirectionEcef(noon);
  double sum = 0, least = std::numeric_limits<double>::infinity(), most = 0;
  for (int64_t i = 1; i <= steps; ++i) {
    const Vec3d sun = sunDirectionEcef(noon + static_cast<double>(i) / (kDayS * stepsPerS));
    const double step = glm::length(sun - before);
    sum += step;
    least = std::min(least, step);
    most = std::max(most, step);
    before = sun;
  }
  const double mean = sum / static_cast<double>(steps);
  return std::max(most / mean - 1, 1 - least / mean);
}

// A level turn at 150 m/s, one minute of it, from `beginS` of the clock on: predictions 2 s ahead, once a second.
std::vector<Vec3d> predictionsFrom(double beginS) {
  ViewpointPredictor predictor;
  std::vector<Vec3d> predicted;
  for (int frame = 0; frame < 3600; ++frame) {
    const double timeS = frame * kFrameS, angle = 0.05 * timeS;
    predictor.observe(beginS + timeS, {{49 + 0.027 * std::sin(angle), 20 + 0.041 * std::cos(angle), 2000}, 0, 0, 0});
    if (frame % 60 == 59) predicted.push_back(predictor.at(beginS + timeS + 2).ecefM);
  }
  return predicted;
}

double clockDrift() {
  const std::vector<Vec3d> first = predictionsFrom(0), late = predictionsFrom(kDayS);
  double worstM = 0;
  for (size_t i = 0; i < first.size(); ++i) worstM = std::max(worstM, glm::length(first[i] - late[i]));
  return worstM;
}

struct LongRun {
  double asymmetry = 0, mostNegative = 0, drift = 0;  // shares of the covariance's norm
};

LongRun longRun(int states, uint64_t steps) {
  constexpr double kDensity = 20, kVarianceM2 = 4, kStartVariance = 1e4;
  constexpr uint64_t kSettled = 10'000, kEvery = 97;  // looked at now and then; what is wrong stays wrong
  AxisKalman axis{AxisVector::Zero(states), AxisMatrix::Identity(states, states) * kStartVariance};
  AxisMatrix settled;
  LongRun run;
  for (uint64_t i = 1; i <= steps; ++i) {
    axis.predict(kFrameS, kDensity);
    axis.update(std::sin(static_cast<double>(i)), kVarianceM2);
    if (i == kSettled) settled = axis.covariance;
    if (i < kSettled || i % kEvery != 0) continue;
    const double norm = axis.covariance.norm();
    run.asymmetry = std::max(run.asymmetry, (axis.covariance - axis.covariance.transpose()).norm() / norm);
    const double least =
        Eigen::SelfAdjointEigenSolver<AxisMatrix>(axis.covariance, Eigen::EigenvaluesOnly).eigenvalues()(0);
    run.mostNegative = std::max(run.mostNegative, -least / norm);
    run.drift = std::max(run.drift, (axis.covariance - settled).norm() / norm);
  }
  return run;
}

}  // namespace

std::vector<StabilityFigure> clockFigures(const ClockEffort& effort) {
  std::vector<StabilityFigure> figures;
  figures.push_back(
      {"the sun's steps over 24 h, worst against the mean", 100 * sunUnevenness(effort.sunStepsPerS), 1, "%"});
  figures.push_back({"predictions after 24 h of the clock against the same at its start", clockDrift(), 1e-3, "m"});
  for (const int states : {2, 3, 4}) {
    const LongRun run = longRun(states, effort.filterSteps);
    const std::string name = ", Kalman filter of " + std::to_string(3 * states) + " states, " +
                             std::to_string(effort.filterSteps) + " steps";
    figures.push_back({"asymmetry" + name, run.asymmetry, 1e-12, "of the covariance"});
    figures.push_back({"negative variance" + name, run.mostNegative, 0, "of the covariance"});
    figures.push_back({"drift of the covariance" + name, run.drift, 1e-6, "of the covariance"});
  }
  return figures;
}

}  // namespace eye
