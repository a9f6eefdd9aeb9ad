#include "predict/noise_estimate.h"

#include <algorithm>
#include <cmath>

namespace eye {
namespace {

constexpr double kScaleGain = 0.01;  // an observation; the scale's own noise is then 6 %
constexpr double kRatioGain =
    0.01;                      // an observation; bandwidth goes with the sixth root of the ratio, so it may be rough
constexpr double kMemory = 8;  // observations that an innovation is compared with
constexpr double kMost = 9;    // of a mean square, so that an outlier counts as one of 3 sigma
// The process noise must let the filter follow a turn that begins after an hour straight on: not far down.
constexpr double kLeastProcess = 0.1, kMostProcess = 1000;  // of the configured one
constexpr double kLeastSigmaM = 1e-3;                       // below this nothing on a screen moves
constexpr double kMostVariance = 2500;                      // 50 times the configured sigma

}  // namespace

NoiseEstimate::NoiseEstimate(double processNoise, double measurementSigmaM, bool adapt)
    : configuredProcessNoise_(processNoise),
      configuredVarianceM2_(measurementSigmaM * measurementSigmaM),
      adapt_(adapt),
      processNoise_(processNoise),
      measurementVarianceM2_(configuredVarianceM2_) {}

void NoiseEstimate::restart() {
  recent_[0] = recent_[1] = 0;
}

void NoiseEstimate::observe(std::span<const double> whitened) {
  if (!adapt_) return;
  double square = 0, common = 0;
  for (size_t i = 0; i < whitened.size(); ++i) {
    square += whitened[i] * whitened[i];
    common += whitened[i] * recent_[i];
    recent_[i] += (std::clamp(whitened[i], -kMost, kMost) - recent_[i]) / kMemory;
  }
  const auto axes = static_cast<double>(whitened.size());
  // The exponential mean of white innovations has a variance of 1 / (2 memory - 1).
  const double likeness = std::clamp(common / axes * std::sqrt(2 * kMemory - 1), -kMost, kMost);
  const double scale = kScaleGain * (std::min(square / axes, kMost) - 1);
  const double ratio = kRatioGain * likeness;
  processNoise_ = std::clamp(processNoise_ * std::exp(scale + ratio), kLeastProcess * configuredProcessNoise_,
                             kMostProcess * configuredProcessNoise_);
  const double leastVarianceM2 = std::min(kLeastSigmaM * kLeastSigmaM, configuredVarianceM2_);
  measurementVarianceM2_ = std::clamp(measurementVarianceM2_ * std::exp(scale - ratio), leastVarianceM2,
                                      kMostVariance * configuredVarianceM2_);
}

}  // namespace eye
