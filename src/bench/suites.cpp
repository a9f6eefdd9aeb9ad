#include "bench/suites.h"

#include <array>

namespace eye {

std::span<const Suite> suites() {
  static constexpr auto kSuites = std::to_array<Suite>(
      {{"culling", "paper 001's Table 5: no culling, frustum, dynamic, by height and size", runCullingSuite},
       {"selector", "a flight through all heights: what the selector loses against the best fixed choice",
        runSelectorSuite},
       {"flight", "paper 000's Table I: fast flights in real time, with and without prediction", runFlightSuite},
       {"globe", "paper 004's Table 3: levels, blocks and culling from space, flights over the poles", runGlobeSuite},
       {"panorama", "paper 002's Tables 1 to 3: how well the distances of peaks are told", runPanoramaSuite},
       {"host", "a host on the loopback: transport delay, floods, bad links, questions", runHostSuite},
       {"pareto", "run time against error: tolerance, culling, depth maps, samplers, samples, sizes", runParetoSuite},
       {"floor", "a frame's time against that of its visible triangles alone", runFloorSuite},
       {"stability", "figures with limits: heights, poles, lenses, a still eye, a day of clocks, wild states",
        runStabilitySuite}});
  return kSuites;
}

}  // namespace eye
