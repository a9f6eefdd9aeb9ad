// What the host suite sends to an image generator on the loopback: numbered poses at a host's rate, floods, a bad link.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "geo/pose.h"
#include "link/bad_link.h"
#include "link/udp_socket.h"

namespace eye {

enum class HostProtocol { nativeFdm, cigi33, cigi40 };
const char* nameOf(HostProtocol protocol);
std::string urlOf(HostProtocol protocol, uint16_t port);
std::vector<std::byte> messageOf(HostProtocol protocol, const Pose& pose, uint32_t number, double timeS);

inline constexpr double kHostRateHz = 60;

// Slow flight over a place, a millimetre higher with each number, by which a pose is known again.
class NumberedPoses {
 public:
  explicit NumberedPoses(const Geodetic& start) : start_(start) {}
  Pose at(uint32_t number) const;
  uint32_t numberOf(const Pose& pose) const;

 private:
  Geodetic start_;
};

// Sends poses 0, 1, 2, ... at kHostRateHz from construction to destruction, each stamped as it leaves.
class SteadyHost {
 public:
  SteadyHost(HostProtocol protocol, uint16_t port, const NumberedPoses& poses);
  // When the pose of the number left, on monotonicNs(); 0 before it has.
  int64_t sentNs(uint32_t number) const;
  int64_t startedNs() const { return startedNs_; }  // when pose 0 was due

 private:
  void run(const std::stop_token& stop, HostProtocol protocol, uint16_t port);

  const NumberedPoses poses_;
  const int64_t startedNs_;
  mutable std::mutex mutex_;
  std::vector<int64_t> sentNs_;
  std::jthread thread_;  // last: it uses the others
};

// Sends `rateHz` datagrams a second, in bursts of a millisecond, from construction to destruction.
class Flood {
 public:
  using Next = std::function<std::span<const std::byte>(uint64_t index, double timeS)>;
  Flood(uint16_t port, double rateHz, Next next);
  double sentHz() const;                            // so far
  int64_t startedNs() const { return startedNs_; }  // when second 0 was

 private:
  void run(const std::stop_token& stop, uint16_t port, double rateHz, const Next& next);

  const int64_t startedNs_;
  std::atomic<uint64_t> sent_ = 0;
  std::jthread thread_;  // last: it uses the others
};

// Datagrams that no protocol believes, the same for the same protocol: noise of any length, and the protocol's own
// messages with bytes turned to noise; some of each behind one another, as a flood sends them.
std::vector<std::vector<std::byte>> garbage(HostProtocol protocol);

// Sends a flight once at kHostRateHz over a bad link, from construction on; ends early on destruction.
class FlightOverBadLink {
 public:
  FlightOverBadLink(HostProtocol protocol, uint16_t port, std::function<Pose(double timeS)> poseAt, double durationS,
                    const BadLinkOptions& link);
  ~FlightOverBadLink();
  int64_t startedNs() const { return startedNs_; }

 private:
  std::atomic<bool> stop_ = false;
  const int64_t startedNs_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace eye
