#include "progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

namespace eye {

namespace {

std::string bar(double share) {
  constexpr size_t kCells = 30;
  const auto full = static_cast<size_t>(std::clamp(share, 0.0, 1.0) * kCells);
  std::string cells(kCells, '.');
  std::fill_n(cells.begin(), full, '#');
  return fmt::format("[{}]", cells);
}

}  // namespace

ProgressPrinter::ProgressPrinter() : terminal_(::isatty(STDERR_FILENO) == 1), begin_(Clock::now()), last_(begin_) {}

ProgressPrinter::~ProgressPrinter() {
  if (drawn_ && terminal_) std::fputc('\n', stderr);
}

bool ProgressPrinter::isDue() {
  const auto now = Clock::now();
  if (now - last_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10000))) return false;
  last_ = now;
  return true;
}

void ProgressPrinter::print(const std::string& line) {
  std::fprintf(stderr, terminal_ ? "\r%s\x1b[K" : "%s\n", line.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressPrinter::show(const BakeProgress& progress) {
  if (!isDue()) return;
  const double seconds = std::chrono::duration<double>(last_ - begin_).count();
  const double share = progress.estimate > 0 ? double(progress.tiles) / double(progress.estimate) : 0;
  print(fmt::format("{} level {}, {} of about {} tiles, {:.0f} tiles/s, {:.1f} MB", bar(share), progress.level,
                    progress.tiles, progress.estimate, double(progress.baked) / seconds, double(progress.bytes) / 1e6));
}

void ProgressPrinter::showShare(const char* what, uint64_t done, uint64_t total) {
  if (!isDue()) return;
  print(fmt::format("{} {} {} of {} tiles", bar(total > 0 ? double(done) / double(total) : 1), what, done, total));
}

}  // namespace eye
