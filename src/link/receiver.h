// What a live protocol is to the feed that it runs in (link/live_feed.h): a class with
//   Message, State                          what a datagram says; what is known of the host, a value
//   kManySenders                            senders that do not steer are usual: they are passed over, not rejected
//   kCarryOnNs                              see SourceSample::carryOnNs
//   Result<Message> parse(datagram)         an error: not believed
//   bool concerns(message, nowNs)           false: it is of something that is not followed
//   void reset()                            another host speaks: everything as at the beginning
//   std::string greeting(message)           what is said of a new host in the log
//   Taken take(message, sender, nowNs)
//   State state()
//   static std::optional<Pose> poseAt(state, momentNs)    by the host's rates, where it says some
//   static bool moves(state, momentNs)                    it says some that carry the pose on
//   static void tell(state, nowNs, SourceSample&)         what else it says; the sample has its pose already
// and what a ListeningReceiver has. Link thread, but frameDone.
#pragma once

#include <optional>
#include <string>

#include "link/host_clock.h"
#include "link/link_thread.h"
#include "link/state_source.h"

namespace eye {

// The eye of a host that says nothing goes on for so long: a few lost datagrams, then it waits.
inline constexpr int64_t kCarryOnNs = 200'000'000;

struct Taken {
  std::optional<Moment> moment;  // of the state now; nothing: the message was overtaken and has changed nothing
  std::string complaint;         // what of it was not believed
};

// A protocol that only listens.
struct ListeningReceiver {
  static constexpr bool kManySenders = false;
  static constexpr int64_t kCarryOnNs = eye::kCarryOnNs;

  static std::span<const DatagramShape> shapes() { return {}; }       // see LinkProtocol
  uint64_t lost() const { return 0; }                                 // gaps in the protocol's own numbering
  std::optional<Outgoing> due(int64_t) { return std::nullopt; }       // to be sent now
  std::optional<Outgoing> farewell(int64_t) { return std::nullopt; }  // when the thread has ended
  std::optional<Outgoing> frameDone(const FrameReport&, int64_t) { return std::nullopt; }  // render thread
};

}  // namespace eye
