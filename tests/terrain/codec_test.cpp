// Blobs: what goes in comes out, and no bytes at all harm the decoders.
#include <algorithm>
#include <chrono>
#include <random>

#include <catch2/catch.hpp>

#include "synthetic_chunk.h"
#include "terrain/chunk_codec.h"

namespace eye {
namespace {

// A triangle as a set: the index codec may begin it at another of its vertices, but keeps their order.
std::array<uint16_t, 3> rotated(const uint16_t* triangle) {
  std::array<uint16_t, 3> t{triangle[0], triangle[1], triangle[2]};
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::vector<std::array<uint16_t, 3>> triangles(const ChunkMesh& mesh) {
  std::vector<std::array<uint16_t, 3>> all;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) all.push_back(rotated(&mesh.indices[i]));
  return all;
}

// Flips, overwrites, cuts and lengthens; often near the beginning, where the headers are.
Blob mutated(Blob blob, std::mt19937& random) {
  const auto place = [&] {
    return random() % 3 == 0 ? random() % std::min<size_t>(40, blob.size()) : random() % blob.size();
  };
  for (unsigned changes = 1 + random() % 4; changes > 0 && !blob.empty(); --changes) {
    switch (random() % 5) {
      case 0:
        blob[place()] ^= static_cast<std::byte>(1u << (random() % 8));
        break;
      case 1:
        blob[place()] = static_cast<std::byte>(random());
        break;
      case 2:
        blob.resize(random() % blob.size());
        break;
      case 3:
        blob.insert(blob.end(), random() % 16, static_cast<std::byte>(random()));
        break;
      default:
        blob[place()] = random() % 2 == 0 ? std::byte{0} : std::byte{255};
    }
  }
  return blob;
}

const TileKey kOrdinary = TileKey::fromGrid(7, 0, 12, 3);
const TileKey kNorthPole = TileKey::fromGrid(5, 1, 31, 0);
const TileKey kSouthPole = TileKey::fromGrid(5, 6, 31, 0);

// What a chunk must hold to be drawn with skirts, whatever its blob said.
void requireDrawable(ChunkMesh mesh) {
  for (const uint16_t index : mesh.indices) REQUIRE(index < mesh.vertices.size());
  REQUIRE(mesh.indices.size() % 3 == 0);
  size_t covered = 0;
  for (const ChunkCluster& cluster : mesh.clusters) {
    REQUIRE(cluster.firstIndex == covered);
    REQUIRE((cluster.indexCount > 0 && cluster.indexCount % 3 == 0));
    for (size_t axis = 0; axis < 3; ++axis) REQUIRE(cluster.boxMin[axis] <= cluster.boxMax[axis]);
    covered += cluster.indexCount;
  }
  REQUIRE(covered == mesh.indices.size());
  appendSkirts(mesh);  // aborts where the loop or the number of vertices is too large
  for (const uint16_t index : mesh.indices) REQUIRE(index < mesh.vertices.size());
}

}  // namespace

TEST_CASE("A mesh comes back vertex by vertex and triangle by triangle") {
  for (const TileKey& key : {kOrdinary, kNorthPole, kSouthPole, TileKey::octantRoot(3)}) {
    for (const int edges : {1, 7, 60}) {
      const ChunkMesh mesh = syntheticMesh(key, edges).mesh;
      const Blob blob = encodeMesh(mesh);
      const Result<ChunkMesh> decoded = decodeMesh(blob, key);
      REQUIRE(decoded);
      CHECK(decoded->vertices == mesh.vertices);
      CHECK(decoded->boundary == mesh.boundary);
      CHECK(triangles(*decoded) == triangles(mesh));
      CHECK(decoded->clusters == mesh.clusters);
      CHECK(encodeMesh(mesh) == blob);  // the same bytes every time
    }
  }
}

TEST_CASE("A mesh that no renderer could draw is refused") {
  const ChunkMesh mesh = syntheticMesh(kOrdinary, 4).mesh;
  const auto refused = [](const ChunkMesh& bad, const char* why) {
    const Result<ChunkMesh> decoded = decodeMesh(encodeMesh(bad), kOrdinary);
    REQUIRE_FALSE(decoded);
    CHECK(decoded.error().kind == ErrorKind::badData);
    CHECK_THAT(decoded.error().message, Catch::Contains(why));
  };
  ChunkMesh bad = mesh;
  bad.indices[5] = static_cast<uint16_t>(mesh.vertices.size());
  refused(bad, "an index points at no vertex");
  bad = mesh;
  bad.boundary[2] = 200;
  refused(bad, "with a boundary of");
  bad = mesh;
  bad.boundary[1] = 0;
  refused(bad, "sides");
  bad = mesh;
  bad.vertices[9].skirtSides = 1;
  refused(bad, "skirt vertices");
  bad = mesh;
  bad.indices.clear();
  refused(bad, "0 indices");
  bad = mesh;
  bad.clusters.clear();
  refused(bad, "0 clusters");
  bad = mesh;
  bad.clusters.resize(mesh.indices.size() / 3 + 1, mesh.clusters[0]);
  refused(bad, "clusters of");
  bad = mesh;
  bad.clusters[0].indexCount -= 3;
  refused(bad, "not its triangles'");
  bad = mesh;
  bad.clusters[0].indexCount += 3;
  refused(bad, "not its triangles'");
  bad = mesh;
  bad.clusters.push_back({});  // of no triangles
  refused(bad, "not its triangles'");
  bad = mesh;
  std::swap(bad.clusters[0].boxMin[1], bad.clusters[0].boxMax[1]);
  refused(bad, "inside out");
  bad = mesh;
  bad.clusters[0].coneCutoff = -1;
  refused(bad, "cone");
  bad = mesh;
  bad.clusters[0].coneAxis = {100, 100, 100};
  refused(bad, "cone");
  CHECK_FALSE(decodeMesh(encodeMesh(mesh), kNorthPole));  // of another kind of tile
  CHECK_FALSE(decodeMesh({}, kOrdinary));

  Blob newer = encodeMesh(mesh);
  newer[2] = std::byte{3};
  const Result<ChunkMesh> decoded = decodeMesh(newer, kOrdinary);
  REQUIRE_FALSE(decoded);
  CHECK(decoded.error().kind == ErrorKind::unsupported);
}

TEST_CASE("So many vertices that their skirts' rim would pass 16 bits are refused") {
  ChunkMesh mesh = syntheticMesh(kOrdinary, 4).mesh;
  mesh.vertices.resize(65530);
  CHECK_FALSE(decodeMesh(encodeMesh(mesh), kOrdinary));
  mesh.vertices.resize(65535 - 16);
  const Result<ChunkMesh> decoded = decodeMesh(encodeMesh(mesh), kOrdinary);
  REQUIRE(decoded);
  requireDrawable(*decoded);
}

TEST_CASE("Imagery comes back to the bit, with mips that are the averages of four") {
  for (const int size : {16, 128, 256}) {
    std::vector<uint8_t> noise(static_cast<size_t>(size * size * 3));
    std::mt19937 random(7);
    for (uint8_t& byte : noise) byte = static_cast<uint8_t>(random());
    const std::vector<uint8_t> flat(noise.size(), 200);
    for (const auto& rgb : {syntheticPicture(size, 1), noise, flat}) {
      const Blob blob = encodeImagery(rgb, size);
      CHECK(encodeImagery(rgb, size) == blob);
      const auto chain = decodeImagery(blob, size);
      REQUIRE(chain);
      REQUIRE(chain->size() == mipChainBytes(size));
      bool same = true;
      for (size_t i = 0; i < rgb.size() / 3; ++i) {
        for (size_t c = 0; c < 3; ++c) same = same && (*chain)[4 * i + c] == rgb[3 * i + c];
        same = same && (*chain)[4 * i + 3] == 255;
      }
      CHECK(same);

      size_t fine = 0, levels = 1;
      for (size_t width = static_cast<size_t>(size); width > 1; width /= 2, ++levels) {
        const size_t coarse = fine + 4 * width * width;
        for (size_t j = 0; j < width / 2; ++j) {
          for (size_t i = 0; i < width / 2; ++i) {
            for (size_t c = 0; c < 4; ++c) {
              const auto texel = [&](size_t x, size_t y) { return int{(*chain)[fine + 4 * (y * width + x) + c]}; };
              const int sum =
                  texel(2 * i, 2 * j) + texel(2 * i + 1, 2 * j) + texel(2 * i, 2 * j + 1) + texel(2 * i + 1, 2 * j + 1);
              same = same && (*chain)[coarse + 4 * (j * width / 2 + i) + c] == (sum + 2) / 4;
            }
          }
        }
        fine = coarse;
      }
      CHECK(same);
      CHECK(static_cast<int>(levels) == mipLevels(size));
    }
    CHECK_FALSE(decodeImagery(encodeImagery(flat, size), size * 2));
  }
}

TEST_CASE("No mutation of a blob harms its decoder") {
  std::mt19937 random(20240607);
  std::vector<std::pair<TileKey, Blob>> meshes;
  for (const TileKey& key : {kOrdinary, kNorthPole, kSouthPole}) {
    meshes.emplace_back(key, encodeMesh(syntheticMesh(key, 1).mesh));   // stored plain
    meshes.emplace_back(key, encodeMesh(syntheticMesh(key, 20).mesh));  // stored with zstd
  }
  int accepted = 0;
  for (int i = 0; i < 10'000; ++i) {
    const auto& [key, blob] = meshes[random() % meshes.size()];
    const Result<ChunkMesh> decoded = decodeMesh(mutated(blob, random), key);
    if (!decoded) continue;
    ++accepted;
    requireDrawable(*decoded);
  }
  CHECK(accepted < 5000);

  const Blob pictures[] = {encodeImagery(syntheticPicture(32, 1), 32),
                           encodeImagery(std::vector<uint8_t>(32 * 32 * 3, 9), 32)};
  for (int i = 0; i < 10'000; ++i) {
    const auto chain = decodeImagery(mutated(pictures[random() % 2], random), 32);
    if (chain) REQUIRE(chain->size() == mipChainBytes(32));
  }
}

TEST_CASE("Whatever a cluster table says, its runs are those of the triangles or it is refused") {
  std::mt19937 random(20260101);
  const ChunkMesh mesh = syntheticMesh(kOrdinary, 10).mesh;  // four clusters
  REQUIRE(mesh.clusters.size() == 4);
  int accepted = 0;
  constexpr int kRounds = 4000;
  for (int i = 0; i < kRounds; ++i) {
    ChunkMesh bad = mesh;
    for (auto changes = 1 + random() % 3; changes > 0 && !bad.clusters.empty(); --changes) {
      ChunkCluster& cluster = bad.clusters[random() % bad.clusters.size()];
      const auto any16 = static_cast<uint16_t>(random());
      const auto any8 = static_cast<int8_t>(random());
      switch (random() % 7) {
        case 0:
          cluster.indexCount = 3 * uint32_t{any16};
          break;
        case 1:
          cluster.indexCount = 3 * static_cast<uint32_t>(random() % 100);
          break;
        case 2:
          cluster.boxMin[random() % 3] = any16;
          break;
        case 3:
          cluster.boxMax[random() % 3] = any16;
          break;
        case 4:
          cluster.coneAxis[random() % 3] = any8;
          break;
        case 5:
          cluster.coneCutoff = any8;
          break;
        default:
          bad.clusters.resize(random() % 400, cluster);
      }
    }
    const Result<ChunkMesh> decoded = decodeMesh(encodeMesh(bad), kOrdinary);
    if (!decoded) continue;
    ++accepted;
    requireDrawable(*decoded);
  }
  CHECK(accepted > kRounds / 20);  // a box or cone that is another is still one
  CHECK(accepted < kRounds / 2);
}

TEST_CASE("Decoding keeps the paging thread's pace") {
  using Clock = std::chrono::steady_clock;
  constexpr int kRounds = 20;
  const Blob picture = encodeImagery(syntheticPicture(128, 3), 128);
  const ChunkMesh mesh = syntheticMesh(kOrdinary, 14).mesh;  // 392 triangles: an ordinary chunk's
  const Blob blob = encodeMesh(mesh);
  double pictureMs = 1e9, meshMs = 1e9;
  for (int i = 0; i < kRounds; ++i) {
    const auto begin = Clock::now();
    REQUIRE(decodeImagery(picture, 128));
    const auto middle = Clock::now();
    REQUIRE(decodeMesh(blob, kOrdinary));
    const auto end = Clock::now();
    pictureMs = std::min(pictureMs, std::chrono::duration<double, std::milli>(middle - begin).count());
    meshMs = std::min(meshMs, std::chrono::duration<double, std::milli>(end - middle).count());
  }
  INFO("128 x 128 imagery with mips: " << pictureMs << " ms, " << picture.size() << " bytes; mesh of "
                                       << mesh.indices.size() / 3 << " triangles: " << meshMs << " ms, " << blob.size()
                                       << " bytes");
#ifdef NDEBUG
  CHECK(pictureMs < 1.0);  // 0.12 ms on a core; the rest is room for what else runs
  CHECK(meshMs < 0.5);
#endif
}

}  // namespace eye
