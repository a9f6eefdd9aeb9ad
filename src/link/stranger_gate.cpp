#include "link/stranger_gate.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace eye {
namespace {

constexpr int64_t kNoticeEveryNs = 10'000'000'000;  // a flood may come and go

}  // namespace

void StrangerGate::refused(const Peer& stranger) {
  ++refused_;
  stranger_ = stranger;
}

void StrangerGate::update(const std::optional<Peer>& sole, int64_t nowNs) {
  const uint32_t dropped = socket_.dropped();
  const uint32_t unread = dropped - std::exchange(dropped_, dropped);  // modulo 2^32
  unread_ += unread;
  flood_.count(std::exchange(refused_, 0) + (admitted_ ? unread : 0), nowNs);

  const std::optional<Peer> wanted = flood_.isOn() ? sole : std::nullopt;
  if (wanted == admitted_) return;
  if (!wanted) socket_.admitEveryone();
  if (wanted && !socket_.admitOnly(*wanted)) return;  // it is read and refused, as long as it lasts
  admitted_ = wanted;
  if (!wanted || nowNs < nextNoticeNs_) return;
  nextNoticeNs_ = nowNs + kNoticeEveryNs;
  spdlog::warn("{}: a flood, from {} and perhaps others: while {} speaks, what others send is dropped unread", name_,
               toText(stranger_), toText(*wanted));
}

}  // namespace eye
