// The mesh half of chunk_codec.h. docs/TILE_FORMAT.md has the layout byte by byte.
#include <numeric>

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "base/byte_reader.h"
#include "base/byte_writer.h"
#include "terrain/chunk_codec.h"
#include "terrain/compression.h"

namespace eye {
namespace {

constexpr uint16_t kMeshMagic = 0x4D45;  // "EM" in the file
constexpr uint8_t kMeshVersion = 2;
constexpr size_t kMaxVertices = 65535;  // of surface and skirts together: 16-bit indices reach them
// A triangulation of a disc has fewer than two triangles a vertex.
constexpr size_t kMaxIndices = kMaxVertices * 2 * 3;
constexpr size_t kClusterBytes = 18;

enum class Packing : uint8_t { plain = 0, zstd = 1 };

struct MeshHeader {
  Packing packing = Packing::plain;
  uint16_t vertexCount = 0;
  std::array<uint16_t, 4> boundary{};
  uint32_t indexCount = 0;
  uint32_t vertexStreamBytes = 0, indexStreamBytes = 0;  // unpacked
  uint16_t clusterCount = 0;
};

tl::unexpected<Error> damaged(const std::string& what) {
  return fail(ErrorKind::badData, "mesh blob: " + what);
}

void writeHeader(ByteWriter& out, const MeshHeader& header) {
  out.u16(kMeshMagic);
  out.u8(kMeshVersion);
  out.u8(static_cast<uint8_t>(header.packing));
  out.u16(header.vertexCount);
  for (const uint16_t count : header.boundary) out.u16(count);
  out.u32(header.indexCount);
  out.u32(header.vertexStreamBytes);
  out.u32(header.indexStreamBytes);
  out.u16(header.clusterCount);
}

Result<MeshHeader> readHeader(ByteReader& in, const TileKey& key) {
  if (in.u16() != kMeshMagic || !in.ok()) return damaged("not a mesh");
  const uint8_t version = in.u8();
  if (in.ok() && version != kMeshVersion) {
    return fail(ErrorKind::unsupported, fmt::format("mesh blob: version {} is not known to this build", version));
  }
  MeshHeader header;
  const uint8_t packing = in.u8();
  header.packing = static_cast<Packing>(packing);
  header.vertexCount = in.u16();
  for (uint16_t& count : header.boundary) count = in.u16();
  header.indexCount = in.u32();
  header.vertexStreamBytes = in.u32();
  header.indexStreamBytes = in.u32();
  header.clusterCount = in.u16();
  if (!in.ok()) return damaged("truncated");
  if (packing > static_cast<uint8_t>(Packing::zstd)) return damaged("unknown packing");

  // The rim of the skirts has as many vertices as the loop, and 16-bit indices must still reach it.
  const size_t loop = std::accumulate(header.boundary.begin(), header.boundary.end(), size_t{0});
  if (loop < 3 || loop > header.vertexCount || header.vertexCount + loop > kMaxVertices) {
    return damaged(fmt::format("{} vertices with a boundary of {}", header.vertexCount, loop));
  }
  const Side poleward = key.isSouthern() ? Side::south : Side::north;
  for (size_t i = 0; i < kSides.size(); ++i) {
    const bool isPoint = key.isPolar() && kSides[i] == poleward;
    if (isPoint != (header.boundary[i] == 0)) return damaged("the boundary's sides are not those of the tile");
  }
  if (header.indexCount < 3 || header.indexCount % 3 != 0 || header.indexCount > kMaxIndices) {
    return damaged(fmt::format("{} indices", header.indexCount));
  }
  if (header.vertexStreamBytes > meshopt_encodeVertexBufferBound(header.vertexCount, sizeof(ChunkVertex)) ||
      header.indexStreamBytes > meshopt_encodeIndexBufferBound(header.indexCount, header.vertexCount)) {
    return damaged("streams longer than their content can be");
  }
  if (header.clusterCount == 0 || header.clusterCount > header.indexCount / 3) {
    return damaged(fmt::format("{} clusters of {} triangles", header.clusterCount, header.indexCount / 3));
  }
  return header;
}

const unsigned char* bytePointer(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

std::vector<std::byte> clusterTable(const std::vector<ChunkCluster>& clusters) {
  ByteWriter out(std::endian::little);
  for (const ChunkCluster& cluster : clusters) {
    EYE_CHECK(cluster.indexCount % 3 == 0 && cluster.indexCount / 3 <= 65535);
    out.u16(static_cast<uint16_t>(cluster.indexCount / 3));
    for (const uint16_t q : cluster.boxMin) out.u16(q);
    for (const uint16_t q : cluster.boxMax) out.u16(q);
    for (const int8_t q : cluster.coneAxis) out.i8(q);
    out.i8(cluster.coneCutoff);
  }
  return out.take();
}

// Into mesh.clusters: runs that cover the index list, boxes that are not inside out, cones that are cones.
Result<void> readClusters(std::span<const std::byte> table, uint16_t count, ChunkMesh& mesh) {
  constexpr int kLongestAxis = 128;  // a unit of 127, and what rounding may add
  ByteReader in(table, std::endian::little);
  size_t covered = 0;
  mesh.clusters.resize(count);
  for (ChunkCluster& cluster : mesh.clusters) {
    cluster.firstIndex = static_cast<uint32_t>(covered);
    cluster.indexCount = uint32_t{3} * in.u16();
    covered += cluster.indexCount;
    for (uint16_t& q : cluster.boxMin) q = in.u16();
    for (uint16_t& q : cluster.boxMax) q = in.u16();
    int lengthSquared = 0;
    for (int8_t& q : cluster.coneAxis) {
      q = in.i8();
      lengthSquared += int{q} * int{q};
    }
    cluster.coneCutoff = in.i8();
    if (cluster.indexCount == 0 || covered > mesh.indices.size()) return damaged("the clusters are not its triangles'");
    for (size_t axis = 0; axis < 3; ++axis) {
      if (cluster.boxMin[axis] > cluster.boxMax[axis]) return damaged("a cluster's box is inside out");
    }
    if (cluster.coneCutoff < 0 || lengthSquared > kLongestAxis * kLongestAxis)
      return damaged("a cluster's cone is none");
  }
  if (covered != mesh.indices.size()) return damaged("the clusters are not its triangles'");
  return {};
}

}  // namespace

Blob encodeMesh(const ChunkMesh& mesh) {
  EYE_CHECK(mesh.vertices.size() <= kMaxVertices);
  EYE_CHECK(mesh.indices.size() % 3 == 0 && mesh.indices.size() <= kMaxIndices);
  const std::vector<unsigned int> indices(mesh.indices.begin(), mesh.indices.end());

  const size_t vertexBound = meshopt_encodeVertexBufferBound(mesh.vertices.size(), sizeof(ChunkVertex));
  const size_t indexBound = meshopt_encodeIndexBufferBound(indices.size(), mesh.vertices.size());
  std::vector<std::byte> streams(vertexBound + indexBound);
  unsigned char* const begin = reinterpret_cast<unsigned char*>(streams.data());
  const size_t vertexBytes =
      meshopt_encodeVertexBuffer(begin, vertexBound, mesh.vertices.data(), mesh.vertices.size(), sizeof(ChunkVertex));
  const size_t indexBytes = meshopt_encodeIndexBuffer(begin + vertexBytes, indexBound, indices.data(), indices.size());
  EYE_CHECK(vertexBytes > 0 && indexBytes > 0);  // the buffers have the size of the bounds
  streams.resize(vertexBytes + indexBytes);
  EYE_CHECK(mesh.clusters.size() <= 65535);
  const std::vector<std::byte> clusters = clusterTable(mesh.clusters);
  streams.insert(streams.end(), clusters.begin(), clusters.end());

  Blob packed = compress(streams);
  MeshHeader header;
  header.packing = packed.size() < streams.size() ? Packing::zstd : Packing::plain;
  header.vertexCount = static_cast<uint16_t>(mesh.vertices.size());
  header.boundary = mesh.boundary;
  header.indexCount = static_cast<uint32_t>(indices.size());
  header.vertexStreamBytes = static_cast<uint32_t>(vertexBytes);
  header.indexStreamBytes = static_cast<uint32_t>(indexBytes);
  header.clusterCount = static_cast<uint16_t>(mesh.clusters.size());
  ByteWriter out(std::endian::little);
  writeHeader(out, header);
  out.bytes(header.packing == Packing::zstd ? packed : streams);
  return out.take();
}

Result<ChunkMesh> decodeMesh(std::span<const std::byte> blob, const TileKey& key) {
  ByteReader in(blob, std::endian::little);
  const Result<MeshHeader> header = readHeader(in, key);
  if (!header) return tl::unexpected(header.error());
  const size_t streamBytes =
      size_t{header->vertexStreamBytes} + size_t{header->indexStreamBytes} + kClusterBytes * header->clusterCount;
  std::span<const std::byte> streams = in.bytes(in.remaining());
  std::vector<std::byte> unpacked;
  if (header->packing == Packing::zstd) {
    unpacked.resize(streamBytes);
    if (const Result<void> ok = decompress(streams, unpacked); !ok) return damaged(ok.error().message);
    streams = unpacked;
  }
  if (streams.size() != streamBytes) return damaged("its size is wrong");

  ChunkMesh mesh;
  mesh.boundary = header->boundary;
  mesh.vertices.resize(header->vertexCount);
  mesh.indices.resize(header->indexCount);
  const std::span<const std::byte> vertexStream = streams.first(header->vertexStreamBytes);
  const std::span<const std::byte> indexStream = streams.subspan(header->vertexStreamBytes, header->indexStreamBytes);
  if (meshopt_decodeVertexBuffer(mesh.vertices.data(), mesh.vertices.size(), sizeof(ChunkVertex),
                                 bytePointer(vertexStream), vertexStream.size()) != 0) {
    return damaged("the vertices cannot be decoded");
  }
  if (meshopt_decodeIndexBuffer(mesh.indices.data(), mesh.indices.size(), sizeof(uint16_t), bytePointer(indexStream),
                                indexStream.size()) != 0) {
    return damaged("the indices cannot be decoded");
  }
  for (const uint16_t index : mesh.indices) {
    if (index >= mesh.vertices.size()) return damaged("an index points at no vertex");
  }
  for (const ChunkVertex& vertex : mesh.vertices) {
    if (vertex.skirtSides != 0) return damaged("skirt vertices are stored");
  }
  const std::span<const std::byte> clusters = streams.last(kClusterBytes * header->clusterCount);
  if (const Result<void> ok = readClusters(clusters, header->clusterCount, mesh); !ok)
    return tl::unexpected(ok.error());
  return mesh;
}

}  // namespace eye
