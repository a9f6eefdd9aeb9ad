// The elevation that a bake starts from: sources of mixed resolution in order of preference, as one surface.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "terrain/tile_key.h"

namespace eye {

// Post lines of every source that shows in a region: the surface is bilinear between them (exactly so inside one
// source), so a mesh that is right at the posts, and along its own edges, is right everywhere.
struct PostLines {
  std::vector<double> latDeg, lonDeg;  // ascending, strictly inside the region asked for
};

// Thread: any number at once.
class ElevationSurface {
 public:
  virtual ~ElevationSurface() = default;
  // Metres; total: outside every source it is sea level (0). Longitude 180 and -180 give the same, bit for bit.
  virtual double heightM(double latDeg, double lonDeg) const = 0;
  // Many at once, the same values as heightM for each; what the mesher calls for speed.
  virtual void heightsM(const std::vector<LatLon>& points, std::vector<double>& heightsM) const;
  // Empty where no source meets the region.
  virtual PostLines postLines(const TileBounds& region) const = 0;
  // Post spacing in degrees of latitude of the finest source that meets the region; 0 where none does.
  virtual double finestSpacingDeg(const TileBounds& region) const = 0;
  // Of every source that shows in the region; empty where none does.
  virtual std::vector<double> spacingsDeg(const TileBounds& region) const;
  virtual TileBounds dataBounds() const = 0;
};

}  // namespace eye
