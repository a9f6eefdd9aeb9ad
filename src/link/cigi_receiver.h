// A CIGI host over time, and what goes back to it. The interface: link/receiver.h.
#pragma once

#include "link/cigi_session.h"
#include "link/ground_desk.h"
#include "link/receiver.h"

namespace eye::cigi {

struct ReceiverOptions {
  uint16_t viewId = 0;
  std::optional<Peer> reply;
  bool silent = false;  // nothing is sent at all: another channel answers
  bool answers = true;  // questions about the ground; else Start of Frame alone
  std::optional<int8_t> databaseNumber;
};

class Receiver : public ListeningReceiver {
 public:
  using Message = cigi::Message;
  using State = Snapshot;

  // `name`: of the link, for the log.
  Receiver(std::string name, const ReceiverOptions& options, const OpenProbe& openProbe);

  // A host's message: with an IG Control that is believed.
  Result<Message> parse(std::span<const std::byte> datagram) const;
  static std::span<const DatagramShape> shapes() { return hostShapes(); }
  bool concerns(const Message&, int64_t) const { return true; }
  void reset();
  std::string greeting(const Message& message) const;
  Taken take(const Message& message, const Peer& sender, int64_t nowNs);
  State state() const { return session_.snapshot(); }
  uint64_t lost() const { return session_.lostFrames(); }

  static std::optional<Pose> poseAt(const State& state, int64_t momentNs) { return poseOf(state.eye, momentNs); }
  static bool moves(const State& state) { return isCarriedOn(state.eye); }
  static void tell(const State& state, int64_t nowNs, SourceSample& sample);

  // A channel that ends says that it is in standby, so that a host does not wait for it.
  std::optional<Outgoing> farewell(int64_t nowNs);
  std::optional<Outgoing> frameDone(const FrameReport& report, int64_t nowNs);

 private:
  const std::string name_;
  const bool silent_, answers_;
  Session session_;
  uint64_t resets_ = 0;  // of the session, seen
  HostClock clock_;
  Replies replies_;
  GroundDesk desk_;
};

}  // namespace eye::cigi
