// What goes back to a CIGI host: Start of Frame for every frame, and answers. Any thread.
#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "link/cigi.h"
#include "link/state_source.h"
#include "link/udp_socket.h"

namespace eye::cigi {

// Answers that wait for a frame: a message holds nearly all of the longest kind, and all of the others.
inline constexpr size_t kMaxAnswers = 2 * kMaxPackets;

class Replies {
 public:
  // `fixedReceiver`: instead of the host's own address. `databaseNumber`: of the terrain; without it, any is.
  Replies(std::optional<Peer> fixedReceiver, std::optional<int8_t> databaseNumber)
      : fixedReceiver_(fixedReceiver), databaseNumber_(databaseNumber) {}

  // Link thread: the newest message that was believed.
  void heard(const Peer& host, const Format& format, const IgControl& control, int64_t nowNs);
  // False when the answer had no room, and is dropped.
  bool answer(const Packet& packet);
  // Link thread: the next message is another host's, or of another run of it.
  void forget();

  struct Reply {
    Peer receiver;
    std::vector<std::byte> message;
  };
  // Render thread, after each frame. Nothing where there is nobody to send to: no host has spoken, or it is silent and
  // no receiver is fixed. `shownHostFrame`: the host's frame that this one shows, by which a host that waits for all of
  // its channels knows that none has passed it over; absent before the first.
  std::optional<Reply> frame(const FrameReport& report, std::optional<uint32_t> shownHostFrame, int64_t nowNs);
  // Render thread: there will be no more frames. Only to a host that has this channel operate.
  std::optional<Reply> farewell(int64_t nowNs);

 private:
  bool speaks(int64_t nowNs) const;
  int8_t databaseStatus(const FrameReport& report);

  const std::optional<Peer> fixedReceiver_;
  const std::optional<int8_t> databaseNumber_;
  std::mutex mutex_;
  std::optional<Peer> host_;
  int64_t heardNs_ = 0;
  Format format_;
  IgControl control_;
  uint32_t firstHostFrame_ = 0;  // of this host
  int8_t wantedDatabase_ = 0;    // 0: the host has not asked for one
  bool loaded_ = false;
  uint32_t igFrame_ = 0;
  std::deque<Packet> answers_;
};

}  // namespace eye::cigi
