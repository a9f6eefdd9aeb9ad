// The thread named "ground": answers a host's questions about the ground in their order, so that reading terrain from
// disk keeps neither packets nor frames waiting.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "link/cigi_replies.h"
#include "link/ground_probe.h"

namespace eye::cigi {

class GroundDesk {
 public:
  // The replies must live longer. The thread begins with the first question; without `openProbe`, and where it fails,
  // every answer is "not valid".
  GroundDesk(Replies& replies, OpenProbe openProbe, std::string name);
  ~GroundDesk();
  // Link thread. What is too much to be answered in time is dropped, and said so once.
  void ask(std::vector<GroundQuestion> questions);
  // Link thread: nothing that was asked before is answered any more. Another host's answers would be taken for its own.
  void forget();

 private:
  void run(const std::stop_token& stop);

  Replies& replies_;
  const OpenProbe openProbe_;
  const std::string name_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<GroundQuestion> waiting_;
  uint64_t asker_ = 0;     // counts hosts
  bool saidFull_ = false;  // the link thread's
  std::jthread thread_;
};

}  // namespace eye::cigi
