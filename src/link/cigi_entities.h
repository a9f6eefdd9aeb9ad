// The entities that a CIGI host has spoken of. Owner thread: link.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "link/cigi_packets.h"
#include "link/eye_chain.h"

namespace eye::cigi {

// A full exercise has some hundreds; what is beyond is counted and not kept.
inline constexpr size_t kMaxEntities = 1024;

// When a packet was sent and when it came.
struct Stamp {
  uint32_t hostFrame = 0;
  int64_t arrivedNs = 0;
};

class EntityTable {
 public:
  void take(const Entity& entity, const Stamp& stamp);
  void take(const Velocity& velocity, const Stamp& stamp);
  void take(const Acceleration& acceleration, const Stamp& stamp);
  void clear() { records_.clear(); }

  // Adds the entity and all that it is attached to, the lowest first. False: it, or one of those, has no place, or they
  // are attached in a circle, or too deep. `smoothing`: by the host's leave; `newestFrame`: of the host.
  bool addChain(uint16_t id, bool smoothing, uint32_t newestFrame, EyeChain& chain) const;

  size_t size() const { return records_.size(); }
  uint64_t turnedAway() const { return turnedAway_; }  // packets of entities beyond kMaxEntities

 private:
  struct Record {
    EntityTraits traits;
    std::optional<ChainLink> place;
    uint16_t parentId = 0;
    uint32_t placedFrame = 0;
    Motion motion;
  };
  Record* recordOf(uint16_t id);
  void destroy(uint16_t id);
  // Moves the place to this moment, so that a new motion goes on from where the old one has led.
  static void settle(Record& record, int64_t nowNs);

  std::unordered_map<uint16_t, Record> records_;
  uint64_t turnedAway_ = 0;
};

// True when `frame` is one of the hundred before `newest`: sent earlier and overtaken, or sent again.
bool isLate(uint32_t frame, uint32_t newest);

}  // namespace eye::cigi
