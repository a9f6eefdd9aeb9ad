#include "bake/ground_noise.h"

#include <algorithm>
#include <cmath>

namespace eye {

namespace {

constexpr uint64_t kHashX = 0x9E3779B97F4A7C15ull, kHashY = 0xC2B2AE3D27D4EB4Full, kHashZ = 0x165667B19E3779F9ull,
                   kHashSeed = 0xD6E8FEB86659FD93ull;

// The slope at a lattice corner, one of the 12 directions to a cube's edges (Perlin 2002), times the way from it.
float corner(uint64_t h, float x, float y, float z) {
  h ^= h >> 32;
  h *= kHashSeed;
  const auto edge = static_cast<unsigned>(h >> 60);
  const float u = edge < 8 ? x : y;
  const float v = edge < 4 ? y : edge == 12 || edge == 14 ? x : z;
  return ((edge & 1) ? -u : u) + ((edge & 2) ? -v : v);
}

float smooth(float t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}
float mix(float a, float b, float t) {
  return a + (b - a) * t;
}

}  // namespace

float gradientNoise(const glm::dvec3& p, uint32_t seed) {
  const glm::dvec3 floor = glm::floor(p);
  const glm::vec3 in(p - floor);
  const uint64_t x = static_cast<uint64_t>(static_cast<int64_t>(floor.x)) * kHashX;
  const uint64_t y = static_cast<uint64_t>(static_cast<int64_t>(floor.y)) * kHashY;
  const uint64_t z = static_cast<uint64_t>(static_cast<int64_t>(floor.z)) * kHashZ;
  const float tx = smooth(in.x), ty = smooth(in.y), tz = smooth(in.z);
  const auto line = [&](uint64_t yz, float dy, float dz) {
    return mix(corner(x ^ yz, in.x, dy, dz), corner((x + kHashX) ^ yz, in.x - 1, dy, dz), tx);
  };
  const auto plane = [&](uint64_t zSeed, float dz) {
    return mix(line(y ^ zSeed, in.y, dz), line((y + kHashY) ^ zSeed, in.y - 1, dz), ty);
  };
  const uint64_t seeded = uint64_t{seed} * kHashSeed;
  const float below = plane(z ^ seeded, in.z), above = plane((z + kHashZ) ^ seeded, in.z - 1);
  // Its values stay within about 0.8 and mostly within half of that.
  return std::clamp(1.35f * mix(below, above, tz), -1.0f, 1.0f);
}

float groundNoise(const glm::dvec3& ecefM, double longestM, double shortestM, double gain, double texelM,
                  uint32_t seed) {
  float sum = 0, amplitude = 1;
  for (double waveM = longestM; waveM >= shortestM * 0.99; waveM /= 2) {
    const double visible = std::clamp(waveM / (2 * texelM) - 1, 0.0, 1.0);
    if (visible <= 0) break;
    sum += amplitude * static_cast<float>(visible) * gradientNoise(ecefM / waveM, seed);
    amplitude *= static_cast<float>(gain);
    ++seed;
  }
  return sum;
}

}  // namespace eye
