// Layouts of the packets from host to image generator: each field's offset in {3.x, 4.0}, once for reading and writing.
// A layout may branch on what it has already gone through, and on the minor version: what older ones lack lies in bits
// that they reserve as 0.
#pragma once

#include "link/cigi_fields.h"
#include "link/cigi_ranges.h"

namespace eye::cigi {

// A number that may be absent, with the flag that says so.
template <class Io, class Number>
void optionalF32(Io& io, At flagAt, uint8_t mask, At at, Number& value, const Range& range) {
  io.present(flagAt, mask, value);
  if (value) io.f32(at, *value, range);
}

template <class Io>
void layout(Io& io, Of<Io, IgControl>& p) {
  io.i8({3, 5}, p.databaseNumber);
  io.choice({4, 7}, 0x03, p.mode, IgMode::debug, "mode");
  if (io.since(3)) io.flag({4, 7}, 0x08, p.smoothing);
  io.flag({kAbsent, 6}, 0x01, p.substituteTypes);
  io.u32({8, 8}, p.hostFrame);
  io.present({4, 7}, 0x04, p.ticks);
  if (p.ticks) io.u32({12, 16}, *p.ticks);
  if (p.igFrame) io.u32({16, 12}, *p.igFrame);
}

// 3.x: the two parts of an entity lie in one packet, and have their fields in different places of it.
template <class Io>
void layout(Io& io, Of<Io, EntityTraits>& p) {
  io.choice({4, 4}, 0x03, p.state, EntityState::destroyed, "entity state");
  io.flag({4, kAbsent}, 0x08, p.detectCollisions);
  io.flag({kAbsent, 4}, 0x04, p.detectCollisions);
  io.flag({4, kAbsent}, 0x10, p.inheritAlpha);
  io.flag({kAbsent, 4}, 0x08, p.inheritAlpha);
  if (io.since(3)) io.flag({5, 4}, 0x10, p.smoothing);
  io.u8({6, 5}, p.alpha);
  io.flag({5, kAbsent}, 0x01, p.animateBackward);
  io.flag({5, kAbsent}, 0x02, p.animateForever);
  io.choice({5, kAbsent}, 0x0c, p.animation, AnimationState::resume, "animation state");

  io.present({kAbsent, 4}, 0x20, p.entityType);
  if (!p.entityType) {
    io.u16({8, 10}, p.type);
    return;
  }
  io.u8({kAbsent, 8}, p.entityType->kind);
  io.u8({kAbsent, 9}, p.entityType->domain);
  io.u16({kAbsent, 10}, p.entityType->country);
  io.u8({kAbsent, 12}, p.entityType->category);
  io.u8({kAbsent, 13}, p.entityType->subcategory);
  io.u8({kAbsent, 14}, p.entityType->specific);
  io.u8({kAbsent, 15}, p.entityType->extra);
}

template <class Io>
void layout(Io& io, Of<Io, EntityPlace>& p) {
  io.frame({4, kAbsent}, 0x04, p.position);
  io.frame({kAbsent, 4}, 0x01, p.position);
  io.choice({4, kAbsent}, 0x60, p.clamp, Clamp::conformal, "clamp");
  io.choice({kAbsent, 4}, 0x06, p.clamp, Clamp::conformal, "clamp");
  io.u16({10, 8}, p.parentId);
  io.f32({12, 12}, p.rollDeg, kRoll);
  io.f32({16, 16}, p.pitchDeg, kPitch);
  io.f32({20, 20}, p.yawDeg, kYaw);
  io.point({24, 24}, p.position, kLowestEntityM);
}

template <class Io>
void layout(Io& io, Of<Io, ViewControl>& p) {
  io.u16({2, 6}, p.viewId);
  io.u8({4, 4}, p.groupId);
  io.u16({6, 8}, p.entityId);
  optionalF32(io, {5, 5}, 0x01, {8, 12}, p.xM, kEyeOffset);
  optionalF32(io, {5, 5}, 0x02, {12, 16}, p.yM, kEyeOffset);
  optionalF32(io, {5, 5}, 0x04, {16, 20}, p.zM, kEyeOffset);
  optionalF32(io, {5, 5}, 0x08, {20, 24}, p.rollDeg, kRoll);
  optionalF32(io, {5, 5}, 0x10, {24, 28}, p.pitchDeg, kPitch);
  optionalF32(io, {5, 5}, 0x20, {28, 32}, p.yawDeg, kYaw);
}

template <class Io>
void layout(Io& io, Of<Io, ViewDefinition>& p) {
  io.u16({2, 4}, p.viewId);
  io.u8({4, 6}, p.groupId);
  io.choice({5, 7}, 0xc0, p.mirror, Mirror::both, "mirror mode");
  io.bits({6, 8}, 0x07, p.pixelReplication);
  io.flag({6, 8}, 0x08, p.orthographic);
  io.flag({6, 8}, 0x10, p.toTop);
  io.bits({6, 8}, 0xe0, p.viewType);
  optionalF32(io, {5, 7}, 0x01, {8, 12}, p.nearM, kNear);
  optionalF32(io, {5, 7}, 0x02, {12, 16}, p.farM, kFar);
  const Range& edge = p.orthographic ? kEdgeM : kHalfAngle;
  optionalF32(io, {5, 7}, 0x04, {16, 20}, p.leftDegOrM, edge);
  optionalF32(io, {5, 7}, 0x08, {20, 24}, p.rightDegOrM, edge);
  optionalF32(io, {5, 7}, 0x10, {24, 28}, p.topDegOrM, edge);
  optionalF32(io, {5, 7}, 0x20, {28, 32}, p.bottomDegOrM, edge);
}

template <class Io>
void layout(Io& io, Of<Io, Velocity>& p) {
  io.u16({2, 4}, p.entityId);
  io.present({5, 7}, 0x01, p.partId);
  if (p.partId) io.u8({4, 6}, *p.partId);
  if (io.since(2)) io.flag({5, 7}, 0x02, p.inBodyFrame);
  io.f32({8, 8}, p.xMS, kSpeed);
  io.f32({12, 12}, p.yMS, kSpeed);
  io.f32({16, 16}, p.zMS, kSpeed);
  io.f32({20, 20}, p.rollDegS, kTurnRate);
  io.f32({24, 24}, p.pitchDegS, kTurnRate);
  io.f32({28, 28}, p.yawDegS, kTurnRate);
}

template <class Io>
void layout(Io& io, Of<Io, Acceleration>& p) {
  io.u16({2, 4}, p.entityId);
  io.f32({4, 8}, p.xMS2, kAcceleration);
  io.f32({8, 12}, p.yMS2, kAcceleration);
  io.f32({12, 16}, p.zMS2, kAcceleration);
  io.f32({16, kAbsent}, p.retardationMS2, kAcceleration);
  io.f32({20, kAbsent}, p.terminalVelocityMS, kSpeed);
  io.present({kAbsent, 7}, 0x01, p.partId);
  if (p.partId) io.u8({kAbsent, 6}, *p.partId);
  io.flag({kAbsent, 7}, 0x02, p.inBodyFrame);
  io.f32({kAbsent, 20}, p.rollDegS2, kTurnRate);
  io.f32({kAbsent, 24}, p.pitchDegS2, kTurnRate);
  io.f32({kAbsent, 28}, p.yawDegS2, kTurnRate);
}

template <class Io>
void layout(Io& io, Of<Io, HeightRequest>& p) {
  io.u16({2, 4}, p.id);
  io.choice({4, 8}, 0x03, p.kind, HeightKind::both, "request type");
  io.frame({4, 8}, 0x04, p.point);
  if (io.since(2)) io.u8({5, 9}, p.everyFrames);
  io.u16({6, 6}, p.entityId);
  io.point({8, 16}, p.point, kLowestTestPointM);
}

template <class Io>
void layout(Io& io, Of<Io, SightSegmentRequest>& p) {
  io.u16({2, 4}, p.id);
  io.flag({4, 8}, 0x01, p.extended);
  io.frame({4, 8}, 0x02, p.source);
  io.frame({4, 8}, 0x04, p.destination);
  io.flag({4, 8}, 0x08, p.answerInBodyFrame);
  io.u8({5, 9}, p.alphaThreshold);
  io.u16({6, 6}, p.sourceEntityId);
  if (io.since(2)) io.present({4, 8}, 0x10, p.destinationEntityId);
  if (io.since(2) && p.destinationEntityId) io.u16({62, 10}, *p.destinationEntityId);
  io.point({8, 16}, p.source, kLowestTestPointM);
  io.point({32, 40}, p.destination, kLowestTestPointM);
  io.u32({56, 64}, p.materialMask);
  if (io.since(2)) io.u8({60, 12}, p.everyFrames);
}

template <class Io>
void layout(Io& io, Of<Io, SightVectorRequest>& p) {
  io.u16({2, 4}, p.id);
  io.flag({4, 8}, 0x01, p.extended);
  io.frame({4, 8}, 0x02, p.source);
  io.flag({4, 8}, 0x04, p.answerInBodyFrame);
  io.u8({5, 9}, p.alphaThreshold);
  io.u16({6, 6}, p.entityId);
  io.f32({8, 16}, p.azimuthDeg, kAzimuth);
  io.f32({12, 20}, p.elevationDeg, kElevation);
  io.f32({16, 24}, p.minRangeM, kRange);
  io.f32({20, 28}, p.maxRangeM, kRange);
  io.require(p.minRangeM <= p.maxRangeM, "the minimum range is beyond the maximum range");
  io.point({24, 32}, p.source, kLowestTestPointM);
  io.u32({48, 56}, p.materialMask);
  if (io.since(2)) io.u8({52, 10}, p.everyFrames);
}

}  // namespace eye::cigi
