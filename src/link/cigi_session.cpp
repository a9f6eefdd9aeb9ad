#include "link/cigi_session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "geo/sun.h"
#include "link/pose_limits.h"

namespace eye::cigi {
namespace {

// How long what moves goes on moving while its host is silent: a few lost datagrams.
constexpr int64_t kCarryOnNs = 200'000'000;
// More frames than this missing at once is a host that has begun anew.
constexpr uint32_t kMaxGap = 10'000;
// So many frames behind one another that are all older than the newest are no overtaken ones: the host counts anew.
constexpr int kBegunAnew = 10;

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
  viewTold_ = false;
  edges_ = {};
  sky_ = {};
  air_ = {};
  repeating_.clear();
  questions_.clear();
  started_ = false;
  lateRun_ = 0;
  control_ = {};
  seen_.fill(std::nullopt);
}

void Session::header(const IgControl& control, const std::string& name) {
  if (started_ && isLate(control.hostFrame, control_.hostFrame)) {
    lateRun_ = lateRun_ > 0 && control.hostFrame == newestLate_ + 1 ? lateRun_ + 1 : 1;
    newestLate_ = control.hostFrame;
    if (lateRun_ >= kBegunAnew) reset();
  } else {
    lateRun_ = 0;
  }
  const uint32_t gap = control.hostFrame - control_.hostFrame;
  if (started_ && isLate(control.hostFrame, control_.hostFrame)) {
    // Overtaken, not lost; unless it has come before.
    if (lostFrames_ > 0 && seen_[control.hostFrame % seen_.size()] != control.hostFrame) --lostFrames_;
    seen_[control.hostFrame % seen_.size()] = control.hostFrame;
    return;
  }
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
  seen_[control.hostFrame % seen_.size()] = control.hostFrame;
  started_ = true;
}

void Session::take(const Message& message, int64_t nowNs, const std::string& name) {
  const auto* control = message.packets.empty() ? nullptr : std::get_if<IgControl>(&message.packets.front());
  if (control == nullptr) return;  // without a header that is believed, nothing says of which frame it is
  const bool isNewFrame = !started_ || control->hostFrame != control_.hostFrame;
  header(*control, name);
  arrivedNs_ = nowNs;
  if (control_.mode == IgMode::standby) return;
  const Stamp stamp{control->hostFrame, nowNs};
  for (const Packet& p : message.packets) packet(p, stamp, name);
  if (isNewFrame) repeatQuestions(nowNs);
  if (entities_.turnedAway() > 0)
    remark(name, Remark::tooMany,
           fmt::format("the host has more than {} entities; those beyond are not kept", kMaxEntities));
}

void Session::packet(const Packet& packet, const Stamp& stamp, const std::string& name) {
  if (const auto* entity = std::get_if<Entity>(&packet)) {
    entities_.take(*entity, stamp);
    if (entity->place && entity->place->clamp != Clamp::none)
      remark(name, Remark::clamp, "entities are not clamped to the ground: they are where the host places them");
  }
  if (const auto* velocity = std::get_if<Velocity>(&packet)) entities_.take(*velocity, stamp);
  if (const auto* acceleration = std::get_if<Acceleration>(&packet)) entities_.take(*acceleration, stamp);
  if (const auto* control = std::get_if<ViewControl>(&packet)) take(*control, stamp);
  if (const auto* definition = std::get_if<ViewDefinition>(&packet)) take(*definition, name);
  if (const auto* sphere = std::get_if<CelestialSphere>(&packet)) take(*sphere, stamp.arrivedNs);
  if (const auto* atmosphere = std::get_if<Atmosphere>(&packet))
    air_.visibilityM =
        atmosphere->visibilityM >= kMinVisibilityM ? std::optional(atmosphere->visibilityM) : std::nullopt;
  if (const auto* weather = std::get_if<Weather>(&packet)) take(*weather);
  if (const auto* height = std::get_if<HeightRequest>(&packet)) ask(*height, stamp);
  if (const auto* segment = std::get_if<SightSegmentRequest>(&packet)) ask(*segment, stamp);
  if (const auto* vector = std::get_if<SightVectorRequest>(&packet)) ask(*vector, stamp);
}

void Session::take(const ViewControl& control, const Stamp& stamp) {
  const bool isOurs = control.groupId == 0 ? control.viewId == viewId_ : control.groupId == groupId_;
  if (!isOurs || (viewTold_ && isLate(stamp.hostFrame, viewFrame_))) return;
  viewTold_ = true;
  viewFrame_ = stamp.hostFrame;
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
    remark(name, Remark::orthographic, "an orthographic view is not drawn; the channel keeps its own frustum");
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
}

void Session::take(const CelestialSphere& sphere, int64_t nowNs) {
  if (sphere.dateTime) {
    const DateTime& t = *sphere.dateTime;
    const double day = t.day + (t.hour + (t.minute + t.second / 60) / 60) / 24;
    sky_.julianDayUtc = julianDay(t.year, t.month, day);
    sky_.atNs = nowNs;
  } else if (sky_.clockRuns && !sphere.clockRuns) {
    sky_.julianDayUtc = julianDayAt(sky_, nowNs);
    sky_.atNs = nowNs;
  } else if (!sky_.clockRuns) {
    sky_.atNs = nowNs;
  }
  sky_.clockRuns = sphere.clockRuns;
}

void Session::take(const Weather& weather) {
  if (weather.scope != Scope::global || weather.layer >= air_.layers.size()) return;
  AirLayer layer;
  if (weather.enabled) {
    // Fog, rain, snow, sand and dust reach down to the ground; clouds have a base.
    const bool isCloud = weather.layer >= 1 && weather.layer <= 3;
    layer.visibilityM = weather.visibilityM;
    layer.bottomM = isCloud ? weather.baseM : -kMaxAltitudeM;
    layer.topM = weather.baseM + weather.thicknessM;
    layer.bottomTransitionM = isCloud ? weather.transitionM : 0;
    layer.topTransitionM = weather.topTransitionM > 0 ? weather.topTransitionM : weather.transitionM;
  }
  air_.layers[weather.layer] = layer;
}

Snapshot Session::snapshot() const {
  Snapshot snapshot;
  snapshot.arrivedNs = arrivedNs_;
  snapshot.hostFrame = control_.hostFrame;
  snapshot.edges = edges_;
  snapshot.sky = sky_;
  snapshot.air = air_;
  if (!entities_.addChain(eyeEntityId_, control_.smoothing, control_.hostFrame, snapshot.eye)) snapshot.eye.count = 0;
  snapshot.eye.untilNs = arrivedNs_ + kCarryOnNs;
  const bool isTurned = eyeYawDeg_ != 0 || eyePitchDeg_ != 0 || eyeRollDeg_ != 0;
  if (snapshot.eye.count == 0 || (eyeOffsetM_ == Vec3d{} && !isTurned)) return snapshot;
  ChainLink eye;
  eye.position = eyeOffsetM_;
  eye.yawDeg = eyeYawDeg_, eye.pitchDeg = eyePitchDeg_, eye.rollDeg = eyeRollDeg_;
  eye.atNs = arrivedNs_;
  if (!snapshot.eye.add(eye)) snapshot.eye.count = 0;
  return snapshot;
}

}  // namespace eye::cigi
