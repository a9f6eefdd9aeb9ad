#include "link/flood_gate.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace eye {
namespace {

constexpr int64_t kNoticeEveryNs = 10'000'000'000;  // a flood may come and go

}  // namespace

void FloodGate::Flood::update(int64_t unread, int64_t nowNs) {
  gauge.count(std::exchange(count, 0) + unread, nowNs);
}

// What has a shape and was refused all the same the system cannot tell from what is believed.
void FloodGate::refused(std::span<const std::byte> datagram, const Peer& sender) {
  if (!shapes_.empty() && !looksLikeAny(shapes_, datagram)) garbage_.refused(sender);
}

void FloodGate::update(const std::optional<Peer>& sole, int64_t nowNs) {
  const uint32_t dropped = socket_.dropped();
  const uint32_t unread = dropped - std::exchange(dropped_, dropped);  // modulo 2^32
  unread_ += unread;
  // While the gate is closed a flood shows in what is dropped alone.
  strangers_.update(admitted_.sender ? unread : 0, nowNs);
  garbage_.update(admitted_.onlyShaped ? unread : 0, nowNs);

  const Admitted wanted{strangers_.gauge.isOn() ? sole : std::nullopt, garbage_.gauge.isOn()};
  if (wanted == admitted_) return;
  const bool isOpen = wanted == Admitted{};
  if (isOpen) socket_.admitEveryone();
  const auto shapes = wanted.onlyShaped ? shapes_ : std::span<const DatagramShape>{};
  if (!isOpen && !socket_.admitOnly(wanted.sender, shapes)) return;  // it is read and refused, as long as it lasts
  admitted_ = wanted;
  if (isOpen || nowNs < nextNoticeNs_) return;
  nextNoticeNs_ = nowNs + kNoticeEveryNs;
  tell();
}

void FloodGate::tell() const {
  if (admitted_.sender)
    spdlog::warn("{}: a flood, from {} and perhaps others: while {} speaks, what others send is dropped unread", name_,
                 toText(strangers_.sender), toText(*admitted_.sender));
  if (admitted_.onlyShaped)
    spdlog::warn("{}: a flood of garbage, from {} and perhaps others: what cannot be the host's is dropped unread",
                 name_, toText(garbage_.sender));
}

}  // namespace eye
