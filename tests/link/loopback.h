// What the tests over real sockets on the loopback have in common.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "link/state_source.h"
#include "link/udp_socket.h"

namespace eye::test {

inline const std::atomic<bool> kNeverStop = false;

// A port that is free at this moment.
inline uint16_t freePort() {
  return UdpSocket::listenOn({kLoopbackAddress, 0})->port();
}

// Waits until the source has seen `packets`, for at most five seconds.
inline SourceSample waitFor(StateSource& source, uint64_t packets) {
  SourceSample sample = source.sample(0);
  for (int i = 0; i < 1000 && sample.counts.packets < packets; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    sample = source.sample(0);
  }
  return sample;
}

}  // namespace eye::test
