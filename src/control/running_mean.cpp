#include "control/running_mean.h"

namespace eye {
namespace {

constexpr int kFactorFrames = 4;      // at another size, until the scene is measured through it
constexpr double kFactorGain = 0.4;   // of one such frame: two of them move a factor by two thirds
constexpr double kFactorRange = 8;    // farther from what is assumed no factor goes
constexpr double kLeastScene = 1e-3;  // a scene value below this tells nothing of factors

}  // namespace

double RunningMedian::median() const {
  if (!any()) return 0;
  std::array<double, 9> sorted = newest_;
  const auto end = sorted.begin() + std::min<int64_t>(count_, static_cast<int64_t>(sorted.size()));
  std::sort(sorted.begin(), end);
  const auto upper = sorted.begin() + (end - sorted.begin()) / 2;
  return (end - sorted.begin()) % 2 ? *upper : (*(upper - 1) + *upper) / 2;
}

void ValueBySize::observe(DepthMapChoice size, double value) {
  double& factor = factor_[sizeIndex(size)];
  const double assumed = assumed_[sizeIndex(size)];
  const bool other = size != anchor_ && scene_.count() > 0 && scene_.mean() > kLeastScene;
  otherFrames_ = other ? otherFrames_ + 1 : 0;
  if (other && otherFrames_ <= kFactorFrames) {
    factor += kFactorGain * (value / scene_.mean() - factor);
    factor = std::clamp(factor, assumed / kFactorRange, assumed * kFactorRange);
    return;
  }
  anchor_ = size;
  otherFrames_ = 0;
  scene_.add(value / factor);
  measured_ = true;
}

}  // namespace eye
