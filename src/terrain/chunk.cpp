#include "terrain/chunk.h"

#include <algorithm>
#include <cmath>

namespace eye {

double latticeStepM(int level) {
  // A cell's height is a quarter meridian (10 001 966 m) over 2^level. Cells are at most 1.56 times as wide as high, so
  // their diameter is at most sqrt(1 + 1.56^2) = 1.85 heights. To this comes relief: at most 9000 m on Earth, and
  // within a small cell about its height (45 degrees of slope across it) with some metres for sheer walls.
  const double cellHeightM = std::ldexp(10'001'966.0, -level);
  const double spanM = 1.85 * cellHeightM + std::min(9000.0, cellHeightM + 128.0);
  return std::exp2(std::ceil(std::log2(spanM / 65536.0)));
}

LatticePoint latticeFromEcef(const Vec3d& ecefM, double stepM) {
  return LatticePoint(glm::round(ecefM / stepM));
}

double ChunkMeta::stepM() const {
  return std::ldexp(latticeStepM(key.level()), latticeShift);
}

glm::vec2 octahedralFromNormal(const glm::vec3& unit) {
  const glm::vec2 folded = glm::vec2(unit) / (std::abs(unit.x) + std::abs(unit.y) + std::abs(unit.z));
  if (unit.z >= 0.0f) return folded;
  return glm::vec2(std::copysign(1.0f - std::abs(folded.y), folded.x),
                   std::copysign(1.0f - std::abs(folded.x), folded.y));
}

glm::vec3 normalFromOctahedral(const glm::vec2& octahedral) {
  const float z = 1.0f - std::abs(octahedral.x) - std::abs(octahedral.y);
  const float overhang = std::max(-z, 0.0f);  // how far the point lies in a folded corner: the lower half
  return glm::normalize(glm::vec3(octahedral.x - std::copysign(overhang, octahedral.x),
                                  octahedral.y - std::copysign(overhang, octahedral.y), z));
}

}  // namespace eye
