// Where the panorama suite stands and what it looks at: summits of a gazetteer or of the terrain itself, and viewpoints
// on some of them, half way up and in the valleys.
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

struct ViewpointWish {
  size_t mountains = 3;
  size_t valleys = 2;  // a mountain
};

// On the highest summits that the terrain has, 40 km apart and more; half way up beside each; and in valleys or the
// foreland, 6 to 25 km away, from where most of the summits over them show. Fewer where there are not so many.
Result<std::vector<Viewpoint>> summitViewpoints(std::vector<Summit> summits, const ViewpointWish& wish,
                                                GroundQuery& ground);

}  // namespace eye
