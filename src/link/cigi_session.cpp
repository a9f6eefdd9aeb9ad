#include "link/cigi_session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "geo/sun.h"
#include "link/pose_limits.h"

namespace eye::cigi {
namespace {

// More frames than this missing at once are not lost: the host has leapt ahead.
constexpr uint32_t kMaxGap = 10'000;
// A network that holds a datagram back for longer than this, in frames and in time, has lost it; a step back by more is
// a host that begins anew.
constexpr uint32_t kLateFrames = 100;
constexpr int64_t kLateNs = 1'000'000'000;
// So many frames behind one another that are all older than the newest are no overtaken ones: the host counts anew.
constexpr int kBegunAnew = 10;

// Of a message that was overtaken: what is asked once changes nothing.
bool isAskedOnce(const Packet& packet) {
  return std::visit(
      [](const auto& p) {
        if constexpr (requires { p.everyFrames; })
          return p.everyFrames == 0;
        else
          return false;
      },
      packet);
}

}  // namespace

std::optional<double> julianDayAt(const Sky& sky, int64_t nowNs) {
  if (!sky.julianDayUtc || !sky.clockRuns) return sky.julianDayUtc;
  const int64_t seconds = (nowNs - sky.atNs) / 1'000'000'000;
  return *sky.julianDayUtc + static_cast<double>(seconds) / 86400;
}

void Session::remark(const std::string& name, Remark remark, const std::string& text) {
  if (remarks_.insert(remark).second) spdlog::info("{}: {}", name, text);
}

void Session::reset() {
  entities_.clear();
  groupId_ = 0;
  eyeEntityId_ = 0;
  eyeOffsetM_ = {};
  eyeYawDeg_ = eyePitchDeg_ = eyeRollDeg_ = 0;
  edges_ = {};
  sky_ = {};
  air_ = {};
  asked_.clear();
  repeating_.clear();
  questions_.clear();
  started_ = false;
  lateRun_ = 0;
  framesWithoutEye_ = 0;
  control_ = {};
  seen_.fill(std::nullopt);
  ++resets_;
}

// Sent before the newest and overtaken, or sent again.
bool Session::isLate(uint32_t hostFrame, int64_t arrivedNs) const {
  const uint32_t behind = control_.hostFrame - hostFrame;
  return started_ && behind > 0 && behind <= kLateFrames && arrivedNs - arrivedNs_ <= kLateNs;
}

// Of a host that has stopped and counts from its beginning: what its former run said is not what this one means.
bool Session::beginsAnew(uint32_t hostFrame, int64_t arrivedNs) {
  if (!started_) return false;
  if (!isLate(hostFrame, arrivedNs)) {
    lateRun_ = 0;
    return static_cast<int32_t>(hostFrame - control_.hostFrame) < 0;
  }
  lateRun_ = lateRun_ > 0 && hostFrame == newestLate_ + 1 ? lateRun_ + 1 : 1;
  newestLate_ = hostFrame;
  return lateRun_ >= kBegunAnew;
}

// False when the frame was overtaken.
bool Session::header(const IgControl& control, const std::string& name, int64_t arrivedNs) {
  if (beginsAnew(control.hostFrame, arrivedNs)) {
    spdlog::info("{}: the host begins anew, with frame {} after {}", name, control.hostFrame, control_.hostFrame);
    reset();
  }
  if (isLate(control.hostFrame, arrivedNs)) {
    // Overtaken, not lost; unless it has come before.
    if (lostFrames_ > 0 && seen_[control.hostFrame % seen_.size()] != control.hostFrame) --lostFrames_;
    seen_[control.hostFrame % seen_.size()] = control.hostFrame;
    return false;
  }
  const uint32_t gap = control.hostFrame - control_.hostFrame;
  if (started_ && gap > 1 && gap <= kMaxGap) lostFrames_ += gap - 1;
  const bool wasOperating = control_.mode != IgMode::standby;
  if (control.mode == IgMode::standby) {
    if (wasOperating) {
      const uint64_t lost = lostFrames_;
      reset();
      lostFrames_ = lost;
    }
    remark(name, Remark::standby, "the host keeps the image generator in standby: it is obeyed from operate on");
  }
  control_ = control;
  arrivedNs_ = arrivedNs;
  seen_[control.hostFrame % seen_.size()] = control.hostFrame;
  started_ = true;
  return true;
}

bool Session::take(const Message& message, int64_t atNs, const std::string& name, std::optional<int64_t> arrivedNs) {
  const auto* control = message.packets.empty() ? nullptr : std::get_if<IgControl>(&message.packets.front());
  if (control == nullptr) return false;  // without a header that is believed, nothing says of which frame it is
  const bool isNewFrame = !started_ || control->hostFrame != control_.hostFrame;
  const bool isInOrder = header(*control, name, arrivedNs.value_or(atNs));
  const bool isStandby = control_.mode == IgMode::standby;
  const Stamp stamp{control->hostFrame, isInOrder ? atNs : atNs_};
  const bool isAsked = isDoubled(message, arrivedNs.value_or(atNs));
  for (const Packet& p : message.packets)
    if (!isStandby && (isInOrder || isAskedOnce(p)) && !(isAsked && isRequest(p))) packet(p, stamp, name);
  if (!isInOrder) return false;
  atNs_ = atNs;
  if (isStandby) return true;
  if (isNewFrame) {
    repeatQuestions(atNs);
    lookForEye(name);
  }
  if (entities_.turnedAway() > 0)
    remark(name, Remark::tooMany,
           fmt::format("the host has more than {} entities; those beyond are not kept", kMaxEntities));
  return true;
}

// A host that never says where the view's entity is flies another one, or forgets its View Control.
void Session::lookForEye(const std::string& name) {
  constexpr int kPatienceFrames = 60;
  EyeChain chain;
  const bool isPlaced = entities_.addChain(eyeEntityId_, control_.smoothing, control_.hostFrame, chain);
  framesWithoutEye_ = isPlaced ? 0 : std::min(framesWithoutEye_ + 1, kPatienceFrames);
  if (framesWithoutEye_ == kPatienceFrames)
    remark(name, Remark::noEye,
           fmt::format("view {} is at entity {}, of whose place the host has said nothing in {} frames: it flies "
                       "another entity, or has not said View Control",
                       viewId_, eyeEntityId_, kPatienceFrames));
}

void Session::packet(const Packet& packet, const Stamp& stamp, const std::string& name) {
  if (const auto* entity = std::get_if<Entity>(&packet)) {
    entities_.take(*entity, stamp);
    if (entity->place && entity->place->clamp != Clamp::none)
      remark(name, Remark::clamp, "entities are not clamped to the ground: they are where the host places them");
  }
  if (const auto* velocity = std::get_if<Velocity>(&packet)) entities_.take(*velocity, stamp);
  if (const auto* acceleration = std::get_if<Acceleration>(&packet)) entities_.take(*acceleration, stamp);
  if (const auto* control = std::get_if<ViewControl>(&packet)) take(*control);
  if (const auto* definition = std::get_if<ViewDefinition>(&packet)) take(*definition, name);
  if (const auto* sphere = std::get_if<CelestialSphere>(&packet)) take(*sphere, stamp.atNs);
  if (const auto* atmosphere = std::get_if<Atmosphere>(&packet))
    air_.visibilityM = atmosphere->visibilityM > 0 ? std::optional(atmosphere->visibilityM) : std::nullopt;
  if (const auto* weather = std::get_if<Weather>(&packet)) take(*weather);
  if (const auto* height = std::get_if<HeightRequest>(&packet)) ask(*height, stamp, name);
  if (const auto* segment = std::get_if<SightSegmentRequest>(&packet)) ask(*segment, stamp, name);
  if (const auto* vector = std::get_if<SightVectorRequest>(&packet)) ask(*vector, stamp, name);
}

void Session::take(const ViewControl& control) {
  const bool isOurs = control.groupId == 0 ? control.viewId == viewId_ : control.groupId == groupId_;
  if (!isOurs) return;
  eyeEntityId_ = control.entityId;
  eyeOffsetM_ = {control.xM.value_or(eyeOffsetM_.x), control.yM.value_or(eyeOffsetM_.y),
                 control.zM.value_or(eyeOffsetM_.z)};
  eyeYawDeg_ = control.yawDeg.value_or(eyeYawDeg_);
  eyePitchDeg_ = control.pitchDeg.value_or(eyePitchDeg_);
  eyeRollDeg_ = control.rollDeg.value_or(eyeRollDeg_);
}

void Session::take(const ViewDefinition& definition, const std::string& name) {
  if (definition.viewId != viewId_) {
    remark(name, Remark::otherView,
           fmt::format("the host defines view {}; this channel is view {}: ?view=N chooses another", definition.viewId,
                       viewId_));
    return;
  }
  groupId_ = definition.groupId;
  edges_.mirrorsAcross = definition.mirror == Mirror::horizontal || definition.mirror == Mirror::both;
  edges_.mirrorsUpright = definition.mirror == Mirror::vertical || definition.mirror == Mirror::both;
  if (definition.orthographic) {
    remark(name, Remark::orthographic, "an orthographic view is not drawn; the channel keeps the frustum that it has");
    return;
  }
  const auto update = [](std::optional<double>& value, const std::optional<double>& told) {
    if (told) value = told;
  };
  update(edges_.leftDeg, definition.leftDegOrM);
  update(edges_.rightDeg, definition.rightDegOrM);
  update(edges_.bottomDeg, definition.bottomDegOrM);
  update(edges_.topDeg, definition.topDegOrM);
  update(edges_.nearM, definition.nearM);
  const bool isCrossed = (edges_.leftDeg && edges_.rightDeg && *edges_.leftDeg >= *edges_.rightDeg) ||
                         (edges_.bottomDeg && edges_.topDeg && *edges_.bottomDeg >= *edges_.topDeg);
  if (isCrossed)
    remark(
        name, Remark::crossedEdges,
        fmt::format("the host's view has edges that leave no picture (left {}, right {}, bottom {}, top {} degrees): "
                    "the channel keeps its own there. Left and bottom are negative in a symmetric view",
                    edges_.leftDeg.value_or(0), edges_.rightDeg.value_or(0), edges_.bottomDeg.value_or(0),
                    edges_.topDeg.value_or(0)));
}

void Session::take(const CelestialSphere& sphere, int64_t atNs) {
  if (sphere.dateTime) {
    const DateTime& t = *sphere.dateTime;
    const double day = t.day + (t.hour + (t.minute + t.second / 60) / 60) / 24;
    sky_.julianDayUtc = julianDay(t.year, t.month, day);
    sky_.atNs = atNs;
  } else if (sky_.clockRuns && !sphere.clockRuns) {
    sky_.julianDayUtc = julianDayAt(sky_, atNs);
    sky_.atNs = atNs;
  } else if (!sky_.clockRuns) {
    sky_.atNs = atNs;
  }
  sky_.clockRuns = sphere.clockRuns;
}

void Session::take(const Weather& weather) {
  if (weather.scope != Scope::global || weather.layer >= air_.layers.size()) return;
  AirLayer layer;
  // Fog, rain, snow, sand and dust reach down to the ground; clouds have a base.
  const bool isCloud = weather.layer >= 1 && weather.layer <= 3;
  if (weather.enabled) {
    layer.visibilityM = weather.visibilityM;
    layer.bottomM = isCloud ? weather.baseM : -kMaxAltitudeM;
    layer.topM = weather.baseM + weather.thicknessM;
    layer.bottomTransitionM = isCloud ? weather.transitionM : 0;
    layer.topTransitionM = weather.topTransitionM > 0 ? weather.topTransitionM : weather.transitionM;
  }
  air_.layers[weather.layer] = layer;
  if (!isCloud) return;
  CloudLayer& cloud = air_.clouds[weather.layer - 1u];
  cloud = {};
  if (weather.enabled)
    cloud = {layer.bottomM, layer.topM, layer.bottomTransitionM, layer.topTransitionM, weather.coveragePercent / 100};
}

Snapshot Session::snapshot() const {
  Snapshot snapshot;
  snapshot.hostFrame = control_.hostFrame;
  snapshot.edges = edges_;
  snapshot.sky = sky_;
  snapshot.air = air_;
  if (!entities_.addChain(eyeEntityId_, control_.smoothing, control_.hostFrame, snapshot.eye)) snapshot.eye.count = 0;
  const bool isTurned = eyeYawDeg_ != 0 || eyePitchDeg_ != 0 || eyeRollDeg_ != 0;
  if (snapshot.eye.count == 0 || (eyeOffsetM_ == Vec3d{} && !isTurned)) return snapshot;
  ChainLink eye;
  eye.position = eyeOffsetM_;
  eye.yawDeg = eyeYawDeg_, eye.pitchDeg = eyePitchDeg_, eye.rollDeg = eyeRollDeg_;
  eye.atNs = atNs_;
  if (!snapshot.eye.add(eye)) snapshot.eye.count = 0;
  return snapshot;
}

}  // namespace eye::cigi
