// A synchronous host of several channels: the next frame when all of them have shown the last one.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "link/cigi_host.h"

namespace eye::cigi {

inline constexpr double kResendS = 0.25;  // without an answer a frame is sent again: a datagram was lost, or one begins
inline constexpr int kResends = 4;        // and then what has not answered is given up until it is heard again

// The numbers begin at 1. Owner thread: the sender's.
class Lockstep {
 public:
  // `messageOf` has nothing at the end.
  using MessageOf = std::function<std::optional<std::vector<std::byte>>(uint32_t frame, double timeS)>;
  Lockstep(ReplyListener& replies, size_t channels, MessageOf messageOf)
      : replies_(replies), channels_(channels), messageOf_(std::move(messageOf)) {}

  // For a DemandedSource with a patience of kResendS.
  std::optional<std::vector<std::byte>> packetAt(double timeS, bool demanded);
  bool await(int timeoutMs) { return replies_.awaitChannels(frame_, timeoutMs); }

 private:
  ReplyListener& replies_;
  const size_t channels_;
  const MessageOf messageOf_;
  uint32_t frame_ = 0;
  int resent_ = 0;
  std::optional<std::vector<std::byte>> last_;
};

}  // namespace eye::cigi
