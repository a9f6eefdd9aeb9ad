// An image generator that a host on the loopback feeds, and what it showed. Owner thread: render.
#pragma once

#include <memory>
#include <vector>

#include "app/image_generator.h"
#include "bench/host_traffic.h"

namespace eye {

struct ShownFrame {
  int64_t beganNs = 0, endedNs = 0;  // on monotonicNs()
  double frameMs = 0;
  Pose told, eye;  // as the host said it, as it was drawn
  HostCounts counts;
};

class LiveShow {
 public:
  // Off-screen, every frame drawn. The port is one that was free.
  static Result<LiveShow> create(HostProtocol protocol, Options options);
  // Frames at their display's rate, those that come late without a wait, for so long.
  Result<std::vector<ShownFrame>> show(double durationS);
  uint16_t port() const { return port_; }
  const std::string& device() const { return generator_->renderer().device().name; }

 private:
  LiveShow() = default;

  uint16_t port_ = 0;
  std::unique_ptr<ImageGenerator> generator_;
};

}  // namespace eye
