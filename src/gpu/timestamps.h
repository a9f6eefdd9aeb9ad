// Times of the passes of one frame, measured by the GPU.
#pragma once

#include "gpu/device.h"

namespace eye {

// Use: begin, then mark after each pass, then (when the frame's fence has signalled) read.
class Timestamps {
 public:
  static constexpr uint32_t kMaxMarks = 16;
  explicit Timestamps(const GpuDevice& gpu);

  void begin(const vk::raii::CommandBuffer& commands);
  // `name`, a literal, is the pass that ends here.
  void mark(const vk::raii::CommandBuffer& commands, const char* name);
  // What lies between the last mark and here is no pass's: the device has waited for others.
  void skip(const vk::raii::CommandBuffer& commands) { mark(commands, nullptr); }

  struct Span {
    const char* name;
    double beginMs, endMs;  // since begin
  };
  // Empty where the queue has no timestamps.
  const std::vector<Span>& read();
  const std::vector<Span>& spans() const { return spans_; }  // that have been read
  double beginMs() const { return beginMs_; }                // of what has been read, by the device's clock

 private:
  double msPerTick_ = 0, beginMs_ = 0;
  uint64_t mask_ = 0;
  vk::raii::QueryPool pool_{nullptr};
  std::vector<const char*> names_;
  std::vector<Span> spans_;
};

}  // namespace eye
