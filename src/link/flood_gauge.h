// Whether something comes in floods: datagrams, or those of strangers. Owner thread: link.
#pragma once

#include <cstdint>

namespace eye {

// From 5,000 a second on, seen within a window and over when one has passed with less. A host's frames are a hundredth
// of it, and one that asks for a thousand heights with each of them sends a quarter.
class FloodGauge {
 public:
  // Since the last call, which is at most a window ago while nothing comes.
  void count(uint64_t datagrams, int64_t nowNs) {
    if (nowNs - beganNs_ >= kWindowNs) {
      isOn_ = counted_ >= kFlood;
      counted_ = 0;
      beganNs_ = nowNs;
    }
    counted_ += datagrams;
    isOn_ = isOn_ || counted_ >= kFlood;
  }
  bool isOn() const { return isOn_; }

 private:
  static constexpr int64_t kWindowNs = 20'000'000;
  static constexpr uint64_t kFlood = 100;  // in a window

  int64_t beganNs_ = 0;
  uint64_t counted_ = 0;
  bool isOn_ = false;
};

}  // namespace eye
