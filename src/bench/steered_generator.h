// An image generator whose eye the benchmark puts where it likes. Owner thread: render.
#pragma once

#include <memory>

#include "app/image_generator.h"

namespace eye {

class SteeredGenerator {
 public:
  // Off-screen, every frame drawn and complete: what `options` say of sources, window and pace does not count.
  static Result<SteeredGenerator> create(Options options);
  Result<FrameRecord> frame(const Pose& pose);
  ImageGenerator& generator() { return *generator_; }

 private:
  SteeredGenerator() = default;

  std::shared_ptr<Pose> pose_;  // the source's
  std::unique_ptr<ImageGenerator> generator_;
};

}  // namespace eye
