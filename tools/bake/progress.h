// How far a bake is, on stderr: a bar that redraws itself on a terminal, else a line every ten seconds.
#pragma once

#include <chrono>

#include "bake/baker.h"

namespace eye {

class ProgressPrinter {
 public:
  ProgressPrinter();
  ~ProgressPrinter();  // ends the bar's line
  void show(const BakeProgress& progress);
  void showShare(const char* what, uint64_t done, uint64_t total);

 private:
  using Clock = std::chrono::steady_clock;
  bool isDue();
  void print(const std::string& line);

  const bool terminal_;
  const Clock::time_point begin_;
  Clock::time_point last_;
  bool drawn_ = false;
};

}  // namespace eye
