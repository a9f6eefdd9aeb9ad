#include "paging/chunk_loader.h"

#include <fmt/format.h>

#include <numeric>

#include "telemetry/trace.h"
#include "terrain/chunk_codec.h"
#include "terrain/extent.h"

namespace eye {
namespace {

constexpr size_t kMaxVertices = 65535;  // what 16-bit indices reach, the skirts' rim included

Error damaged(const DatabaseReader& reader, const TileKey& key, const std::string& what) {
  return Error{ErrorKind::badData,
               fmt::format("{}: {} ({:#x}): {}; bake it again", reader.path(), key.name(), key.code(), what)};
}

}  // namespace

size_t ChunkGroup::bytes() const {
  size_t sum = sizeof(ChunkGroup);
  for (const LoadedChunk& chunk : chunks) sum += chunk.bytes();
  return sum;
}

Result<LoadedChunk> loadChunk(const DatabaseReader& reader, const TileKey& key, LoadCost* cost) {
  const int64_t beganNs = monotonicNs();
  const uint64_t readBefore = reader.bytesRead();
  Result<StoredChunk> stored = reader.read(key);
  const int64_t readNs = monotonicNs();
  if (!stored) return tl::unexpected(stored.error());
  if (stored->meta.key != key) return tl::unexpected(damaged(reader, key, "holds another tile"));

  LoadedChunk loaded;
  loaded.meta = stored->meta;
  Result<ChunkMesh> mesh = decodeMesh(stored->mesh, key);
  if (!mesh) return tl::unexpected(damaged(reader, key, mesh.error().message));
  const size_t loop = std::accumulate(mesh->boundary.begin(), mesh->boundary.end(), size_t{0});
  if (loop > mesh->vertices.size() || mesh->vertices.size() + loop > kMaxVertices)
    return tl::unexpected(damaged(reader, key, "too many vertices for skirts"));
  loaded.mesh = std::move(*mesh);
  loaded.surfaceIndexCount = static_cast<uint32_t>(loaded.mesh.indices.size());
  loaded.longestEdgeM = longestEdgeM(loaded.mesh, loaded.meta.stepM());
  loaded.skirts = appendSkirts(loaded.mesh);

  if (loaded.meta.hasImagery) {
    Result<std::vector<uint8_t>> texels = decodeImagery(stored->imagery, reader.info().textureSize);
    if (!texels) return tl::unexpected(damaged(reader, key, texels.error().message));
    loaded.texels = std::move(*texels);
  }
  if (cost != nullptr) {
    cost->readS += static_cast<double>(readNs - beganNs) * 1e-9;
    cost->decodeS += static_cast<double>(monotonicNs() - readNs) * 1e-9;
    cost->fileBytes += reader.bytesRead() - readBefore;
    cost->decodedBytes += loaded.bytes();
  }
  return loaded;
}

Result<ChunkGroup> loadGroup(const DatabaseReader& reader, const TileKey& parent, LoadCost* cost) {
  const TraceScope trace("load group");
  ChunkGroup group;
  group.parent = parent;
  for (const TileKey& key : parent.children()) {
    Result<LoadedChunk> chunk = loadChunk(reader, key, cost);
    if (!chunk) return tl::unexpected(chunk.error());
    group.chunks.push_back(std::move(*chunk));
  }
  return group;
}

}  // namespace eye
