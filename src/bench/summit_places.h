// Where the panorama suite stands and what it looks at: summits of a gazetteer or of the terrain itself, and viewpoints
// on some of them and half way up.
#pragma once

#include <string>
#include <vector>

#include "paging/ground_query.h"
#include "pano/gazetteer.h"

namespace eye {

// The highest vertices of the terrain, 2 km apart and more, the highest first; named by their height.
Result<std::vector<Summit>> terrainSummits(const DatabaseReader& reader, size_t most);

struct Viewpoint {
  std::string name;
  Geodetic eye;
};

// On the highest summits that the terrain has, 40 km apart and more, and half way up beside each: two of `pairs`
// viewpoints each. Fewer where there are not so many.
Result<std::vector<Viewpoint>> summitViewpoints(std::vector<Summit> summits, size_t pairs, GroundQuery& ground);

// Whether the top shows by more than `underRad` of angle, in double precision on the finest meshes, along the bent ray
// so far under it: a parabola in steps of 5 km, of which each is straight. It must meet the top's own slope, within a
// kilometre, and nothing before. `refraction`: k.
Result<bool> isInSight(GroundQuery& ground, const Geodetic& eye, const Geodetic& top, double refraction,
                       double underRad);

}  // namespace eye
