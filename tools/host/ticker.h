// The line that eyepoint-host prints each second. Owner thread: the sender's.
#pragma once

#include <string>

#include "link/cigi_host.h"
#include "link/sender.h"

namespace eye {

class Ticker {
 public:
  // `to`: where packets go, for the line that nobody listens there; `replies` may be null.
  Ticker(std::string to, const cigi::ReplyListener* replies) : to_(std::move(to)), replies_(replies) {}
  void operator()(const SendReport& report);

 private:
  std::string answers(double sinceS);

  std::string to_;
  const cigi::ReplyListener* replies_;
  uint64_t datagrams_ = 0, starts_ = 0;
  double elapsedS_ = 0;
};

}  // namespace eye
