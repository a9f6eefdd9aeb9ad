// What the Earth hides: chunks whose every point lies behind the ellipsoid, as seen from the eye.
//
// What hides them is the terrain, not the ellipsoid. So the test takes an ellipsoid shrunk to lie under all terrain
// that is drawn between the eye and the horizon: a ray that meets it has met terrain before.
//
// Two tests, to compare. `ellipsoid`: the chunk's horizon point, which was made for the ellipsoid in full size and for
// the chunk's own mesh; it is raised for the smaller ellipsoid and for finer descendants, which may be higher than the
// mesh. Both raises are exact bounds on a sphere, and scaled space is one. `paper`: the bounding sphere against a
// spherical Earth (paper 004, equations 3 to 6), which must lie inside the ellipsoid and so hides less.
#pragma once

#include "geo/frames.h"
#include "geo/view.h"
#include "terrain/chunk.h"

namespace eye {

// No ground lies deeper under the ellipsoid: the deepest sea is 11 km.
inline constexpr double kDeepestGroundM = 12000;

// `none`: nothing is hidden, for scenes in which refraction lets the eye see over the horizon.
enum class HorizonTest { ellipsoid, paper, none };

class Horizon {
 public:
  // `depthM`: all that is drawn as far as reachM() lies above the ellipsoid lowered by this.
  Horizon(const Vec3d& eyeEcefM, double depthM);

  // No point of a ray beyond this distance from the eye is the first that meets the shrunk ellipsoid, metres.
  double reachM() const { return reachM_; }
  double depthM() const { return depthM_; }
  // Whether nothing of the chunk can be seen, nor of what descends from it: meshes up to twice its error higher.
  bool hides(const ChunkMeta& meta, HorizonTest test = HorizonTest::ellipsoid) const;

 private:
  bool hidesPoint(const ChunkMeta& meta) const;
  bool hidesSphere(const ChunkMeta& meta) const;

  double depthM_, reachM_ = 0;
  double shrink_ = 1;  // semi-axes of the shrunk ellipsoid over the full ones
  bool eyeOutside_ = false;
  Vec3d eyeEcefM_{};
  Vec3d eyeScaled_{};  // ecef over the shrunk semi-axes
};

// A first depth, which terrain within the tolerance and above the ellipsoid never exceeds: its sag grows with its
// distance, and what hides lies no farther than the horizon. Below an eye that is under the ellipsoid itself, as beside
// the Dead Sea. `tolerancePerM`: tolerated error over distance.
Horizon horizonForTolerance(const Vec3d& eyeEcefM, double greatestErrorM, double tolerancePerM);

// Whether the ellipsoid hides the point (scaled space: ecef over the semi-axes). Cesium's test: exact for ellipsoids.
bool belowHorizon(const Vec3d& eyeScaled, const Vec3d& pointScaled);

}  // namespace eye
