// The slope of the surface as a normal.
#pragma once

#include "bake/elevation.h"
#include "geo/frames.h"

namespace eye {

// Unit outward normals (ecef) at many places by central differences over `reachM` either way: functions of the place
// and the reach alone, so that tiles agree along their edges.
void surfaceNormals(const ElevationSurface& surface, const std::vector<LatLon>& places, double reachM,
                    std::vector<Vec3d>& normals);

}  // namespace eye
