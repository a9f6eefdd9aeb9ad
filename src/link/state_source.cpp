#include "link/state_source.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>

#include "link/angles.h"
#include "link/live_sources.h"
#include "link/pose_limits.h"
#include "link/scenario.h"
#include "link/track_file.h"

namespace eye {
namespace {

class FixedSource : public StateSource {
 public:
  explicit FixedSource(const Pose& pose) { sample_.pose = pose, sample_.valid = true; }
  SourceSample sample(double) override { return sample_; }
  bool isLive() const override { return false; }
  bool isFixed() const override { return true; }

 private:
  SourceSample sample_;
};

// A recording or scenario: a pure function of time with an end.
class TimedSource : public StateSource {
 public:
  TimedSource(std::function<Pose(double)> poseAt, double durationS)
      : poseAt_(std::move(poseAt)), durationS_(durationS) {}
  SourceSample sample(double timeS) override {
    SourceSample sample;
    sample.pose = poseAt_(timeS);
    sample.valid = true;
    sample.finished = timeS >= durationS_;
    return sample;
  }
  bool isLive() const override { return false; }
  bool isFixed() const override { return false; }

 private:
  std::function<Pose(double)> poseAt_;
  double durationS_;
};

OpenedSource openTrack(const std::string& path) {
  auto track = loadTrack(path);
  if (!track) return tl::unexpected(track.error());
  const double durationS = track->durationS();
  return std::make_unique<TimedSource>([track = std::move(*track)](double t) { return track.at(t); }, durationS);
}

OpenedSource openScenario(const std::string& name) {
  const auto scenario = findScenario(name.empty() ? kDefaultScenario : name);
  if (!scenario) return tl::unexpected(scenario.error());
  return std::make_unique<TimedSource>(scenario->poseAt, scenario->durationS);
}

OpenedSource openPose(const std::string& text) {
  const auto pose = parsePose(text);
  if (!pose) return tl::unexpected(pose.error());
  return std::make_unique<FixedSource>(*pose);
}

}  // namespace

Result<std::unique_ptr<StateSource>> openStateSource(const std::string& url, const OpenProbe& openProbe) {
  constexpr std::string_view kSeparator = "://";
  const size_t at = url.find(kSeparator);
  const std::string scheme = url.substr(0, at);
  const std::string rest = at == std::string::npos ? "" : url.substr(at + kSeparator.size());
  if (at != std::string::npos) {
    if (scheme == "native-fdm") return openNativeFdm(url, rest);
    if (scheme == "cigi") return openCigi(url, rest, openProbe);
    if (scheme == "dis") return openDis(url, rest);
    if (scheme == "xplane") return openXplane(url, rest);
    if (scheme == "file") return openTrack(rest);
    if (scheme == "demo") return openScenario(rest);
    if (scheme == "pose") return openPose(rest);
  }
  return fail(ErrorKind::usage,
              fmt::format("host '{}' is none of native-fdm://ADDR:PORT, cigi://ADDR:PORT, dis://ADDR:PORT, "
                          "xplane://ADDR:PORT, file://TRACK, demo://[SCENARIO], pose://lat,lon,alt,heading,pitch,roll",
                          url));
}

Result<Pose> parsePose(const std::string& text) {
  struct Part {
    const char* name;
    double limitDeg;  // 0: checked with the position
  };
  constexpr std::array<Part, 6> kParts = {
      {{"latitude", 0}, {"longitude", 0}, {"altitude", 0}, {"heading", 360}, {"pitch", 90}, {"roll", 360}}};
  const auto bad = [&](const std::string& what) {
    return fail(ErrorKind::usage, fmt::format("pose '{}': {}", text, what));
  };

  std::array<double, kParts.size()> values{};
  std::string_view rest = text;
  for (size_t i = 0; i < kParts.size(); ++i) {
    const size_t comma = rest.find(',');
    const bool last = i + 1 == kParts.size();
    if (last != (comma == std::string_view::npos)) return bad("expected six numbers lat,lon,alt,heading,pitch,roll");
    const auto value = parseNumber(rest.substr(0, comma));
    if (!value) return bad(fmt::format("{} '{}' is not a number", kParts[i].name, rest.substr(0, comma)));
    const double limitDeg = kParts[i].limitDeg;
    if (limitDeg > 0 && std::abs(*value) > limitDeg)
      return bad(fmt::format("{} {} is outside -{} to {} degrees", kParts[i].name, *value, limitDeg, limitDeg));
    values[i] = *value;
    rest.remove_prefix(last ? rest.size() : comma + 1);
  }
  const auto position = checkedPosition({values[0], values[1], values[2]});
  if (!position) return bad(position.error().message);
  Pose pose{*position, values[3], values[4], values[5]};
  normaliseAngles(pose);
  return pose;
}

}  // namespace eye
