// Deterministic gradient noise on the sphere: no seam at the date line or the poles, the same for every tile and level.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace eye {

// -1..1, smooth, varying over about a unit of `p`.
float gradientNoise(const glm::dvec3& p, uint32_t seed);

// Sum of octaves with wavelengths from `longestM` halved down to `shortestM`, each with `gain` times the one before's
// amplitude; about -1..1. Octaves shorter than twice `texelM` are left out, the last one fading, so that nothing
// flickers between levels.
float groundNoise(const glm::dvec3& ecefM, double longestM, double shortestM, double gain, double texelM,
                  uint32_t seed);

}  // namespace eye
