// The mailbox through which what hosts say reaches the frame.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "geo/pose.h"

namespace eye {

struct HostCounts {
  uint64_t packets = 0;   // datagrams received, good and bad
  uint64_t rejected = 0;  // wrong size, version, sender, NaN, out of range
  uint64_t unread = 0;    // beyond those: dropped by the system, of strangers in a flood or for want of room
  uint64_t lost = 0;      // gaps in the protocol's own numbering, where it has one
};

// A pose that a host has told, on this machine's clock.
struct StampedPose {
  Pose pose;
  int64_t atNs = 0;       // when it was true, as far as is known
  int64_t arrivedNs = 0;  // when it came
};

// More poses than this between two frames are a flood or a frame of seconds: the oldest are dropped.
inline constexpr size_t kMaxHeard = 64;

// One writer (the link thread), one reader (the frame): the latest state, and the poses that came since the last look.
// A state has `arrivedNs`, which tells it from the one before.
template <class State>
class Mailbox {
 public:
  struct Snapshot {
    std::optional<State> state;
    HostCounts counts;
    std::vector<StampedPose> heard;  // the oldest first
  };
  // State and counts together: whoever sees a packet counted also sees what it said.
  void put(const std::optional<State>& state, const std::vector<StampedPose>& heard, const HostCounts& counts) {
    {
      const std::lock_guard lock(mutex_);
      latest_.counts = counts;
      addHeard(heard);
      if (!state || (latest_.state && state->arrivedNs == latest_.state->arrivedNs)) return;
      latest_.state = state;
      isNew_ = true;
    }
    came_.notify_one();
  }
  Snapshot take() {
    const std::lock_guard lock(mutex_);
    isNew_ = false;
    Snapshot snapshot = latest_;
    latest_.heard.clear();
    return snapshot;
  }
  // Waits for a state that has not been taken; false after the time.
  bool await(int timeoutMs) {
    std::unique_lock lock(mutex_);
    return came_.wait_for(lock, std::chrono::milliseconds(timeoutMs), [this] { return isNew_; });
  }

 private:
  void addHeard(const std::vector<StampedPose>& heard) {
    auto& all = latest_.heard;
    all.insert(all.end(), heard.begin(), heard.end());
    if (all.size() > kMaxHeard) all.erase(all.begin(), all.end() - static_cast<std::ptrdiff_t>(kMaxHeard));
  }

  std::mutex mutex_;
  std::condition_variable came_;
  Snapshot latest_;
  bool isNew_ = false;
};

}  // namespace eye
