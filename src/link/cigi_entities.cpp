#include "link/cigi_entities.h"

#include <vector>

namespace eye::cigi {
namespace {

Vec3d radFromDegrees(double x, double y, double z) {
  return {radFromDeg(x), radFromDeg(y), radFromDeg(z)};
}

}  // namespace

EntityTable::Record* EntityTable::recordOf(uint16_t id) {
  if (const auto found = records_.find(id); found != records_.end()) return &found->second;
  if (records_.size() == kMaxEntities) {
    ++turnedAway_;
    return nullptr;
  }
  return &records_[id];
}

// With all that is attached to it.
void EntityTable::destroy(uint16_t id) {
  std::vector<uint16_t> doomed{id};
  while (!doomed.empty()) {
    const uint16_t next = doomed.back();
    doomed.pop_back();
    if (records_.erase(next) == 0) continue;
    for (const auto& [childId, record] : records_)
      if (record.place && std::holds_alternative<Vec3d>(record.place->position) && record.parentId == next)
        doomed.push_back(childId);
  }
}

void EntityTable::settle(Record& record, int64_t nowNs) {
  if (!record.place || !record.motion.any() || nowNs <= record.place->atNs) return;
  ChainLink link = *record.place;
  link.motion = record.motion;
  link = carriedOn(link, static_cast<double>(nowNs - link.atNs) * 1e-9);
  record.motion = link.motion;
  link.atNs = nowNs;
  record.place = link;
}

void EntityTable::take(const Entity& entity, const Stamp& stamp) {
  if (entity.traits && entity.traits->state == EntityState::destroyed) {
    destroy(entity.id);
    return;
  }
  Record* const record = recordOf(entity.id);
  if (record == nullptr) return;
  if (entity.traits) record->traits = *entity.traits;
  if (!entity.place) return;
  const EntityPlace& place = *entity.place;
  ChainLink link;
  if (const auto* geodetic = std::get_if<Geodetic>(&place.position))
    link.position = *geodetic;
  else if (const auto* offset = std::get_if<BodyOffset>(&place.position))
    link.position = Vec3d(offset->xM, offset->yM, offset->zM);
  link.yawDeg = place.yawDeg, link.pitchDeg = place.pitchDeg, link.rollDeg = place.rollDeg;
  link.atNs = stamp.atNs;
  record->place = link;
  record->parentId = place.parentId;
  record->placedFrame = stamp.hostFrame;
}

void EntityTable::take(const Velocity& velocity, const Stamp& stamp) {
  const auto found = records_.find(velocity.entityId);
  if (found == records_.end() || velocity.partId) return;  // of parts there are none to turn
  Record& record = found->second;
  // The place of the same frame is where the motion begins.
  if (record.placedFrame != stamp.hostFrame) settle(record, stamp.atNs);
  record.motion.velocityInBody = velocity.inBodyFrame;
  record.motion.velocityMS = {velocity.xMS, velocity.yMS, velocity.zMS};
  record.motion.turnRateRadS = radFromDegrees(velocity.rollDegS, velocity.pitchDegS, velocity.yawDegS);
}

void EntityTable::take(const Acceleration& acceleration, const Stamp& stamp) {
  const auto found = records_.find(acceleration.entityId);
  if (found == records_.end() || acceleration.partId) return;
  Record& record = found->second;
  if (record.placedFrame != stamp.hostFrame) settle(record, stamp.atNs);
  record.motion.accelerationInBody = acceleration.inBodyFrame;
  record.motion.accelerationMS2 = {acceleration.xMS2, acceleration.yMS2, acceleration.zMS2};
  record.motion.turnAccelerationRadS2 =
      radFromDegrees(acceleration.rollDegS2, acceleration.pitchDegS2, acceleration.yawDegS2);
}

bool EntityTable::addChain(uint16_t id, bool smoothing, uint32_t newestFrame, EyeChain& chain) const {
  std::vector<ChainLink> upwards;
  while (true) {
    const auto found = records_.find(id);
    if (found == records_.end() || !found->second.place) return false;
    const Record& record = found->second;
    ChainLink link = *record.place;
    link.motion = record.motion;
    // A place that is told frame by frame is shown as told, unless the host asks for smoothing.
    link.carriedOn = (smoothing && record.traits.smoothing) || record.placedFrame != newestFrame;
    upwards.push_back(link);
    if (std::holds_alternative<Geodetic>(link.position)) break;
    if (upwards.size() == kMaxChain) return false;
    id = record.parentId;
  }
  for (auto link = upwards.rbegin(); link != upwards.rend(); ++link)
    if (!chain.add(*link)) return false;
  return true;
}

}  // namespace eye::cigi
