// The views that time and error are measured in: low and high, over the mountains and the plain of a database.
#pragma once

#include <string>
#include <vector>

#include "bench/places.h"
#include "geo/pose.h"

namespace eye {

struct BenchView {
  std::string name;  // "mountains 2000 ft": above the ground
  Pose pose;
};

// Level, from the lowest ground of each place towards its highest; half way up where a valley's walls would fill all.
std::vector<BenchView> benchViews(const std::array<Place, 2>& places);

}  // namespace eye
