// Pictures of eyes that stand still, creep, and whirl.
#include <algorithm>
#include <cmath>

#include "bench/ground_heights.h"
#include "bench/places.h"
#include "bench/stability.h"
#include "bench/steered_generator.h"

namespace eye {
namespace {

constexpr int kWidthPx = 320, kHeightPx = 240;
constexpr double kFrameS = 1.0 / 60;
constexpr double kEyeM = 10;  // above the ground
// A point that is off by this much, seen from kEyeM away, is off by one pixel of a picture 1,280 pixels and 60 degrees
// wide.
constexpr double kPixelM = kEyeM / 1108;
constexpr double kMostOffPx = 0.1;
constexpr double kOverReliefM = 3000;

struct Picture {
  std::vector<uint8_t> rgba;
  std::vector<float> depth;
  bool operator==(const Picture&) const = default;
};

class Camera {
 public:
  static Result<Camera> create(Options options) {
    options.widthPx = kWidthPx;
    options.heightPx = kHeightPx;
    Result<SteeredGenerator> generator = SteeredGenerator::create(options);
    if (!generator) return tl::unexpected(generator.error());
    return Camera(std::move(*generator));
  }
  // The clock goes on by a frame each time.
  Result<Picture> shoot(const Pose& pose) {
    const Result<FrameRecord> record = generator_.frame(pose, kFrameS * frame_++, true);
    if (!record) return tl::unexpected(record.error());
    const auto colour = generator_.generator().picture();
    const auto depth = generator_.generator().depth();
    return Picture{{colour.begin(), colour.end()}, {depth.begin(), depth.end()}};
  }
  std::string device() { return generator_.generator().renderer().device().name; }

 private:
  explicit Camera(SteeredGenerator generator) : generator_(std::move(generator)) {}
  SteeredGenerator generator_;
  int frame_ = 0;
};

// Frames that differ in any bit from those before, once visibility has settled.
Result<double> stillFramesThatDiffer(Camera& camera, const Pose& pose, int frames) {
  constexpr int kSettling = 4;
  for (int i = 0; i < kSettling; ++i)
    if (const auto shot = camera.shoot(pose); !shot) return tl::unexpected(shot.error());
  const Result<Picture> first = camera.shoot(pose);
  if (!first) return tl::unexpected(first.error());
  double differ = 0;
  for (int i = 0; i < frames; ++i) {
    const Result<Picture> next = camera.shoot(pose);
    if (!next) return tl::unexpected(next.error());
    differ += *next == *first ? 0 : 1;
  }
  return differ;
}

// Straight down on the ground, up by a millimetre a frame: the middle's distance grows by that. Metres off, the worst.
Result<double> millimetresOff(Camera& camera, Pose pose, int steps) {
  double worstM = 0, beforeM = 0;
  for (int i = 0; i <= steps; ++i) {
    const Result<Picture> shot = camera.shoot(pose);
    if (!shot) return tl::unexpected(shot.error());
    const double nowM = 1 / static_cast<double>(shot->depth[kWidthPx * kHeightPx / 2 + kWidthPx / 2]);
    if (i > 0) worstM = std::max(worstM, std::abs(nowM - beforeM - 0.001));
    beforeM = nowM;
    pose.position.altM += 0.001;
  }
  return worstM;
}

// Depths that are no depth, and pixels of sky where the eye looks straight down on the ground.
struct Wild {
  double invalid = 0, holes = 0;
};
Result<Wild> wildFlight(Camera& camera, Pose pose, int frames) {
  constexpr double kFastMS = 3000, kSpinDegS = 360, kDegPerM = 1 / 111200.0;
  constexpr int kPhase = 60;  // frames of each: spinning, rolling, vertical up and down, inverted, straight down
  Wild wild;
  for (int i = 0; i < frames; ++i) {
    // There and back, so that it stays over the terrain.
    const double alongS = std::abs(std::fmod(i * kFrameS, 4) - 2) - 1;
    Pose now = pose;
    now.position.latDeg += alongS * kFastMS * kDegPerM;
    const int phase = i / kPhase % 6;
    const double turnDeg = kSpinDegS * i * kFrameS;
    if (phase == 0) now.headingDeg = std::fmod(turnDeg, 360);
    if (phase == 1) now.rollDeg = std::remainder(turnDeg, 360);
    if (phase == 2) now.pitchDeg = 90;
    if (phase == 3) now.pitchDeg = std::clamp(std::remainder(turnDeg, 180), -90.0, 90.0);
    if (phase == 4) now.rollDeg = 180;
    if (phase == 5) now.pitchDeg = -90, now.headingDeg = std::fmod(turnDeg, 360);
    const Result<Picture> shot = camera.shoot(now);
    if (!shot) return tl::unexpected(shot.error());
    for (const float depth : shot->depth) {
      wild.invalid += std::isfinite(depth) && depth >= 0 && depth <= 1 ? 0 : 1;
      wild.holes += phase == 5 && depth == 0 ? 1 : 0;
    }
  }
  return wild;
}

}  // namespace

Result<FrameFigures> frameFigures(const Options& options, const FrameEffort& effort,
                                  const std::function<void(const std::string&)>& progress) {
  const Result<DatabaseReader> reader =
      DatabaseReader::open(options.terrain.empty() ? defaultTerrainPath() : options.terrain);
  if (!reader) return tl::unexpected(reader.error());
  const auto places = findPlaces(*reader);
  if (!places) return tl::unexpected(places.error());
  Result<Camera> camera = Camera::create(options);
  if (!camera) return tl::unexpected(camera.error());
  FrameFigures made{.figures = {}, .device = camera->device()};
  GroundHeights ground(*reader);
  const LatLon mountains = (*places)[1].spots[0].at;

  const auto add = [&](const std::string& name, const Result<double>& figure, double limit, const char* unit) {
    if (figure) made.figures.push_back({name, *figure, limit, unit});
    return figure.has_value() ? Result<void>() : tl::unexpected(figure.error());
  };
  const Result<double> groundM = ground.heightM(mountains);
  if (!groundM) return tl::unexpected(groundM.error());
  progress("an eye that stands still");
  const Pose still{{mountains.latDeg, mountains.lonDeg, *groundM + 500}, 30, -10, 5};
  const std::string frames = std::to_string(effort.stillFrames) + " of a still eye";
  if (const auto ok =
          add("frames that change, " + frames, stillFramesThatDiffer(*camera, still, effort.stillFrames), 0, "frames");
      !ok)
    return tl::unexpected(ok.error());

  struct Ground {
    const char* name;
    LatLon at;
  };
  for (const Ground& spot : {Ground{"mountains", mountains}, Ground{"the north pole", {90, 0}},
                             Ground{"the south pole", {-90, 0}}, Ground{"the date line", {0.5, 180}}}) {
    progress(std::string("steps of a millimetre, ") + spot.name);
    const Result<double> heightM = ground.heightM(spot.at);
    if (!heightM) return tl::unexpected(heightM.error());
    const Pose over{{spot.at.latDeg, spot.at.lonDeg, *heightM + kEyeM}, 0, -90, 0};
    const Result<double> offM = millimetresOff(*camera, over, effort.millimetres);
    const Result<double> offPx = offM ? Result<double>(*offM / kPixelM) : offM;
    if (const auto ok =
            add(std::string("steps of 1 mm from 10 m away, as drawn, ") + spot.name, offPx, kMostOffPx, "px");
        !ok)
      return tl::unexpected(ok.error());
  }

  progress("spinning, vertical, inverted at 3 km/s");
  const Result<Wild> wild = wildFlight(
      *camera, {{mountains.latDeg, mountains.lonDeg, *groundM + kOverReliefM}, 0, -10, 0}, effort.wildFrames);
  if (!wild) return tl::unexpected(wild.error());
  const std::string states =
      " in " + std::to_string(effort.wildFrames) + " frames at 3 km/s, 360 degrees a second, any way up";
  made.figures.push_back({"pixels without a valid depth" + states, wild->invalid, 0, "pixels"});
  made.figures.push_back({"pixels of sky straight down" + states, wild->holes, 0, "pixels"});
  return made;
}

}  // namespace eye
