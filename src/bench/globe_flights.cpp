#include "bench/globe_flights.h"

#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "bench/flight_run.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr double kRateHz = 25;
constexpr size_t kLookEvery = 10;  // frames; a look reads the depth back and goes over all pixels

constexpr double kSpeedMS = 8000, kAltM = 30'000;  // as fast as an orbit, and as low as balloons fly
constexpr double kMetresPerDegree = 111'195;

// Along the meridians 30 and -150; `alongM` is 0 over the pole.
Pose overPole(double alongM, double sign) {
  constexpr double kMeridianDeg = 30, kPitchDeg = -20;
  const bool beyond = alongM > 0;
  const double headingDeg = (sign > 0) == beyond ? 180 : 0;
  return {{sign * (90 - std::abs(alongM) / kMetresPerDegree), beyond ? kMeridianDeg - 180 : kMeridianDeg, kAltM},
          headingDeg,
          kPitchDeg,
          0};
}

// Northwards along longitude 180, in bends over it.
Pose alongDateLine(double alongM) {
  constexpr double kLatDeg = 52, kBendDeg = 0.1, kBendM = 60'000, kPitchDeg = -20;
  const double eastDeg = kBendDeg * std::sin(2 * std::numbers::pi * alongM / kBendM);
  return {{kLatDeg + alongM / kMetresPerDegree, eastDeg > 0 ? eastDeg - 180 : eastDeg + 180, kAltM}, 0, kPitchDeg, 0};
}

// Pixels whose ray meets the ellipsoid lowered to under all ground, and where nothing was drawn.
size_t holesIn(const ImageGenerator& generator, double depthM) {
  const View& view = generator.view();
  const Vec3d axesM = Vec3d(kSemiMajorM, kSemiMajorM, kSemiMinorM) - depthM;
  const Vec3d eye = view.eyeEcefM / axesM;
  const double beyond = glm::dot(eye, eye) - 1;
  const Mat3d ecefFromEye = glm::transpose(view.eyeFromEcef);
  size_t holes = 0;
  for (int row = 0; row < view.heightPx; ++row) {
    for (int column = 0; column < view.widthPx; ++column) {
      const auto pixel = static_cast<size_t>(row) * static_cast<size_t>(view.widthPx) + static_cast<size_t>(column);
      if (generator.depth()[pixel] > 0) continue;
      const Vec3d ray = ecefFromEye * rayThroughPixel(view.frustum, view.widthPx, view.heightPx, column, row) / axesM;
      const double along = glm::dot(eye, ray);
      if (along < 0 && along * along > glm::dot(ray, ray) * beyond) ++holes;
    }
  }
  return holes;
}

}  // namespace

const std::array<GlobeFlight, 3> kGlobeFlights{{
    {"over the north pole", [](double alongM) { return overPole(alongM, 1); }},
    {"over the south pole", [](double alongM) { return overPole(alongM, -1); }},
    {"along the date line", alongDateLine},
}};

Result<GlobeFlightFigures> flyOverGlobe(SteeredGenerator& generator, const GlobeFlight& flight, double durationS,
                                        double startS, double depthM) {
  GlobeFlightFigures figures;
  std::vector<double> frameMs;
  const auto slots = static_cast<uint64_t>(durationS * kRateHz);
  const int64_t beganNs = monotonicNs();
  const auto elapsedS = [&] { return static_cast<double>(monotonicNs() - beganNs) * 1e-9; };
  for (uint64_t slot = 0; slot <= slots;) {
    const double timeS = static_cast<double>(slot) / kRateHz;
    const bool reads = figures.frames++ % kLookEvery == 0;
    const Result<FrameRecord> record = generator.frame(flight.poseAt(kSpeedMS * (timeS - durationS / 2)), timeS, reads);
    if (!record) return tl::unexpected(record.error());
    if (!reads) frameMs.push_back(record->frameMs);
    // While an octant stands in for finer chunks, its surface lies far below the ground.
    if (reads && record->selection.missing == 0) {
      ++figures.framesLookedAt;
      figures.holes += holesIn(generator.generator(), depthM);
    }
    if (timeS >= startS && record->selection.missing > 0) ++figures.missingAfterStart;
    slot = nextSlot(slot, elapsedS(), 1 / kRateHz);
    const double waitS = static_cast<double>(slot) / kRateHz - elapsedS();
    if (waitS > 0) std::this_thread::sleep_for(std::chrono::duration<double>(waitS));
  }
  figures.frameMs = summarize(std::move(frameMs));
  return figures;
}

}  // namespace eye
