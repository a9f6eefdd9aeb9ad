#include "bench/globe_flights.h"

#include <chrono>
#include <cmath>
#include <thread>

#include "bench/flight_run.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr double kRateHz = 25;
constexpr size_t kLookEvery = 10;  // frames; a look reads the depth back and goes over all pixels

// 12 degrees on either side of a pole along the meridians 30 and -150, at 30 km.
Pose overPole(double share, double sign) {
  constexpr double kArcDeg = 12, kAltM = 30'000, kMeridianDeg = 30;
  const double fromPoleDeg = kArcDeg * (1 - 2 * share);  // below 0 beyond it
  const bool beyond = fromPoleDeg < 0;
  const double headingDeg = (sign > 0) == beyond ? 180 : 0;
  return {{sign * (90 - std::abs(fromPoleDeg)), beyond ? kMeridianDeg - 180 : kMeridianDeg, kAltM}, headingDeg, -8, 0};
}

// Along longitude 180, swinging a degree to both sides, at 100 km.
Pose alongDateLine(double share) {
  constexpr double kFromDeg = -60, kToDeg = 60, kAltM = 100'000, kSwings = 6;
  const double eastDeg = std::sin(share * kSwings * 6.283185307179586);
  return {{kFromDeg + (kToDeg - kFromDeg) * share, eastDeg > 0 ? eastDeg - 180 : eastDeg + 180, kAltM}, 0, -25, 0};
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
    {"over the north pole", [](double share) { return overPole(share, 1); }},
    {"over the south pole", [](double share) { return overPole(share, -1); }},
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
    const bool looks = figures.frames++ % kLookEvery == 0;
    const Result<FrameRecord> record = generator.frame(flight.poseAt(timeS / durationS), timeS, looks);
    if (!record) return tl::unexpected(record.error());
    if (looks) {
      ++figures.framesLookedAt;
      figures.holes += holesIn(generator.generator(), depthM);
    } else {
      frameMs.push_back(record->frameMs);
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
