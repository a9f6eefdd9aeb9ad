// Renders a panorama with the image generator's own renderer, terrain and levels of detail. One at a time in a process'
// thread; uses every core.
#pragma once

#include <functional>
#include <string>

#include "base/error.h"
#include "pano/panorama.h"
#include "pano/resample.h"

namespace eye {

struct PanoramaOptions {
  std::string terrain;  // a database
  std::string device;   // part of a Vulkan device's name; empty: the best
  Geodetic eye;
  PanoramaFrame frame;
  double refraction = 0.13;
  EarthShape earth = EarthShape::ellipsoid;
  DepthKind depth = DepthKind::range;
  double timeOfDayH = 8;  // local solar time, on midsummer's day
  double visibilityM = 150000;
  uint64_t cacheGpuMiB = 1024;
  std::function<void(const std::string& what, double share)> progress;  // may be empty
};

struct RenderedPanorama {
  Panorama panorama;
  std::string device;
  int coarseChunks = 0;  // drawn coarser than they should be, because the GPU's budget has no room for more
};

Result<RenderedPanorama> renderPanorama(const PanoramaOptions& options);

}  // namespace eye
