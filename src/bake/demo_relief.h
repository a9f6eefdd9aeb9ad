// The real world under the demo, where a 5-minute global relief is installed (Debian's ferret-datasets: NGDC ETOPO5).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "raster/geo_raster.h"

namespace eye {

inline constexpr const char* kInstalledRelief = "/usr/share/ferret-vis/data/etopo5.cdf";

// Metres of land at a global grid's posts, row 0 northernmost: the mean over each post's cell, the sea and its floor 0.
// `path`: a global raster whose first column lies at longitude 0. Nothing where there is none that can be read.
std::optional<std::vector<float>> installedReliefM(const std::string& path, const GeoGrid& world);

}  // namespace eye
