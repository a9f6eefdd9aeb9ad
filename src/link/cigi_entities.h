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

// Of which host frame a packet is, and when what it says was true. Packets come in the order of their frames.
struct Stamp {
  uint32_t hostFrame = 0;
  int64_t atNs = 0;
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

}  // namespace eye::cigi
