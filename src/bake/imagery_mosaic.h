// Imagery sources in order of preference, sampled with a texel's footprint.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/error.h"
#include "raster/geo_raster.h"
#include "terrain/tile_key.h"

namespace eye {

struct ImageryFile {
  std::string path;
  GeoGrid grid;  // posts are pixel centres
  bool warped = false;
  bool takenForGlobe = false;
  int colourBands = 3;  // 1 grey or 3
};

// Thread: any number at once.
class ImageryMosaic {
 public:
  // Each source a file, archive or folder; inside one source finer files come first.
  static Result<std::unique_ptr<ImageryMosaic>> open(const std::vector<std::string>& sources);
  ~ImageryMosaic();

  const std::vector<ImageryFile>& files() const;
  // Pixel height in degrees of the finest source that meets the region; 0 where none does.
  double finestPixelDeg(const TileBounds& region) const;
  // Colour (0..255) and opacity (0..1) of each point, which stands for a texel of the given size; `region` holds all of
  // the points. Where sources leave it open, the opacity stays below 1.
  Result<std::vector<glm::vec4>> sample(const TileBounds& region, double texelLatDeg, double texelLonDeg,
                                        const std::vector<LatLon>& points) const;

 private:
  struct Impl;
  explicit ImageryMosaic(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace eye
