#include "link/state_source.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>

#include "link/angles.h"
#include "link/endpoint.h"
#include "link/link_thread.h"
#include "link/native_fdm.h"
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

Result<HostState> parseNativeFdmState(std::span<const std::byte> datagram) {
  const auto state = parseNativeFdm(datagram);
  if (!state) return tl::unexpected(state.error());
  // The packet's clock stays unused: whole seconds in FlightGear, a constant or ticks in JSBSim.
  return HostState{state->pose, 0, std::nullopt, state->visibilityM};
}

// A host that sends datagrams: the newest state, as it came.
class NativeFdmSource : public StateSource {
 public:
  NativeFdmSource(UdpSocket socket, const std::string& url)
      : thread_(std::move(socket), parseNativeFdmState, mailbox_, url) {}
  SourceSample sample(double) override {
    const Mailbox::Snapshot newest = mailbox_.take();
    SourceSample sample;
    sample.live = true;
    sample.counts = newest.counts;
    if (!newest.state) return sample;
    sample.valid = true;
    sample.pose = newest.state->pose;
    sample.visibilityM = newest.state->visibilityM;
    sample.arrivedNs = newest.state->arrivedNs;
    return sample;
  }
  bool isLive() const override { return true; }
  bool isFixed() const override { return false; }

 private:
  Mailbox mailbox_;
  LinkThread thread_;  // after the mailbox that it writes to
};

using Opened = Result<std::unique_ptr<StateSource>>;

Opened openNativeFdm(const std::string& rest, const std::string& url) {
  const auto endpoint = parseEndpoint(rest, kLoopbackAddress, url);
  if (!endpoint) return tl::unexpected(endpoint.error());
  auto socket = UdpSocket::listenOn(*endpoint);
  if (!socket) return fail(socket.error().kind, url + ": " + socket.error().message);
  return std::make_unique<NativeFdmSource>(std::move(*socket), url);
}

Opened openTrack(const std::string& path) {
  auto track = loadTrack(path);
  if (!track) return tl::unexpected(track.error());
  const double durationS = track->durationS();
  return std::make_unique<TimedSource>([track = std::move(*track)](double t) { return track.at(t); }, durationS);
}

Opened openScenario(const std::string& name) {
  const auto scenario = findScenario(name.empty() ? kDefaultScenario : name);
  if (!scenario) return tl::unexpected(scenario.error());
  return std::make_unique<TimedSource>(scenario->poseAt, scenario->durationS);
}

Opened openPose(const std::string& text) {
  const auto pose = parsePose(text);
  if (!pose) return tl::unexpected(pose.error());
  return std::make_unique<FixedSource>(*pose);
}

}  // namespace

Result<std::unique_ptr<StateSource>> openStateSource(const std::string& url) {
  constexpr std::string_view kSeparator = "://";
  const size_t at = url.find(kSeparator);
  const std::string scheme = url.substr(0, at);
  const std::string rest = at == std::string::npos ? "" : url.substr(at + kSeparator.size());
  if (at != std::string::npos) {
    if (scheme == "native-fdm") return openNativeFdm(rest, url);
    if (scheme == "file") return openTrack(rest);
    if (scheme == "demo") return openScenario(rest);
    if (scheme == "pose") return openPose(rest);
  }
  return fail(ErrorKind::usage,
              fmt::format("host '{}' is none of native-fdm://ADDR:PORT, file://TRACK, demo://[SCENARIO], "
                          "pose://lat,lon,alt,heading,pitch,roll",
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
