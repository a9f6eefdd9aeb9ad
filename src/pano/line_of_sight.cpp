#include "pano/line_of_sight.h"

#include <algorithm>

namespace eye {
namespace {

// The bent line in pieces that are straight: its sagitta over one is k 0.5 m at most.
constexpr double kPieceM = 5000;
constexpr double kNearSlopeM = 180, kSlopeShare = 0.02, kFarSlopeM = 1000;
// A notch in the last metres that is less deep than this is roughness, not a gap: the meshes' own error and more.
constexpr double kNotchM = 3;
constexpr double kNotchStepM = 20;

// A line that is straight in the drawn scene, from the eye to `end` in it.
class SightLine {
 public:
  SightLine(const Geodetic& eye, const Geodetic& top, const SceneBend& bend, double underRad)
      : bend_(bend),
        eyeEcefM_(ecefFromGeodetic(eye)),
        axes_(ecefFromEnu(eye.latDeg, eye.lonDeg)),
        end_(bentEnu(bend, offsetEnu(eye, top, EarthShape::ellipsoid))) {
    end_.z -= underRad * glm::length(end_);
  }
  double lengthM() const { return glm::length(end_); }
  Vec3d ecefAt(double share) const {
    const Vec3d drawn = share * end_;
    const double east = drawn.x / (1 + bend_.stretchEast), north = drawn.y / (1 + bend_.stretchNorth);
    const double up = drawn.z - bend_.liftEastPerM * east * east - bend_.liftNorthPerM * north * north;
    return eyeEcefM_ + axes_ * Vec3d(east, north, up);
  }

 private:
  const SceneBend& bend_;
  Vec3d eyeEcefM_;
  Mat3d axes_;
  Vec3d end_;
};

// Where the line first meets the ground, as a share of its way; nothing where it gets past the top.
Result<std::optional<double>> firstMet(GroundQuery& ground, const SightLine& line) {
  const int pieces = 1 + static_cast<int>(line.lengthM() / kPieceM);
  Vec3d from = line.ecefAt(0);
  for (int i = 0; i < pieces; ++i) {
    const Vec3d to = line.ecefAt(static_cast<double>(i + 1) / pieces);
    const auto hit = ground.between(from, to);
    if (!hit) return tl::unexpected(hit.error());
    if (*hit) {
      const double along = glm::distance(ecefFromGeodetic((*hit)->position), from) / glm::distance(from, to);
      return std::optional((i + std::min(along, 1.0)) / pieces);
    }
    from = to;
  }
  return std::optional<double>{};
}

Result<bool> staysInside(GroundQuery& ground, const SightLine& line, double from) {
  const double step = kNotchStepM / line.lengthM();
  for (double share = from + step; share < 1; share += step) {
    const Geodetic at = geodeticFromEcef(line.ecefAt(share));
    const Result<GroundHit> under = ground.under(at.latDeg, at.lonDeg);
    if (!under) return tl::unexpected(under.error());
    if (at.altM > under->position.altM + kNotchM) return false;
  }
  return true;
}

}  // namespace

double ownSlopeM(double distanceM) {
  return std::clamp(kSlopeShare * distanceM, kNearSlopeM, kFarSlopeM);
}

Result<bool> isInSight(GroundQuery& ground, const Geodetic& eye, const Geodetic& top, const SceneBend& bend,
                       double underRad) {
  const SightLine line(eye, top, bend, underRad);
  const Result<std::optional<double>> met = firstMet(ground, line);
  if (!met) return tl::unexpected(met.error());
  if (!*met) return false;
  const double beforeM = (1 - **met) * line.lengthM();
  if (beforeM > ownSlopeM(line.lengthM())) return false;
  return staysInside(ground, line, **met);
}

}  // namespace eye
