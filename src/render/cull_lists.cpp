#include "render/cull_lists.h"

#include <algorithm>
#include <bit>

#include "shared/cull.h"

namespace eye {
namespace {

using Use = vk::BufferUsageFlagBits;

// More than a view of mountains takes at 1 pixel.
constexpr size_t kFirstChunks = 1024, kFirstCandidates = 16384, kFirstIndices = size_t{1} << 20;

size_t clustersOf(std::span<const ChunkDraw> draws) {
  size_t count = 0;
  for (const ChunkDraw& draw : draws) count += draw.gpu.clusterCount;
  return count;
}

size_t indicesOf(std::span<const ChunkDraw> draws) {
  size_t count = 0;
  for (const ChunkDraw& draw : draws) count += draw.gpu.indexCount;
  return count;
}

// Makes a buffer for at least `count` elements where there is none so large.
bool grow(const GpuDevice& gpu, size_t count, size_t elementBytes, vk::BufferUsageFlags usage, MemoryUse use,
          size_t& capacity, GpuBuffer& buffer) {
  if (count <= capacity) return false;
  capacity = std::bit_ceil(count);
  buffer = createBuffer(gpu, capacity * elementBytes, usage, use);
  return true;
}

}  // namespace

CullLists::CullLists(GpuDevices gpus, bool onHost) : onHost_(onHost), perDevice_(gpus.size()) {
  params_ = createBuffer(*gpus.front(), sizeof(shader::CullParams), Use::eStorageBuffer, MemoryUse::upload);
  params_.as<shader::CullParams>()[0] = {};
  reserve(gpus, {}, {1, 1}, {1, 1});
  writePixelSpans({1, 1}, {1, 1});  // the warm-up reads them
}

bool CullLists::fits(const GpuDevice& gpu, std::span<const ChunkDraw> draws, glm::ivec2 picturePx, glm::ivec2 mapPx) {
  const DeviceTraits& traits = gpu.traits;
  const size_t candidates = clustersOf(draws);
  const size_t pixels = static_cast<size_t>(picturePx.x) * static_cast<size_t>(picturePx.y);
  const size_t texels = std::bit_ceil(std::max(pixels, pyramidLayout(mapPx).texels));
  return texels * sizeof(float) <= traits.mostStorageBytes &&
         std::bit_ceil(candidates) * sizeof(shader::DrawCommand) <= traits.mostStorageBytes &&
         candidates <= size_t{traits.mostWorkGroups} * EYE_CULL_GROUP;
}

bool CullLists::reserve(GpuDevices gpus, std::span<const ChunkDraw> draws, glm::ivec2 picturePx, glm::ivec2 mapPx) {
  const GpuDevice& gpu = *gpus.front();
  bool made = grow(gpu, std::max(draws.size(), kFirstChunks), sizeof(shader::CullChunk), Use::eStorageBuffer,
                   MemoryUse::upload, chunkCapacity_, chunks_);
  const size_t candidates = std::max(clustersOf(draws), kFirstCandidates);
  if (candidates > candidateCapacity_) {
    made = true;
    candidateCapacity_ = std::bit_ceil(candidates);
    const auto make = [&](const GpuDevice& on, size_t elementBytes, vk::BufferUsageFlags usage, MemoryUse use) {
      return createBuffer(on, candidateCapacity_ * elementBytes, Use::eStorageBuffer | usage, use);
    };
    candidates_ = make(gpu, sizeof(shader::CullCandidate), {}, MemoryUse::upload);
    const MemoryUse commands = onHost_ ? MemoryUse::upload : MemoryUse::device;
    for (size_t i = 0; i < gpus.size(); ++i)
      for (GpuBuffer* buffer : {&perDevice_[i].early, &perDevice_[i].late})
        *buffer = make(*gpus[i], sizeof(shader::DrawCommand), Use::eIndirectBuffer | Use::eTransferSrc, commands);
    fates_ = make(gpu, sizeof(uint32_t), {}, MemoryUse::readBack);
  }
  const auto pixels = static_cast<size_t>(picturePx.x) * static_cast<size_t>(picturePx.y);
  if (pixels > depthCapacity_) {
    made = true;
    depthCapacity_ = std::bit_ceil(pixels);
    depth_ =
        createBuffers(gpus, depthCapacity_ * sizeof(float), Use::eStorageBuffer | Use::eTransferDst | Use::eTransferSrc,
                      onHost_ ? MemoryUse::readBack : MemoryUse::device);
  }
  made |= grow(gpu, pyramidLayout(mapPx).texels, sizeof(float), Use::eStorageBuffer | Use::eTransferSrc,
               onHost_ ? MemoryUse::upload : MemoryUse::device, pyramidCapacity_, pyramid_);
  const auto sides = static_cast<size_t>(mapPx.x) + static_cast<size_t>(mapPx.y);
  if (grow(gpu, sides, sizeof(glm::ivec2), Use::eStorageBuffer, MemoryUse::upload, spansCapacity_, pixelSpans_)) {
    made = true;
    spansMapPx_ = {0, 0};
  }
  // No cluster is drawn twice.
  const size_t indices = std::max(indicesOf(draws), kFirstIndices);
  if (onHost_ && indices > packedCapacity_) {
    packedCapacity_ = std::bit_ceil(indices);
    for (size_t i = 0; i < gpus.size(); ++i)
      perDevice_[i].packed =
          createBuffer(*gpus[i], packedCapacity_ * sizeof(uint16_t), Use::eIndexBuffer, MemoryUse::upload);
  }
  return made;
}

void CullLists::writePixelSpans(glm::ivec2 picturePx, glm::ivec2 mapPx) {
  if (mapPx == spansMapPx_ && picturePx == spansPicturePx_) return;
  const auto spans = pixelSpans_.as<glm::ivec2>();
  size_t next = 0;
  for (int x = 0; x < mapPx.x; ++x) spans[next++] = shader::pixelSpan(x, mapPx.x, picturePx.x);
  for (int y = 0; y < mapPx.y; ++y) spans[next++] = shader::pixelSpan(y, mapPx.y, picturePx.y);
  longestSpanPx_ = 0;
  for (const glm::ivec2& span : spans.first(next)) longestSpanPx_ = std::max(longestSpanPx_, span.y - span.x + 1);
  spansMapPx_ = mapPx;
  spansPicturePx_ = picturePx;
}

void CullLists::write(std::span<const ChunkDraw> draws, size_t byVertex, const View& view,
                      const glm::mat4& clipFromEcef, glm::ivec2 mapPx, bool frozen) {
  const auto chunks = chunks_.as<shader::CullChunk>();
  const auto candidates = candidates_.as<shader::CullCandidate>();
  uint32_t count = 0;
  frames_.clear();
  for (uint32_t i = 0; i < draws.size(); ++i) {
    const ChunkDraw& draw = draws[i];
    if (i == byVertex) candidatesByVertex_ = count;
    chunks[i] = {.centre_ecef = glm::vec3(draw.box.centreEcefM - view.eyeEcefM),
                 .vertexOffset = static_cast<int32_t>(draw.gpu.vertexOffset),
                 .axisX_ecef = glm::vec3(draw.box.halfAxesEcefM[0]),
                 .draw = i,
                 .axisY_ecef = glm::vec3(draw.box.halfAxesEcefM[1]),
                 .unused0 = 0,
                 .axisZ_ecef = glm::vec3(draw.box.halfAxesEcefM[2]),
                 .unused1 = 0};
    if (onHost_)
      frames_.push_back(
          {ecefFromLattice(draw.originLattice, draw.stepM) - view.eyeEcefM, draw.stepM, draw.gpu.vertexCount});
    for (uint32_t k = 0; k < draw.gpu.clusterCount; ++k) candidates[count++] = {draw.gpu.clusterOffset + k, i};
  }
  candidateCount_ = count;
  if (byVertex == draws.size()) candidatesByVertex_ = count;
  chunkCount_ = static_cast<uint32_t>(draws.size());

  writePixelSpans({view.widthPx, view.heightPx}, mapPx);
  const PyramidLayout layout = pyramidLayout(mapPx);
  const auto row = [&](int r) { return glm::vec3(clipFromEcef[0][r], clipFromEcef[1][r], clipFromEcef[2][r]); };
  shader::CullParams& params = params_.as<shader::CullParams>()[0];
  params.clipX_ecef = row(0);
  params.clipY_ecef = row(1);
  params.clipW_ecef = row(3);
  params.nearM = static_cast<float>(view.frustum.nearM);
  params.picturePx = {view.widthPx, view.heightPx};
  params.mapPx = mapPx;
  params.candidateCount = count;
  params.isFrozen = frozen ? 1 : 0;
  params.levelCount = layout.levels;
  std::copy(layout.offset.begin(), layout.offset.end(), params.levelOffset);
}

std::vector<BandDraws> CullLists::bandDraws(GpuBuffer PerDevice::*commands) const {
  std::vector<BandDraws> bands;
  for (const PerDevice& device : perDevice_)
    bands.push_back({(device.*commands).as<shader::DrawCommand>(), device.packed.as<uint16_t>()});
  return bands;
}

HostCull CullLists::hostCull(const ChunkPools& pools, std::span<const BandDraws> bands, const BandTest& bandTest) {
  visibleTriangles_.resize(pools.clusterCapacity());
  return {.params = params(),
          .chunks = chunks_.as<const shader::CullChunk>().first(chunkCount_),
          .candidates = candidates_.as<const shader::CullCandidate>().first(candidateCount_),
          .clusters = pools.clusterBuffer().as<const shader::ClusterRecord>(),
          .visible = pools.visibleBuffer().as<uint32_t>(),
          .indices = pools.indexBuffer().as<const uint16_t>(),
          .vertices = pools.vertexBuffer().as<const ChunkVertex>(),
          .frames = frames_,
          .visibleTriangles = visibleTriangles_,
          .fates = fates_.as<uint32_t>(),
          .bands = bands,
          .bandTest = bandTest};
}

void CullLists::cullEarly(const ChunkPools& pools, const BandTest& bandTest) {
  triangles_ = {};
  earlyIndices_ = eye::cullEarly(hostCull(pools, bandDraws(&PerDevice::early), bandTest), triangles_);
}

void CullLists::cullLate(const ChunkPools& pools, const BandTest& bandTest, bool atCentres) {
  const auto pyramid = pyramid_.as<float>();
  hostPyramid_.build(depth_.front().as<const float>(), params().picturePx, params().mapPx, pyramid);
  TriangleCull triangles(params(), depth_.front().as<const float>(), atCentres);
  eye::cullLate(hostCull(pools, bandDraws(&PerDevice::late), bandTest), pyramid, triangles, earlyIndices_, triangles_);
}

CullCounts CullLists::counts() const {
  CullCounts counts;
  counts.considered = candidateCount_;
  for (const uint32_t fate : fates_.as<const uint32_t>().first(candidateCount_)) {
    const uint32_t triangles = fate >> EYE_FATE_BITS, why = fate & EYE_FATE_WHY;
    const bool drawn = (fate & (EYE_FATE_EARLY | EYE_FATE_LATE)) != 0;
    counts.drawn += drawn;
    if (drawn) counts.trianglesDrawn += triangles;
    if (drawn) continue;
    counts.outside += why == EYE_FATE_OUTSIDE;
    counts.backFacing += why == EYE_FATE_BACK_FACING;
    counts.occluded += why == EYE_FATE_OCCLUDED;
    if (why == EYE_FATE_OCCLUDED) counts.trianglesSpared += triangles;
  }
  if (onHost_) {
    counts.trianglesDrawn = triangles_.drawn;
    counts.trianglesSpared += triangles_.spared;
  }
  return counts;
}

}  // namespace eye
