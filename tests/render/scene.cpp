#include "render/scene.h"

#include <catch2/catch.hpp>

#include "terrain/chunk_codec.h"
#include "terrain/clusters.h"
#include "terrain/extent.h"

namespace eye::test {
namespace {

constexpr int kTextureSize = 128;

uint32_t hash(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

// Index of grid point (i, j): the loop's points first, then the inner ones.
uint16_t gridIndex(int i, int j, int n) {
  if (j == 0) return static_cast<uint16_t>(i);
  if (i == n) return static_cast<uint16_t>(n + j);
  if (j == n) return static_cast<uint16_t>(3 * n - i);
  if (i == 0) return static_cast<uint16_t>(4 * n - j);
  return static_cast<uint16_t>(4 * n + (j - 1) * (n - 1) + (i - 1));
}

void addMips(std::vector<uint8_t>& chain, int size) {
  size_t above = 0;
  for (int side = size / 2; side >= 1; side /= 2) {
    const auto wide = static_cast<size_t>(side) * 2;
    const size_t level = chain.size();
    for (size_t y = 0; y < wide / 2; ++y) {
      for (size_t x = 0; x < wide / 2; ++x) {
        for (size_t c = 0; c < 4; ++c) {
          const auto at = [&](size_t dx, size_t dy) {
            return unsigned{chain[above + 4 * ((2 * y + dy) * wide + 2 * x + dx) + c]};
          };
          chain.push_back(static_cast<uint8_t>((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1) + 2) / 4));
        }
      }
    }
    above = level;
  }
}

// Along the axes east, north and up, a millimetre wider than the vertices.
OrientedBox boxAround(const ChunkMesh& mesh, const LatticePoint& origin, double stepM, const Mat3d& axes) {
  const Vec3d originM = ecefFromLattice(origin, stepM);
  Vec3d low(1e9), high(-1e9);
  for (const ChunkVertex& v : mesh.vertices) {
    const Vec3d enu = (Vec3d(v.x, v.y, v.z) * stepM) * axes;
    low = glm::min(low, enu);
    high = glm::max(high, enu);
  }
  OrientedBox box;
  box.centreEcefM = originM + axes * ((low + high) / 2.0);
  for (int i = 0; i < 3; ++i) box.halfAxesEcefM[static_cast<size_t>(i)] = axes[i] * ((high - low)[i] / 2.0 + 1e-3);
  return box;
}

}  // namespace

MadeChunk makeChunk(const Patch& patch, const HeightFunction& heightM, std::vector<uint8_t> texels) {
  MadeChunk made;
  const int n = patch.quads;
  const auto at = [&](int i, int j) {
    const double lat = patch.southDeg + (patch.northDeg - patch.southDeg) * j / n;
    const double lon = patch.westDeg + (patch.eastDeg - patch.westDeg) * i / n;
    return ecefFromGeodetic({lat, lon, heightM(lat, lon)});
  };
  const double midLat = (patch.southDeg + patch.northDeg) / 2, midLon = (patch.westDeg + patch.eastDeg) / 2;
  made.centreEcefM = ecefFromGeodetic({midLat, midLon, heightM(midLat, midLon)});
  made.origin = LatticePoint(glm::round(made.centreEcefM / patch.stepM));
  ChunkMesh& mesh = made.loaded.mesh;
  mesh.vertices.resize(static_cast<size_t>(n + 1) * static_cast<size_t>(n + 1));
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const glm::i64vec3 p = LatticePoint(glm::round(at(i, j) / patch.stepM)) - made.origin;
      REQUIRE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 32768);
      const Vec3d normal = glm::normalize(glm::cross(at(i + 1, j) - at(i - 1, j), at(i, j + 1) - at(i, j - 1)));
      const glm::vec2 octahedral = octahedralFromNormal(glm::vec3(normal));
      mesh.vertices[gridIndex(i, j, n)] = {static_cast<int16_t>(p.x),
                                           static_cast<int16_t>(p.y),
                                           static_cast<int16_t>(p.z),
                                           0,
                                           static_cast<uint16_t>(65535 * i / n),
                                           static_cast<uint16_t>(65535 * j / n),
                                           static_cast<int16_t>(octahedral.x * 32767),
                                           static_cast<int16_t>(octahedral.y * 32767)};
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const uint16_t a = gridIndex(i, j, n), b = gridIndex(i + 1, j, n), c = gridIndex(i + 1, j + 1, n),
                     d = gridIndex(i, j + 1, n);
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  }
  const auto side = static_cast<uint16_t>(n);
  mesh.boundary = {side, side, side, side};
  made.loaded.meta.box = boxAround(mesh, made.origin, patch.stepM, ecefFromEnu(midLat, midLon));
  made.loaded.meta.originLattice = made.origin;
  buildClusters({made.loaded.meta.box, made.origin, patch.stepM}, mesh);
  made.loaded.surfaceIndexCount = static_cast<uint32_t>(mesh.indices.size());
  made.loaded.longestEdgeM = longestEdgeM(mesh, patch.stepM);
  made.loaded.skirts = appendSkirts(mesh);
  made.loaded.texels = std::move(texels);

  made.draw.skirts = made.loaded.skirts;
  made.draw.originLattice = made.origin;
  made.draw.stepM = patch.stepM;
  made.draw.box = made.loaded.meta.box;
  made.draw.longestEdgeM = made.loaded.longestEdgeM;
  const Mat3d enu = ecefFromEnu(midLat, midLon);
  const glm::vec3 east(enu[0]), north(enu[1]);
  made.draw.upEcef = glm::vec3(enu[2]);
  made.draw.outwardEcef = {-north, east, north, -east};
  return made;
}

std::vector<uint8_t> flatTexture(int size, uint8_t red, uint8_t green, uint8_t blue) {
  std::vector<uint8_t> chain;
  while (chain.size() < mipChainBytes(size)) chain.insert(chain.end(), {red, green, blue, 255});
  return chain;
}

std::vector<uint8_t> groundTexture(int size, uint32_t seed) {
  std::vector<uint8_t> chain;
  for (uint32_t i = 0; i < static_cast<uint32_t>(size * size); ++i) {
    const uint32_t noise = hash(seed * 65536 + i);
    const auto shade = [&](uint32_t base, uint32_t shift) {
      return static_cast<uint8_t>(base + ((noise >> shift) & 31));
    };
    chain.insert(chain.end(), {shade(70, 0), shade(95, 0), shade(55, 8), 255});
  }
  addMips(chain, size);
  return chain;
}

ChunkDraw addChunk(Renderer& renderer, const MadeChunk& chunk) {
  const auto gpu = renderer.upload(chunk.loaded);
  REQUIRE(gpu.has_value());
  ChunkDraw draw = chunk.draw;
  draw.gpu = *gpu;
  draw.gpu.indexCount = chunk.loaded.surfaceIndexCount;
  if (gpu->textureLayer >= 0) draw.textureLayer = static_cast<uint32_t>(gpu->textureLayer);
  return draw;
}

double ridgesM(double latDeg, double lonDeg) {
  const double x = lonDeg * 40, y = latDeg * 60;
  const double big = 1 - std::abs(std::sin(x * 0.9 + std::sin(y * 0.7)));
  const double small = 1 - std::abs(std::sin(x * 3.1 + 2 * std::sin(y * 1.9)));
  const double fine = std::sin(x * 11 + y * 3) * std::sin(y * 13 - x * 2);
  return 800 + 1200 * big * big + 350 * small * big + 40 * fine;
}

std::vector<ChunkDraw> mountains(Renderer& renderer, int side, const Vec3d& eyeEcefM) {
  constexpr double kSizeDeg = 0.03;
  std::vector<std::pair<double, ChunkDraw>> byDistance;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double south = 49 + (row - side / 2) * kSizeDeg, west = 20 + (column - side / 2) * kSizeDeg * 1.5;
      const Patch patch{south, west, south + kSizeDeg, west + kSizeDeg * 1.5, 14, 0.125};
      const MadeChunk chunk =
          makeChunk(patch, ridgesM, groundTexture(kTextureSize, static_cast<uint32_t>(row * side + column)));
      byDistance.emplace_back(glm::distance(chunk.centreEcefM, eyeEcefM), addChunk(renderer, chunk));
    }
  }
  std::sort(byDistance.begin(), byDistance.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ChunkDraw> draws;
  for (const auto& [distance, draw] : byDistance) draws.push_back(draw);
  return draws;
}

std::unique_ptr<Renderer> makeRenderer(RendererOptions options) {
  auto made = Renderer::create(options);
  if (!made && made.error().kind == ErrorKind::notFound) {
    WARN("no Vulkan device here: " << made.error().message);
    return nullptr;
  }
  if (!made) FAIL(made.error().message);
  return std::move(*made);
}

FrameInput lookFrom(const Pose& pose, int widthPx, int heightPx, double fovDeg, double nearM) {
  FrameInput input;
  input.view = makeView(pose, symmetricFrustum(fovDeg, widthPx, heightPx, nearM), widthPx, heightPx);
  input.lighting.sunDirectionEcef = noonSun(pose.position.latDeg, pose.position.lonDeg);
  input.readColour = input.readDepth = true;
  return input;
}

Vec3d noonSun(double latDeg, double lonDeg) {
  const Mat3d enu = ecefFromEnu(latDeg, lonDeg);
  return glm::normalize(enu * Vec3d(0.35, -0.6, 0.7));
}

}  // namespace eye::test
