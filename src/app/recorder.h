// --record and --frames-dir: every frame to ffmpeg's standard input, or as a numbered PNG, on a thread of its own.
// Owner thread of the interface: render.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "base/error.h"

namespace eye {

struct RecorderOptions {
  std::string film;    // an .mp4 (or whatever ffmpeg makes of the name); empty: none
  std::string folder;  // for PNGs, made where it is missing; empty: none
  int widthPx = 0, heightPx = 0;
  double rateHz = 60;
};

class Recorder {
 public:
  // unsupported where ffmpeg is not installed.
  static Result<std::unique_ptr<Recorder>> create(const RecorderOptions& options);
  ~Recorder();
  // Copies the frame of the flight's clock `timeS`; waits where the writer is more than a few frames behind, so that no
  // frame is lost and memory is bounded. A film shows it again where frames came slower than the film's rate, so that
  // the film is as long as the flight. A failure of an earlier frame shows here.
  Result<void> add(std::span<const uint8_t> rgba, int widthPx, int heightPx, double timeS);
  Result<void> finish();

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace eye
