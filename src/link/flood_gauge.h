// Whether something comes in floods: datagrams, or those of strangers. Owner thread: link.
#pragma once

#include <cstdint>

namespace eye {

// From 5,000 a second on, seen within a window and over when one has passed with less. A host's frames are a hundredth
// of it, and one that asks for a thousand heights with each of them sends a quarter.
class FloodGauge {
 public:
  explicit FloodGauge(int64_t windowNs = 20'000'000)
      : windowNs_(windowNs), flood_(windowNs * kFloodHz / 1'000'000'000) {}

  // Since the last call, which is at most a window ago while nothing comes.
  void count(int64_t datagrams, int64_t nowNs) {
    if (nowNs - beganNs_ >= windowNs_) {
      isOn_ = counted_ >= flood_;
      counted_ = 0;
      beganNs_ = nowNs;
    }
    counted_ += datagrams;
    isOn_ = isOn_ || counted_ >= flood_;
  }
  bool isOn() const { return isOn_; }

 private:
  static constexpr int64_t kFloodHz = 5000;

  int64_t windowNs_, flood_;  // datagrams in a window that are one
  int64_t beganNs_ = 0, counted_ = 0;
  bool isOn_ = false;
};

}  // namespace eye
