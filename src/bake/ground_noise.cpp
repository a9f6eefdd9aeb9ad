#include "bake/ground_noise.h"

#include <algorithm>
#include <cmath>

namespace eye {

namespace {

// A corner's value, -1..1.
float corner(int64_t x, int64_t y, int64_t z, uint32_t seed) {
  auto h = static_cast<uint64_t>(x) * 0x9E3779B97F4A7C15ull ^ static_cast<uint64_t>(y) * 0xC2B2AE3D27D4EB4Full ^
           static_cast<uint64_t>(z) * 0x165667B19E3779F9ull ^ uint64_t { seed } * 0xD6E8FEB86659FD93ull;
  h ^= h >> 32;
  h *= 0xD6E8FEB86659FD93ull;
  h ^= h >> 32;
  return static_cast<float>(h & 0xFFFFFF) * (2.0f / 0xFFFFFF) - 1;
}

float smooth(double t) {
  return static_cast<float>(t * t * (3 - 2 * t));
}
float mix(float a, float b, float t) {
  return a + (b - a) * t;
}

}  // namespace

float valueNoise(const glm::dvec3& p, uint32_t seed) {
  const glm::dvec3 floor = glm::floor(p);
  const glm::dvec3 in = p - floor;
  const auto x = static_cast<int64_t>(floor.x), y = static_cast<int64_t>(floor.y), z = static_cast<int64_t>(floor.z);
  const float tx = smooth(in.x), ty = smooth(in.y), tz = smooth(in.z);
  const auto plane = [&](int64_t k) {
    return mix(mix(corner(x, y, k, seed), corner(x + 1, y, k, seed), tx),
               mix(corner(x, y + 1, k, seed), corner(x + 1, y + 1, k, seed), tx), ty);
  };
  return mix(plane(z), plane(z + 1), tz);
}

float groundNoise(const glm::dvec3& ecefM, double longestM, double shortestM, double gain, double texelM,
                  uint32_t seed) {
  float sum = 0, amplitude = 1;
  for (double waveM = longestM; waveM >= shortestM * 0.99; waveM /= 2) {
    const double visible = std::clamp(waveM / (2 * texelM) - 1, 0.0, 1.0);
    if (visible <= 0) break;
    sum += amplitude * static_cast<float>(visible) * valueNoise(ecefM / waveM, seed);
    amplitude *= static_cast<float>(gain);
    ++seed;
  }
  return sum;
}

}  // namespace eye
