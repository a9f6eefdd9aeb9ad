#include "bench/bench_views.h"

#include <fmt/format.h>

namespace eye {
namespace {

constexpr double kMetresPerFoot = 0.3048;

BenchView viewFrom(const Place& place, const Spot& spot, int altitudeFt) {
  return {fmt::format("{} {} ft", place.name, altitudeFt),
          Pose{{spot.at.latDeg, spot.at.lonDeg, spot.groundM + altitudeFt * kMetresPerFoot}, spot.headingDeg, 0, 0}};
}

}  // namespace

std::vector<BenchView> benchViews(const std::array<Place, 2>& places) {
  const Place &plain = places[0], &mountains = places[1];
  return {viewFrom(mountains, mountains.spots[0], 2000), viewFrom(plain, plain.spots[0], 2000),
          viewFrom(mountains, mountains.spots[0], 98),   viewFrom(mountains, mountains.spots[1], 984),
          viewFrom(mountains, mountains.spots[0], 8000), viewFrom(plain, plain.spots[0], 98)};
}

}  // namespace eye
