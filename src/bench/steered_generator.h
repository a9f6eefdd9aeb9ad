// An image generator whose eye the benchmark puts where it likes. Owner thread: render.
#pragma once

#include <memory>

#include "app/image_generator.h"

namespace eye {

class SteeredGenerator {
 public:
  // Off-screen, every frame drawn: what `options` say of sources, window and pace does not count. `offline`: every
  // frame is complete; else terrain comes when it comes, as in a live run.
  static Result<SteeredGenerator> create(Options options, bool offline = true);
  // `timeS`: the frame's clock; it never goes back. `reads`: picture and depth can be had from the generator.
  Result<FrameRecord> frame(const Pose& pose, double timeS = 0, bool reads = false);
  ImageGenerator& generator() { return *generator_; }

 private:
  SteeredGenerator() = default;

  std::shared_ptr<Pose> pose_;  // the source's
  std::unique_ptr<ImageGenerator> generator_;
};

}  // namespace eye
