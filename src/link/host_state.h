// The mailbox through which what hosts say reaches the frame.
#pragma once

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

// A latest-value mailbox: one writer (the link thread), one reader (the frame).
template <class State>
class Mailbox {
 public:
  struct Snapshot {
    std::optional<State> state;
    HostCounts counts;
  };
  // State and counts together: whoever sees a packet counted also sees what it said.
  void put(const std::optional<State>& state, const HostCounts& counts) {
    const std::lock_guard lock(mutex_);
    if (state) latest_.state = state;
    latest_.counts = counts;
  }
  Snapshot take() const {
    const std::lock_guard lock(mutex_);
    return latest_;
  }

 private:
  mutable std::mutex mutex_;
  Snapshot latest_;
};

}  // namespace eye
