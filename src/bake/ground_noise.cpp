#include "bake/ground_noise.h"

#include <algorithm>
#include <cmath>

namespace eye {

namespace {

// The slope at a lattice corner, one of the 12 directions to a cube's edges (Perlin 2002), times the way from it.
float corner(int64_t x, int64_t y, int64_t z, uint32_t seed, const glm::vec3& from) {
  auto h = static_cast<uint64_t>(x) * 0x9E3779B97F4A7C15ull ^ static_cast<uint64_t>(y) * 0xC2B2AE3D27D4EB4Full ^
           static_cast<uint64_t>(z) * 0x165667B19E3779F9ull ^ uint64_t { seed } * 0xD6E8FEB86659FD93ull;
  h ^= h >> 32;
  h *= 0xD6E8FEB86659FD93ull;
  h ^= h >> 32;
  const auto edge = static_cast<unsigned>(h & 15);
  const float u = edge < 8 ? from.x : from.y;
  const float v = edge < 4 ? from.y : edge == 12 || edge == 14 ? from.x : from.z;
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
  const auto x = static_cast<int64_t>(floor.x), y = static_cast<int64_t>(floor.y), z = static_cast<int64_t>(floor.z);
  const float tx = smooth(in.x), ty = smooth(in.y), tz = smooth(in.z);
  const auto at = [&](int dx, int dy, int dz) {
    return corner(x + dx, y + dy, z + dz, seed, in - glm::vec3(float(dx), float(dy), float(dz)));
  };
  const auto plane = [&](int dz) {
    return mix(mix(at(0, 0, dz), at(1, 0, dz), tx), mix(at(0, 1, dz), at(1, 1, dz), tx), ty);
  };
  // Its values stay within about 0.8 and mostly within half of that.
  return std::clamp(1.35f * mix(plane(0), plane(1), tz), -1.0f, 1.0f);
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
