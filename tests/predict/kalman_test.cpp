// The filter of three axes against the paper's equations, written out plainly with whole matrices.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "predict/position_filter.h"

namespace eye {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Equations (1), (2) and (3) as printed: X(k+1/k), G, P(k+1/k). The order is x y z, vx vy vz, ...
struct PaperPredictor {
  Matrix a, c, q, r;
  Vector x;
  Matrix p;

  void step(const Vector& z) {
    const Matrix g = a * p * c.transpose() * (c * p * c.transpose() + r).inverse();
    x = a * x + g * (z - c * x);
    p = (a - g * c) * p * a.transpose() + q;
  }
};

double factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}

// Each derivative of the three axes, by Taylor's series.
Matrix fullTransition(int states, double t) {
  Matrix a = Matrix::Zero(3 * states, 3 * states);
  for (int row = 0; row < states; ++row) {
    for (int column = row; column < states; ++column)
      a.block(3 * row, 3 * column, 3, 3) = std::pow(t, column - row) / factorial(column - row) * Matrix::Identity(3, 3);
  }
  return a;
}

// The integral of A(s) D q D^T A(s)^T by Simpson's rule, D being the highest derivative.
Matrix fullProcessNoise(int states, double density, double t) {
  const int intervals = 2000;
  Matrix d = Matrix::Zero(3 * states, 3), q = Matrix::Zero(3 * states, 3 * states);
  d.bottomRows(3) = Matrix::Identity(3, 3);
  for (int i = 0; i <= intervals; ++i) {
    const double weight = i == 0 || i == intervals ? 1 : i % 2 == 1 ? 4 : 2;
    const Matrix response = fullTransition(states, t * i / intervals) * d;
    q += weight * density * response * response.transpose();
  }
  return q * (t / intervals / 3);
}

Matrix positionOnly(int states) {
  Matrix c = Matrix::Zero(3, 3 * states);
  c.leftCols(3) = Matrix::Identity(3, 3);
  return c;
}

AxisNoise sameNoise(double processNoise, double varianceM2) {
  return {{processNoise, processNoise, processNoise}, {varianceM2, varianceM2, varianceM2}};
}

bool isSound(const AxisMatrix& covariance) {
  if (covariance != covariance.transpose()) return false;
  const Eigen::MatrixXd whole = covariance;
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(whole).eigenvalues().minCoeff() >= 0;
}

// Steps of all lengths with exact and with rough measurements; a steady stream before and after.
void checkLongRun(int states, int64_t steps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  AxisMatrix covariance = 1e6 * AxisMatrix::Identity(states, states);
  const auto settle = [&] {
    for (int i = 0; i < 20000; ++i) {
      covariance = predictedCovariance(covariance, 20, 1 / 60.0);
      measure(covariance, 4);
    }
    return covariance;
  };
  const AxisMatrix before = settle();
  AxisKalman steady{AxisVector::Zero(states), covariance};
  for (int64_t i = 0; i < steps; ++i) {
    covariance = predictedCovariance(covariance, 20, 0.1 * unit(random) * unit(random));
    measure(covariance, i % 1000 < 500 ? 1e-6 : 4);
    if (i % 997 == 0) REQUIRE(isSound(covariance));
    steady.predict(1 / 60.0, 20);
    steady.update(-steady.state(0), 4);  // the aircraft stands at 0
  }
  CHECK((settle() - before).norm() <= 1e-9 * before.norm());
  CHECK((steady.covariance - before).norm() <= 1e-9 * before.norm());
  CHECK(steady.state.norm() == 0);
}

TEST_CASE("Process noise of white jerk is as in the textbook") {
  const double q = 20, t = 0.3;
  const AxisMatrix noise = processNoise(3, q, t);
  const double expected[3][3] = {{std::pow(t, 5) / 20, std::pow(t, 4) / 8, std::pow(t, 3) / 6},
                                 {std::pow(t, 4) / 8, std::pow(t, 3) / 3, t * t / 2},
                                 {std::pow(t, 3) / 6, t * t / 2, t}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) CHECK(noise(row, column) == Approx(q * expected[row][column]));
  }
}

TEST_CASE("Three blocks give what the paper's whole matrices give") {
  for (const int states : {2, 3, 4}) {
    INFO(states);
    const double t = 1 / 60.0, density = 20, sigmaM = 2;
    const Vec3d originM = ecefFromGeodetic({47, 11, 3000});
    const Mat3d frame = ecefFromEnu(47, 11);
    const AxisNoise noise = sameNoise(density, sigmaM * sigmaM);
    PositionFilter filter(states);
    filter.start(originM, frame * Vec3d(20, 30, 0), 100, noise);

    std::array<AxisKalman, 3> blocks = filter.axes();  // the same, without a frame
    // Begins as the filter does before its first step.
    PaperPredictor paper{fullTransition(states, t),
                         positionOnly(states),
                         fullProcessNoise(states, density, t),
                         sigmaM * sigmaM * Matrix::Identity(3, 3),
                         Vector::Zero(3 * states),
                         Matrix::Zero(3 * states, 3 * states)};
    paper.x.segment(3, 3) = Eigen::Vector3d(20, 30, 0);
    const double sigmas[4] = {sigmaM, 100, 100, 100};
    for (int i = 0; i < 3 * states; ++i) paper.p(i, i) = sigmas[i / 3] * sigmas[i / 3];
    paper.x = paper.a * paper.x;
    paper.p = paper.a * paper.p * paper.a.transpose() + paper.q;

    std::mt19937 random(1);
    std::normal_distribution<double> normal(0, sigmaM);
    for (int k = 1; k <= 600; ++k) {
      const double s = k * t;
      const Vec3d measuredM(20 * s + normal(random), 30 * s + s * s + normal(random), 5 * std::sin(s) + normal(random));
      filter.predict(t, noise);
      filter.update(filter.innovation(originM + frame * measuredM, noise), noise);
      paper.step(Eigen::Vector3d(measuredM.x, measuredM.y, measuredM.z));

      double blockOff = 0;
      for (int axis = 0; axis < 3; ++axis) {
        AxisKalman& block = blocks[static_cast<size_t>(axis)];
        block.predict(t, density);
        block.update(measuredM[axis] - block.state(0), sigmaM * sigmaM);
        AxisKalman later = block;
        later.predict(t, density);
        for (int i = 0; i < states; ++i) {
          const double expected = paper.x(3 * i + axis);
          blockOff = std::max(blockOff, std::abs(later.state(i) - expected) / (1 + std::abs(expected)));
        }
      }
      REQUIRE(blockOff < 1e-9);

      PositionFilter next = filter;
      next.predict(t, noise);
      double stateOff = 0, covarianceOff = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const AxisKalman& block = next.axes()[static_cast<size_t>(axis)];
        for (int i = 0; i < states; ++i) {
          stateOff = std::max(stateOff, std::abs(block.state(i) - paper.x(3 * i + axis)));
          for (int j = 0; j < states; ++j) {
            const double expected = paper.p(3 * i + axis, 3 * j + axis);
            covarianceOff =
                std::max(covarianceOff, std::abs(block.covariance(i, j) - expected) / (1 + std::abs(expected)));
          }
        }
      }
      // Positions of the filter come from ecef, whose rounding is 1e-9 m: the first steps give it to the acceleration
      // 100 times enlarged.
      REQUIRE(stateOff < (k < 60 ? 1e-5 : 1e-7));
      REQUIRE(std::abs(next.axes()[0].state(0) - paper.x(0)) < 4e-9);
      REQUIRE(covarianceOff < 1e-9);
    }
  }
}

TEST_CASE("Equation (4) as printed, position plus velocity, is off by one second of flight") {
  const double t = 1 / 60.0, speedMS = 80;
  PaperPredictor paper{fullTransition(3, t),       positionOnly(3), fullProcessNoise(3, 20, t),
                       4 * Matrix::Identity(3, 3), Vector::Zero(9), 1e4 * Matrix::Identity(9, 9)};
  paper.c.block(0, 3, 3, 3) = Matrix::Identity(3, 3);
  for (int k = 0; k < 6000; ++k) paper.step(Eigen::Vector3d(speedMS * k * t, 0, 0));
  CHECK(speedMS * 6000 * t - paper.x(0) == Approx(80).margin(1e-3));
}

TEST_CASE("Covariances stay symmetric and positive, and come back to where they were") {
  for (const int states : {2, 3, 4}) checkLongRun(states, 100'000);
}

TEST_CASE("Ten million steps", "[.][long]") {
  for (const int states : {2, 3, 4}) checkLongRun(states, 10'000'000);
}

// With one noise in all directions the estimate knows no directions: the same filter in ecef, which never moves its
// origin, has to agree.
TEST_CASE("Round the globe over both poles nothing is lost when the frame moves") {
  const double stepS = 0.1, speedMS = 3000, altitudeM = 10000;
  const AxisNoise noise = sameNoise(20, 4);
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 2);
  const auto placeAt = [&](double timeS) {
    const double alongDeg = degFromRad(speedMS * timeS / (kSemiMajorM + altitudeM));  // 0 at the equator, 90 at a pole
    const double folded = std::fmod(alongDeg, 360);
    const bool isFar = folded > 90 && folded < 270;
    const double latDeg = folded <= 90 ? folded : isFar ? 180 - folded : folded - 360;
    return ecefFromGeodetic({latDeg, isFar ? -155.0 : 25.0, altitudeM});
  };

  PositionFilter filter(3);
  filter.start(placeAt(0), Vec3d(0.0), 1e4, noise);
  std::array<AxisKalman, 3> fixed = filter.axes();
  for (int axis = 0; axis < 3; ++axis) fixed[static_cast<size_t>(axis)].state(0) = placeAt(0)[axis];

  double worstM = 0, nisHalves[2] = {0, 0}, fixedNis = 0;
  size_t frames = 0;
  Vec3d origin = filter.originEcefM();
  const int steps = static_cast<int>(2 * 3.141592653589793 * (kSemiMajorM + altitudeM) / speedMS / stepS);
  for (int k = 1; k <= steps; ++k) {
    const Vec3d measuredM = placeAt(k * stepS) + Vec3d(normal(random), normal(random), normal(random));
    filter.predict(stepS, noise);
    const PositionFilter::Innovation innovation = filter.innovation(measuredM, noise);
    filter.update(innovation, noise);
    nisHalves[k * 2 > steps] += innovation.nis;
    Vec3d fixedM;
    for (int axis = 0; axis < 3; ++axis) {
      AxisKalman& kalman = fixed[static_cast<size_t>(axis)];
      kalman.predict(stepS, 20);
      const double offM = measuredM[axis] - kalman.state(0);
      fixedNis += offM * offM / (kalman.covariance(0, 0) + 4);
      kalman.update(offM, 4);
      fixedM[axis] = transition(3, 2.0).row(0).dot(kalman.state);
    }
    worstM = std::max(worstM, glm::length(filter.at(2.0, noise).ecefM - fixedM));
    frames += filter.originEcefM() != origin;
    origin = filter.originEcefM();
    for (size_t axis = 0; axis < 3; ++axis)
      REQUIRE((filter.axes()[axis].covariance - fixed[axis].covariance).norm() <= 1e-9 * fixed[axis].covariance.norm());
  }
  CHECK(frames > 6000);
  CHECK(worstM < 1e-6);
  CHECK(nisHalves[0] + nisHalves[1] == Approx(fixedNis).epsilon(1e-7));
  // 200,000 degrees of freedom a half: 99.9 % of such means are within 1.04 %.
  CHECK(nisHalves[1] == Approx(nisHalves[0]).epsilon(0.0147));
}

}  // namespace
}  // namespace eye
