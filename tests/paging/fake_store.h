// A renderer for the paging tests: hands out places and counts bytes.
#pragma once

#include <catch2/catch.hpp>
#include <map>

#include "paging/terrain_cache.h"

namespace eye {

// Stands in for the renderer: counts bytes against a budget that it never exceeds.
class FakeStore final : public GpuStore {
 public:
  // `layers`: chunks with imagery that there is room for.
  explicit FakeStore(uint64_t budgetBytes, uint64_t layers = 1 << 20) : budgetBytes_(budgetBytes), layers_(layers) {}
  bool hasRoomFor(std::span<const LoadedChunk> chunks) override {
    uint64_t bytes = bytes_, layers = layersUsed_;
    for (const LoadedChunk& chunk : chunks) {
      bytes += chunk.bytes();
      layers += chunk.meta.hasImagery;
    }
    onlyLayersShort_ = bytes <= budgetBytes_;
    return bytes <= budgetBytes_ && layers <= layers_;
  }
  bool wouldHelp(const GpuChunk& chunk) const override { return !onlyLayersShort_ || chunk.textureLayer >= 0; }
  std::optional<GpuChunk> upload(const LoadedChunk& chunk) override {
    REQUIRE(chunk.mesh.indices.size() > chunk.surfaceIndexCount);  // skirts are behind
    REQUIRE(chunk.texels.empty() == !chunk.meta.hasImagery);
    if (bytes_ + chunk.bytes() > budgetBytes_ || layersUsed_ + chunk.meta.hasImagery > layers_) return std::nullopt;
    GpuChunk handle;
    handle.vertexOffset = next_++;
    live_[handle.vertexOffset] = chunk.bytes();
    bytes_ += chunk.bytes();
    if (chunk.meta.hasImagery) handle.textureLayer = 0;
    layersUsed_ += chunk.meta.hasImagery;
    ++uploads;
    return handle;
  }
  void release(const GpuChunk& chunk) override {
    const auto found = live_.find(chunk.vertexOffset);
    REQUIRE(found != live_.end());
    bytes_ -= found->second;
    layersUsed_ -= chunk.textureLayer >= 0;
    live_.erase(found);
  }
  uint64_t bytesResident() const override { return bytes_; }
  size_t live() const { return live_.size(); }
  uint64_t uploads = 0;

 private:
  const uint64_t budgetBytes_, layers_;
  uint64_t layersUsed_ = 0;
  bool onlyLayersShort_ = false;
  uint64_t bytes_ = 0;
  uint32_t next_ = 0;
  std::map<uint32_t, uint64_t> live_;
};

}  // namespace eye
