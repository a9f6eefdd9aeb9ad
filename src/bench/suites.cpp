#include "bench/suites.h"

#include <array>

namespace eye {

std::span<const Suite> suites() {
  static constexpr std::array<Suite, 3> kSuites{
      {{"culling", "paper 001's Table 5: no culling, frustum, dynamic, by height and size", runCullingSuite},
       {"selector", "a flight through all heights: what the selector loses against the best fixed choice",
        runSelectorSuite},
       {"flight", "paper 000's Table I: fast flights in real time, with and without prediction", runFlightSuite}}};
  return kSuites;
}

}  // namespace eye
