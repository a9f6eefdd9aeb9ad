#include "base/progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

namespace eye {

std::string progressBar(double share) {
  constexpr size_t kCells = 30;
  const auto full = static_cast<size_t>(std::clamp(share, 0.0, 1.0) * kCells);
  std::string cells(kCells, '.');
  std::fill_n(cells.begin(), full, '#');
  return fmt::format("[{}]", cells);
}

ProgressLine::ProgressLine() : terminal_(::isatty(STDERR_FILENO) == 1), begin_(Clock::now()), last_(begin_) {}

ProgressLine::~ProgressLine() {
  if (drawn_ && terminal_) std::fputc('\n', stderr);
}

bool ProgressLine::isDue() {
  const auto now = Clock::now();
  if (now - last_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10000))) return false;
  last_ = now;
  return true;
}

void ProgressLine::print(const std::string& text) {
  std::fprintf(stderr, terminal_ ? "\r%s\x1b[K" : "%s\n", text.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

double ProgressLine::elapsedS() const {
  return std::chrono::duration<double>(last_ - begin_).count();
}

}  // namespace eye
