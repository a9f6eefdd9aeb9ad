#include "gpu/timestamps.h"

namespace eye {

Timestamps::Timestamps(const GpuDevice& gpu) {
  const uint32_t bits = gpu.traits.timestampBits;
  if (bits == 0) return;
  msPerTick_ = gpu.traits.msPerTick;
  mask_ = bits >= 64 ? ~uint64_t{0} : (uint64_t{1} << bits) - 1;
  pool_ = vk::raii::QueryPool(gpu.device, vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, kMaxMarks + 1));
}

void Timestamps::begin(const vk::raii::CommandBuffer& commands) {
  names_.clear();
  if (mask_ == 0) return;
  commands.resetQueryPool(*pool_, 0, kMaxMarks + 1);
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_, 0);
}

void Timestamps::mark(const vk::raii::CommandBuffer& commands, const char* name) {
  if (mask_ == 0) return;
  EYE_CHECK(names_.size() < kMaxMarks);
  names_.push_back(name);
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_, static_cast<uint32_t>(names_.size()));
}

const std::vector<Timestamps::Span>& Timestamps::read() {
  spans_.clear();
  if (names_.empty()) return spans_;
  const size_t count = names_.size() + 1;
  const auto [result, ticks] = pool_.getResults<uint64_t>(0, static_cast<uint32_t>(count), count * sizeof(uint64_t),
                                                          sizeof(uint64_t), vk::QueryResultFlagBits::e64);
  if (result != vk::Result::eSuccess) return spans_;
  const auto sinceBegin = [&](size_t i) { return double((ticks[i] - ticks[0]) & mask_) * msPerTick_; };
  beginMs_ = double(ticks[0] & mask_) * msPerTick_;
  for (size_t i = 0; i < names_.size(); ++i)
    if (names_[i] != nullptr) spans_.push_back({names_[i], sinceBegin(i), sinceBegin(i + 1)});
  return spans_;
}

}  // namespace eye
