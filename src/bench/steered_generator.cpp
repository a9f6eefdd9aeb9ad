#include "bench/steered_generator.h"

namespace eye {
namespace {

class SteeredSource final : public StateSource {
 public:
  explicit SteeredSource(std::shared_ptr<const Pose> pose) : pose_(std::move(pose)) {}
  SourceSample sample(double) override {
    SourceSample sample;
    sample.pose = *pose_;
    sample.valid = true;
    return sample;
  }
  bool isLive() const override { return false; }
  bool isFixed() const override { return false; }

 private:
  std::shared_ptr<const Pose> pose_;
};

}  // namespace

Result<SteeredGenerator> SteeredGenerator::create(Options options, bool offline) {
  options.headless = true;
  options.offline = offline;
  options.redrawAlways = true;
  SteeredGenerator made;
  made.pose_ = std::make_shared<Pose>();
  auto generator = ImageGenerator::create(options, std::make_unique<SteeredSource>(made.pose_));
  if (!generator) return tl::unexpected(generator.error());
  made.generator_ = std::move(*generator);
  return made;
}

Result<FrameRecord> SteeredGenerator::frame(const Pose& pose, double timeS, bool reads) {
  *pose_ = pose;
  return generator_->frame(timeS, reads, reads);
}

}  // namespace eye
