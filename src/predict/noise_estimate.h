// Process and measurement noise, as configured or as the stream of innovations shows them.
#pragma once

#include <algorithm>
#include <span>

namespace eye {

// An innovation that is scaled by its own variance should have a mean square of 1 and tell nothing of the next one.
//   Its mean square says the scale of both noises together.
//   What it has in common with those before says their ratio: a filter that is too slow is behind for a while, one that
//   is too quick takes back what it did.
// Both are followed slowly and within bounds: the scale in about 100 observations, the ratio in about 1000.
class NoiseEstimate {
 public:
  NoiseEstimate(double processNoise, double measurementSigmaM, bool adapt);

  double processNoise() const { return processNoise_; }
  // For the time to come: what a pilot will do is not in the calm before it, so never less than configured.
  double futureProcessNoise() const { return std::max(processNoise_, configuredProcessNoise_); }
  double measurementVarianceM2() const { return measurementVarianceM2_; }
  // The innovations of one observation, over their standard deviations: one an axis that shares these noises, at most
  // two.
  void observe(std::span<const double> whitened);
  // The next observations do not continue those before; the noises stay.
  void restart();

 private:
  double configuredProcessNoise_, configuredVarianceM2_;
  bool adapt_;
  double processNoise_, measurementVarianceM2_;
  double recent_[2] = {0, 0};  // exponential mean of the innovations before, an axis each
};

}  // namespace eye
