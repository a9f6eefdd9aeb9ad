// Places in pools: allocation, the budget, uploads and releases that follow one another.
#include <catch2/catch.hpp>

#include <random>

#include "render/chunk_pools.h"
#include "render/scene.h"
#include "terrain/chunk_codec.h"

using namespace eye;
using namespace eye::test;

namespace {

constexpr int kWidth = 160, kHeight = 120;

HeightFunction level(double heightM) {
  return [heightM](double, double) { return heightM; };
}

}  // namespace

TEST_CASE("ranges never overlap and come back whole") {
  RangeAllocator allocator(1000);
  std::mt19937 random(3);
  std::vector<std::pair<uint32_t, uint32_t>> held;
  std::vector<int> owner(1000, -1);
  for (int i = 0; i < 20000; ++i) {
    if (random() % 2 == 0 || held.empty()) {
      const auto count = static_cast<uint32_t>(1 + random() % 90);
      const auto offset = allocator.allocate(count);
      if (!offset) continue;
      REQUIRE(*offset + count <= 1000);
      for (uint32_t k = *offset; k < *offset + count; ++k) {
        if (owner[k] != -1) FAIL("overlap at " << k);
        owner[k] = i;
      }
      held.emplace_back(*offset, count);
    } else {
      const size_t at = random() % held.size();
      const auto [offset, count] = held[at];
      std::fill_n(owner.begin() + offset, count, -1);
      allocator.release(offset, count);
      held.erase(held.begin() + static_cast<std::ptrdiff_t>(at));
    }
    uint32_t sum = 0;
    for (const auto& range : held) sum += range.second;
    if (sum != allocator.used()) FAIL("used() is " << allocator.used() << ", held " << sum);
  }
  for (const auto& [offset, count] : held) allocator.release(offset, count);
  CHECK(allocator.used() == 0);
  CHECK(allocator.allocate(1000) == std::optional<uint32_t>(0));  // one free range again
  CHECK_FALSE(allocator.allocate(1).has_value());
}

TEST_CASE("a budget is split and kept") {
  const uint64_t layerBytes = mipChainBytes(128);
  for (const uint64_t mib : {8u, 16u, 64u, 256u, 1024u}) {
    const auto plan = planPools(mib << 20, layerBytes, 2048);
    REQUIRE(plan.has_value());
    CHECK(plan->layers <= 2048);
    CHECK(plan->layers * layerBytes + plan->vertices * 16ull + plan->indices * 2ull <= mib << 20);
    CHECK(plan->layers * layerBytes + plan->vertices * 16ull + plan->indices * 2ull + plan->clusters * 28ull >
          (mib << 20) * 98 / 100);
  }
  CHECK_FALSE(planPools(uint64_t{1} << 20, layerBytes, 2048).has_value());
}

TEST_CASE("a budget too small is an error that names a sufficient one") {
  RendererOptions options;
  options.gpuBudgetBytes = uint64_t{1} << 20;
  const auto made = Renderer::create(options);
  REQUIRE_FALSE(made.has_value());
  if (made.error().kind == ErrorKind::notFound) return;  // no Vulkan device here
  CHECK(made.error().kind == ErrorKind::usage);
  CHECK(made.error().message.find("--cache-gpu") != std::string::npos);
}

TEST_CASE("upload stops at the budget and goes on after a release") {
  RendererOptions options;
  options.widthPx = kWidth;
  options.heightPx = kHeight;
  options.validate = true;
  options.gpuBudgetBytes = uint64_t{8} << 20;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  CHECK(renderer->bytesResident() == 0);
  const MadeChunk red = makeChunk({49, 20, 49.02, 20.03}, level(500), flatTexture(128, 200, 20, 20));
  const MadeChunk green = makeChunk({49, 20, 49.02, 20.03}, level(500), flatTexture(128, 20, 200, 20));
  std::vector<GpuChunk> held;
  while (const auto gpu = renderer->upload(red.loaded)) {
    held.push_back(*gpu);
    REQUIRE(renderer->bytesResident() <= options.gpuBudgetBytes);
    REQUIRE(held.size() < 1000);
  }
  CHECK(held.size() >= 40);
  const uint64_t full = renderer->bytesResident();
  CHECK_FALSE(renderer->upload(red.loaded).has_value());
  CHECK(renderer->bytesResident() == full);  // what a refused upload had taken is given back

  // Released before it was ever drawn, and its place given away at once: the later upload is what shows.
  renderer->release(held.back());
  const ChunkDraw draw = addChunk(*renderer, green);
  CHECK(draw.gpu.textureLayer == held.back().textureLayer);
  FrameInput input = lookFrom({{49.01, 20.015, 800}, 0, -90, 0}, kWidth, kHeight);
  input.draws = {&draw, 1};
  const auto frame = renderer->drawFrame(input);
  REQUIRE(frame.has_value());
  CHECK(frame->rgba[1] > 2 * frame->rgba[0]);
  CHECK(renderer->validationMessages() == 0);
  held.back() = draw.gpu;
  for (GpuChunk gpu : held) {
    gpu.indexCount = static_cast<uint32_t>(green.loaded.mesh.indices.size());  // a draw's is the surface's alone
    renderer->release(gpu);
  }
  CHECK(renderer->bytesResident() == 0);
}

TEST_CASE("a mesh pool that is full gives a refused chunk's texture back") {
  RendererOptions options;
  options.widthPx = kWidth;
  options.heightPx = kHeight;
  options.gpuBudgetBytes = uint64_t{8} << 20;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  const MadeChunk bare = makeChunk({49, 20, 49.02, 20.03, 40}, level(500), {});
  const MadeChunk textured = makeChunk({49, 20, 49.02, 20.03, 40}, level(500), flatTexture(128, 20, 200, 20));
  int held = 0;
  while (renderer->upload(bare.loaded)) REQUIRE(++held < 10000);
  const uint64_t full = renderer->bytesResident();
  CHECK(held > 10);
  CHECK_FALSE(renderer->upload(textured.loaded).has_value());
  CHECK(renderer->bytesResident() == full);
}
