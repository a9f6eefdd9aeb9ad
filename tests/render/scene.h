// Terrain by formula, cut into chunks by hand, for the renderer's tests.
#pragma once

#include <functional>
#include <memory>

#include "render/renderer.h"

namespace eye::test {

using HeightFunction = std::function<double(double latDeg, double lonDeg)>;

struct Patch {
  double southDeg, westDeg, northDeg, eastDeg;
  int quads = 14;  // along each side
  double stepM = 0.125;
};

// A grid of quads over the patch, its boundary loop first (counterclockwise from the south-west), and its skirts.
// `texels`: empty for a chunk without imagery of its own.
struct MadeChunk {
  LoadedChunk loaded;
  LatticePoint origin{};
  Vec3d centreEcefM{};
  ChunkDraw draw;  // all but what upload gives
};
MadeChunk makeChunk(const Patch& patch, const HeightFunction& heightM, std::vector<uint8_t> texels);

std::vector<uint8_t> flatTexture(int size, uint8_t red, uint8_t green, uint8_t blue);
std::vector<uint8_t> groundTexture(int size, uint32_t seed);  // noise in greens and greys, with its mip chain

// Uploads and completes draw.gpu and textureLayer. Fails the test where the pools are full.
ChunkDraw addChunk(Renderer& renderer, const MadeChunk& chunk);

// Ridges of some 1,500 m, `side` x `side` chunks about 49 N 20 E, front to back as seen from `eye`.
double ridgesM(double latDeg, double lonDeg);
std::vector<ChunkDraw> mountains(Renderer& renderer, int side, const Vec3d& eyeEcefM);

// Null, with a warning, where this machine has no Vulkan device.
std::unique_ptr<Renderer> makeRenderer(RendererOptions options);
FrameInput lookFrom(const Pose& pose, int widthPx, int heightPx, double fovDeg = 60, double nearM = 1);
Vec3d noonSun(double latDeg, double lonDeg);

}  // namespace eye::test
