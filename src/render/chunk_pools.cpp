#include "render/chunk_pools.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "terrain/chunk_codec.h"

namespace eye {
namespace {

// Share of the budget for imagery. A chunk of 400 triangles takes 9 KiB of mesh, a texture of 128 texels 85 KiB, and
// roughly one chunk in two has its own.
constexpr double kTextureShare = 0.7;
// A mesh has about twice as many triangles as vertices: 12 bytes of indices for each vertex of 16.
constexpr uint64_t kVertexParts = 4, kIndexParts = 3;
// A cluster has some 100 triangles, the smallest chunks fewer: one cluster for so many vertices is more than enough.
constexpr uint64_t kVerticesPerCluster = 24;
constexpr uint64_t kClusterBytes = sizeof(shader::ClusterRecord) + sizeof(uint32_t);  // with its visibility
// Less than this cannot hold the eight roots and one level below.
constexpr uint32_t kLeastLayers = 40, kLeastVertices = 40 * 1024;
// Uploads of some frames at the pager's usual 4 MiB.
constexpr uint64_t kStagingBytes = uint64_t{16} << 20;

uint64_t roundUp(uint64_t value, uint64_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

std::vector<GpuImage> createTextures(GpuDevices gpus, int textureSize, uint32_t layers) {
  ImageSpec spec;
  spec.widthPx = spec.heightPx = textureSize;
  // Not sRGB: decoding would cost 11 to 15 % of sampling on a CPU device, and light is mixed as displayed.
  spec.format = vk::Format::eR8G8B8A8Unorm;
  spec.usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst;
  spec.mipLevels = static_cast<uint32_t>(mipLevels(textureSize));
  spec.layers = layers;
  spec.array = true;
  return createImages(gpus, spec);
}

shader::ClusterRecord recordOf(const ChunkCluster& cluster, uint32_t chunkFirstIndex) {
  const auto pair = [](uint16_t low, uint16_t high) { return uint32_t{low} | uint32_t{high} << 16; };
  const auto byte = [](int8_t value, int place) { return uint32_t{static_cast<uint8_t>(value)} << (8 * place); };
  const auto& low = cluster.boxMin;
  const auto& high = cluster.boxMax;
  return {.firstIndex = chunkFirstIndex + cluster.firstIndex,
          .indexCount = cluster.indexCount,
          .boxMinXY = pair(low[0], low[1]),
          .boxMinZMaxX = pair(low[2], high[0]),
          .boxMaxYZ = pair(high[1], high[2]),
          .cone = byte(cluster.coneAxis[0], 0) | byte(cluster.coneAxis[1], 1) | byte(cluster.coneAxis[2], 2) |
                  byte(cluster.coneCutoff, 3)};
}

}  // namespace

std::optional<PoolPlan> planPools(uint64_t budgetBytes, uint64_t layerBytes, uint32_t maxLayers) {
  PoolPlan plan;
  const auto textureBytes = static_cast<uint64_t>(static_cast<double>(budgetBytes) * kTextureShare);
  plan.layers = static_cast<uint32_t>(std::min<uint64_t>(textureBytes / layerBytes, maxLayers));
  const uint64_t meshBytes = budgetBytes - std::min(budgetBytes, plan.layers * layerBytes);
  const uint64_t meshParts = kVertexParts + kIndexParts;
  // So many vertices and the cluster that is counted for them.
  constexpr uint64_t kBatchBytes = kVerticesPerCluster * sizeof(ChunkVertex) + kClusterBytes;
  // 2^31 indices of 2 bytes and 2^31 vertices are beyond any budget; the bound keeps 32-bit offsets safe.
  constexpr uint64_t kMost = uint64_t{1} << 31;
  plan.clusters =
      static_cast<uint32_t>(std::min(kMost / kVerticesPerCluster, meshBytes * kVertexParts / meshParts / kBatchBytes));
  plan.vertices = static_cast<uint32_t>(plan.clusters * kVerticesPerCluster);
  plan.indices = static_cast<uint32_t>(std::min(kMost, meshBytes * kIndexParts / meshParts / sizeof(uint16_t)));
  if (plan.layers < kLeastLayers || plan.vertices < kLeastVertices) return std::nullopt;
  return plan;
}

Result<std::unique_ptr<ChunkPools>> ChunkPools::create(GpuDevices gpus, uint64_t budgetBytes, int textureSize,
                                                       bool cullsOnHost) {
  const uint32_t maxLayers = gpus.front()->traits.mostTextureLayers;
  uint64_t layerBytes = mipChainBytes(textureSize);
  // What a layer takes on the device is known when the image is made: the second round keeps to it.
  for (int round = 0; round < 2; ++round) {
    const auto plan = planPools(budgetBytes, layerBytes, maxLayers);
    if (!plan) break;
    std::vector<GpuImage> textures = createTextures(gpus, textureSize, plan->layers);
    const uint64_t textureBytes = textures.front().bytes;
    const uint64_t meshBytes =
        plan->vertices * sizeof(ChunkVertex) + plan->indices * sizeof(uint16_t) + plan->clusters * kClusterBytes;
    if (textureBytes + meshBytes <= budgetBytes) {
      return std::unique_ptr<ChunkPools>(new ChunkPools(gpus, *plan, std::move(textures), textureSize, cullsOnHost));
    }
    layerBytes = textureBytes / plan->layers + 1;
  }
  const double leastMib = double(kLeastLayers * layerBytes) / kTextureShare / (1 << 20);
  return fail(
      ErrorKind::usage,
      fmt::format("a GPU budget of {} MiB is too small for textures of {} texels: give --cache-gpu at least {:.0f}",
                  budgetBytes >> 20, textureSize, leastMib + 1));
}

ChunkPools::ChunkPools(GpuDevices gpus, const PoolPlan& plan, std::vector<GpuImage> textures, int textureSize,
                       bool cullsOnHost)
    : gpu_(*gpus.front()),
      textureSize_(textureSize),
      chainBytes_(mipChainBytes(textureSize)),
      vertices_(plan.vertices),
      indices_(plan.indices),
      clusters_(plan.clusters),
      layers_(plan.layers),
      textures_(std::move(textures)) {
  using Use = vk::BufferUsageFlagBits;
  const MemoryUse cullUse = cullsOnHost ? MemoryUse::readBack : MemoryUse::device;
  vertexBuffers_ =
      createBuffers(gpus, plan.vertices * sizeof(ChunkVertex), Use::eVertexBuffer | Use::eTransferDst, cullUse);
  indexBuffers_ = createBuffers(gpus, plan.indices * sizeof(uint16_t), Use::eIndexBuffer | Use::eTransferDst, cullUse);
  clusterBuffer_ = createBuffer(gpu_, plan.clusters * sizeof(shader::ClusterRecord),
                                Use::eStorageBuffer | Use::eTransferDst | Use::eTransferSrc, cullUse);
  visibleBuffer_ =
      createBuffer(gpu_, plan.clusters * sizeof(uint32_t), Use::eStorageBuffer | Use::eTransferDst, cullUse);
  const uint64_t stagingBytes = std::max(kStagingBytes, 2 * chainBytes_ + (uint64_t{4} << 20));
  staging_ = createBuffer(gpu_, stagingBytes, Use::eTransferSrc, MemoryUse::upload);
  for (size_t i = 0; i < gpus.size(); ++i) {
    runOnce(*gpus[i], [&](const vk::raii::CommandBuffer& commands) {
      const Usage before = usageDiscarded(vk::PipelineStageFlagBits2::eNone);
      const std::array barriers{imageBarrier(textures_[i], before, usageSampled())};
      recordBarriers(commands, barriers);
    });
  }
}

// A place for all of the chunk or nothing.
std::optional<GpuChunk> ChunkPools::allocate(const LoadedChunk& chunk) {
  GpuChunk made;
  made.vertexCount = static_cast<uint32_t>(chunk.mesh.vertices.size());
  made.indexCount = static_cast<uint32_t>(chunk.mesh.indices.size());
  made.clusterCount = static_cast<uint32_t>(chunk.mesh.clusters.size());
  const bool wantsLayer = !chunk.texels.empty();
  const auto vertices = vertices_.allocate(made.vertexCount);
  const auto indices = indices_.allocate(made.indexCount);
  const auto clusters = clusters_.allocate(made.clusterCount);
  const auto layer = wantsLayer ? layers_.allocate(1) : std::nullopt;
  if (!vertices || !indices || !clusters || (wantsLayer && !layer)) {
    onlyLayersShort_ = vertices && indices && clusters;
    if (vertices) vertices_.release(*vertices, made.vertexCount);
    if (indices) indices_.release(*indices, made.indexCount);
    if (clusters) clusters_.release(*clusters, made.clusterCount);
    if (layer) layers_.release(*layer, 1);
    return std::nullopt;
  }
  made.vertexOffset = *vertices;
  made.firstIndex = *indices;
  made.clusterOffset = *clusters;
  if (layer) made.textureLayer = static_cast<int32_t>(*layer);
  return made;
}

void ChunkPools::giveBack(const GpuChunk& chunk) {
  vertices_.release(chunk.vertexOffset, chunk.vertexCount);
  indices_.release(chunk.firstIndex, chunk.indexCount);
  clusters_.release(chunk.clusterOffset, chunk.clusterCount);
  if (chunk.textureLayer >= 0) layers_.release(static_cast<uint32_t>(chunk.textureLayer), 1);
}

bool ChunkPools::hasRoomFor(std::span<const LoadedChunk> chunks) {
  std::vector<GpuChunk> tried;
  for (const LoadedChunk& chunk : chunks) {
    const std::optional<GpuChunk> place = allocate(chunk);
    if (!place) break;
    tried.push_back(*place);
  }
  for (const GpuChunk& place : tried) giveBack(place);
  return tried.size() == chunks.size();
}

std::optional<GpuChunk> ChunkPools::upload(const LoadedChunk& chunk) {
  EYE_CHECK(!chunk.mesh.vertices.empty() && !chunk.mesh.indices.empty() && !chunk.mesh.clusters.empty() &&
            (chunk.texels.empty() || chunk.texels.size() == chainBytes_));
  const size_t vertexBytes = chunk.mesh.vertices.size() * sizeof(ChunkVertex);
  const size_t indexBytes = chunk.mesh.indices.size() * sizeof(uint16_t);
  const size_t clusterBytes = chunk.mesh.clusters.size() * sizeof(shader::ClusterRecord);
  const uint64_t bytes =
      roundUp(vertexBytes, 16) + roundUp(indexBytes, 16) + roundUp(clusterBytes, 16) + roundUp(chunk.texels.size(), 16);
  if (bytes > staging_.size) return std::nullopt;
  const std::optional<GpuChunk> made = allocate(chunk);
  if (!made) return std::nullopt;
  if (stagedBytes_ + bytes > staging_.size) flush();

  vertexCopies_.push_back(
      {stage(chunk.mesh.vertices.data(), vertexBytes), made->vertexOffset * sizeof(ChunkVertex), vertexBytes});
  indexCopies_.push_back(
      {stage(chunk.mesh.indices.data(), indexBytes), made->firstIndex * sizeof(uint16_t), indexBytes});
  putClusters(chunk.mesh.clusters, *made);
  if (made->textureLayer < 0) return made;

  const auto layer = static_cast<uint32_t>(made->textureLayer);
  uint64_t offset = stage(chunk.texels.data(), chunk.texels.size());
  for (uint32_t mip = 0; mip < textures_.front().spec.mipLevels; ++mip) {
    const uint32_t side = std::max(1u, static_cast<uint32_t>(textureSize_) >> mip);
    textureCopies_.push_back({offset, 0, 0, {vk::ImageAspectFlagBits::eColor, mip, layer, 1}, {}, {side, side, 1}});
    offset += uint64_t{4} * side * side;
  }
  return made;
}

void ChunkPools::release(const GpuChunk& chunk) {
  // Its place may be given away at once, and two copies to one place in the same commands have no order.
  if (isPending(chunk)) flush();
  giveBack(chunk);
}

uint64_t ChunkPools::bytesResident() const {
  const uint64_t layerBytes = textures_.front().bytes / layers_.capacity();
  return vertices_.used() * sizeof(ChunkVertex) + indices_.used() * sizeof(uint16_t) +
         clusters_.used() * kClusterBytes + layers_.used() * layerBytes;
}

bool ChunkPools::isPending(const GpuChunk& chunk) const {
  const uint64_t place = chunk.vertexOffset * sizeof(ChunkVertex);
  return std::any_of(vertexCopies_.begin(), vertexCopies_.end(),
                     [place](const vk::BufferCopy& copy) { return copy.dstOffset == place; });
}

void ChunkPools::putClusters(std::span<const ChunkCluster> clusters, const GpuChunk& made) {
  records_.clear();
  for (const ChunkCluster& cluster : clusters) records_.push_back(recordOf(cluster, made.firstIndex));
  if (clusterBuffer_.mapped != nullptr) {
    std::ranges::copy(records_, clusterBuffer_.as<shader::ClusterRecord>().begin() + made.clusterOffset);
    // The last owner's visibility is not the new one's.
    std::ranges::fill(visibleBuffer_.as<uint32_t>().subspan(made.clusterOffset, made.clusterCount), 0u);
    return;
  }
  constexpr uint64_t kRecordBytes = sizeof(shader::ClusterRecord);
  const size_t bytes = records_.size() * kRecordBytes;
  clusterCopies_.push_back({stage(records_.data(), bytes), made.clusterOffset * kRecordBytes, bytes});
}

uint64_t ChunkPools::stage(const void* data, size_t bytes) {
  const uint64_t offset = stagedBytes_;
  std::memcpy(staging_.mapped + offset, data, bytes);
  stagedBytes_ = roundUp(offset + bytes, 16);  // texture copies start at whole texels
  return offset;
}

void ChunkPools::flush() {
  if (vertexCopies_.empty()) return;
  runOnce(gpu_, [this](const vk::raii::CommandBuffer& commands) { recordUploads(commands); });
  staged();
}

void ChunkPools::recordUploads(const vk::raii::CommandBuffer& commands) {
  if (vertexCopies_.empty()) return;
  commands.copyBuffer(*staging_.buffer, *vertexBuffers_.front().buffer, vertexCopies_);
  commands.copyBuffer(*staging_.buffer, *indexBuffers_.front().buffer, indexCopies_);
  if (!clusterCopies_.empty()) commands.copyBuffer(*staging_.buffer, *clusterBuffer_.buffer, clusterCopies_);
  for (const vk::BufferCopy& copy : clusterCopies_) {
    constexpr vk::DeviceSize kRecord = sizeof(shader::ClusterRecord);
    commands.fillBuffer(*visibleBuffer_.buffer, copy.dstOffset / kRecord * sizeof(uint32_t),
                        copy.size / kRecord * sizeof(uint32_t), 0);
  }
  recordMemoryBarrier(commands, vk::PipelineStageFlagBits2::eTransfer, vk::AccessFlagBits2::eTransferWrite,
                      vk::PipelineStageFlagBits2::eVertexInput | vk::PipelineStageFlagBits2::eComputeShader,
                      vk::AccessFlagBits2::eVertexAttributeRead | vk::AccessFlagBits2::eIndexRead |
                          vk::AccessFlagBits2::eShaderStorageRead | vk::AccessFlagBits2::eShaderStorageWrite);
  if (!textureCopies_.empty()) {
    const GpuImage& textures = textures_.front();
    std::vector<vk::ImageMemoryBarrier2> before, after;
    for (const vk::BufferImageCopy& copy : textureCopies_) {
      if (copy.imageSubresource.mipLevel != 0) continue;
      const vk::ImageSubresourceRange layer(vk::ImageAspectFlagBits::eColor, 0, VK_REMAINING_MIP_LEVELS,
                                            copy.imageSubresource.baseArrayLayer, 1);
      // The texture that lay there is not wanted any more.
      before.push_back(
          imageBarrier(textures, usageDiscarded(vk::PipelineStageFlagBits2::eFragmentShader), usageCopyTarget()));
      before.back().setSubresourceRange(layer);
      after.push_back(imageBarrier(textures, usageCopyTarget(), usageSampled()));
      after.back().setSubresourceRange(layer);
    }
    recordBarriers(commands, before);
    commands.copyBufferToImage(*staging_.buffer, *textures.image, vk::ImageLayout::eTransferDstOptimal, textureCopies_);
    recordBarriers(commands, after);
  }
  vertexCopies_.clear();
  indexCopies_.clear();
  clusterCopies_.clear();
  textureCopies_.clear();
}

void ChunkPools::staged() {
  stagedBytes_ = 0;
}

}  // namespace eye
