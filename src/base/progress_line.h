// How far something is, on stderr: a line that redraws itself on a terminal, else a line every ten seconds.
#pragma once

#include <chrono>
#include <string>

namespace eye {

std::string progressBar(double share);  // 0 to 1, clamped

class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();  // ends the line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool isDue();  // true: print something now
  void print(const std::string& text);
  double elapsedS() const;  // from the start to when a line was last due

 private:
  using Clock = std::chrono::steady_clock;
  const bool terminal_;
  const Clock::time_point begin_;
  Clock::time_point last_;
  bool drawn_ = false;
};

}  // namespace eye
