// The mean of the newest measurements, and what is built on it: values per size of the depth map.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "control/depth_map_choice.h"

namespace eye {

// The plain mean of a run's first kMemory values, after that an exponential one of that memory.
class RunningMean {
 public:
  void add(double value) {
    count_ = std::min(count_ + 1, kMemory);
    mean_ += (value - mean_) / count_;
  }
  // The next value begins a new run; until then the old mean stands.
  void restart() { count_ = 0; }
  double mean() const { return mean_; }
  int count() const { return count_; }

 private:
  static constexpr int kMemory = 8;  // frames: noise of the mean a third of a frame's, lag 4 frames
  double mean_ = 0;
  int count_ = 0;
};

// The median of a run's newest values: a frame that the machine held up does not count.
class RunningMedian {
 public:
  void add(double value) { newest_[static_cast<size_t>(count_++) % newest_.size()] = value; }
  void restart() { count_ = 0; }
  bool any() const { return count_ > 0; }
  // 0 without values.
  double median() const;

 private:
  std::array<double, 9> newest_{};
  int64_t count_ = 0;
};

// A value of the scene times a factor of the size: sizes that are not in use follow the scene through the one that is.
class ValueBySize {
 public:
  explicit ValueBySize(const std::array<double, kDepthMapSizes>& assumed) : assumed_(assumed), factor_(assumed) {}

  // A value measured at a size. In the first frames at another size than before it tells of that size's factor, after
  // those, and after restart(), of the scene.
  void observe(DepthMapChoice size, double value);
  // After frames without the pass: the scene has changed, the factors have not.
  void restart() { scene_.restart(); }
  double at(DepthMapChoice size) const {
    return measured_ ? scene_.mean() * factor_[sizeIndex(size)] : assumedAt(size);
  }
  double assumedAt(DepthMapChoice size) const { return assumed_[sizeIndex(size)]; }

 private:
  std::array<double, kDepthMapSizes> assumed_, factor_;
  RunningMean scene_;
  DepthMapChoice anchor_ = DepthMapChoice::off;  // the size through which the scene is measured
  int otherFrames_ = 0;                          // in a row at another size
  bool measured_ = false;
};

}  // namespace eye
