// CSV and IGC tracks, and the pose between their samples.
#include <cmath>

#include "fuzz_input.h"
#include "link/track_file.h"

namespace {

using namespace eye;

void fly(const Result<Track>& track) {
  if (!track) return;
  for (const double share : {0.0, 0.3, 1.0}) {
    const Pose pose = track->at(track->durationS() * share);
    EYE_CHECK(std::isfinite(pose.position.latDeg) && std::isfinite(pose.headingDeg) && std::isfinite(pose.rollDeg));
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text = fuzz::textOf(data, size);
  fly(parseCsvTrack(text));
  fly(parseIgcTrack(text));
  return 0;
}
