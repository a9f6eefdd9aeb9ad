// The mailbox through which what hosts say reaches the frame.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "geo/pose.h"

namespace eye {

struct HostCounts {
  uint64_t packets = 0;   // datagrams received, good and bad
  uint64_t rejected = 0;  // wrong size, version, sender, NaN, out of range
  uint64_t lost = 0;      // gaps in the protocol's own numbering, where it has one
};

// A latest-value mailbox: one writer (the link thread), one reader (the frame). A state has `arrivedNs`, which tells it
// from the one before.
template <class State>
class Mailbox {
 public:
  struct Snapshot {
    std::optional<State> state;
    HostCounts counts;
  };
  // State and counts together: whoever sees a packet counted also sees what it said.
  void put(const std::optional<State>& state, const HostCounts& counts) {
    {
      const std::lock_guard lock(mutex_);
      latest_.counts = counts;
      if (!state || (latest_.state && state->arrivedNs == latest_.state->arrivedNs)) return;
      latest_.state = state;
      isNew_ = true;
    }
    came_.notify_one();
  }
  Snapshot take() {
    const std::lock_guard lock(mutex_);
    isNew_ = false;
    return latest_;
  }
  // Waits for a state that has not been taken; false after the time.
  bool await(int timeoutMs) {
    std::unique_lock lock(mutex_);
    return came_.wait_for(lock, std::chrono::milliseconds(timeoutMs), [this] { return isNew_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  Snapshot latest_;
  bool isNew_ = false;
};

}  // namespace eye
