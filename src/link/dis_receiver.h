// One entity of a DIS exercise over time. The interface: link/receiver.h.
#pragma once

#include "link/dis.h"
#include "link/receiver.h"

namespace eye {

struct DisEntityName {
  uint16_t site = 0, application = 0, entity = 0;
  bool operator==(const DisEntityName&) const = default;
};
DisEntityName nameOf(const DisEntityState& state);

// The standard's time-out: 2.4 heartbeats of 5 s. Then the entity stands still, and another may take its place.
inline constexpr int64_t kDisTimeOutNs = 12'000'000'000;

class DisReceiver : public ListeningReceiver {
 public:
  static constexpr bool kManySenders = true;
  // The sender says by how it moves when it will be off by enough to be worth a PDU, so until its time-out it is there.
  static constexpr int64_t kCarryOnNs = kDisTimeOutNs;
  struct State {
    DisEntityState entity;
    int64_t atNs = 0;
  };
  using Message = DisEntityState;

  // `name`: of the link, for the log. Without `wanted` the first entity that is heard.
  DisReceiver(std::string name, std::optional<DisEntityName> wanted);

  Result<Message> parse(std::span<const std::byte> datagram) const { return parseDisEntityState(datagram); }
  bool concerns(const Message& message, int64_t nowNs) const;
  void reset();
  std::string greeting(const Message& message) const;
  Taken take(const Message& message, const Peer&, int64_t nowNs);
  const State& state() const { return state_; }

  static std::optional<Pose> poseAt(const State& state, int64_t momentNs);
  static bool moves(const State& state) { return state.entity.deadReckoning > DeadReckoning::hold; }
  static void tell(const State&, int64_t, SourceSample&) {}

 private:
  const std::string name_;
  const std::optional<DisEntityName> wanted_;
  State state_;
  bool follows_ = false;  // an entity: that of the state
  int64_t heardNs_ = 0;   // of it
  HostClock clock_;
};

}  // namespace eye
