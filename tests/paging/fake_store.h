// A renderer for the paging tests: hands out places and counts bytes.
#pragma once

#include <catch2/catch.hpp>
#include <map>

#include "paging/terrain_cache.h"

namespace eye {

// Stands in for the renderer: counts bytes against a budget that it never exceeds.
class FakeStore final : public GpuStore {
 public:
  explicit FakeStore(uint64_t budgetBytes) : budgetBytes_(budgetBytes) {}
  std::optional<GpuChunk> upload(const LoadedChunk& chunk) override {
    REQUIRE(chunk.mesh.indices.size() > chunk.surfaceIndexCount);  // skirts are behind
    REQUIRE(chunk.texels.empty() == !chunk.meta.hasImagery);
    if (bytes_ + chunk.bytes() > budgetBytes_) return std::nullopt;
    GpuChunk handle;
    handle.vertexOffset = next_++;
    live_[handle.vertexOffset] = chunk.bytes();
    bytes_ += chunk.bytes();
    ++uploads;
    return handle;
  }
  void release(const GpuChunk& chunk) override {
    const auto found = live_.find(chunk.vertexOffset);
    REQUIRE(found != live_.end());
    bytes_ -= found->second;
    live_.erase(found);
  }
  uint64_t bytesResident() const override { return bytes_; }
  size_t live() const { return live_.size(); }
  uint64_t uploads = 0;

 private:
  const uint64_t budgetBytes_;
  uint64_t bytes_ = 0;
  uint32_t next_ = 0;
  std::map<uint32_t, uint64_t> live_;
};

}  // namespace eye
